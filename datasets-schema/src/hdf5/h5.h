#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hdf5.h>

/// HDF5's C API as values that clean up after themselves. The only place of the house that includes it.
namespace kerf::schema::h5 {

/// A failed HDF5 call: the innermost line of HDF5's own error stack.
struct Error : std::runtime_error {
  Error(const std::string& line, int errno_of_cause)
      : std::runtime_error(line), system_error(errno_of_cause) {}
  int system_error;  ///< errno of the system call that failed; 0 if HDF5 itself refused
};

/// Keeps HDF5 from printing in this thread and from touching files at exit().
void silence() noexcept;
[[noreturn]] void throw_last_error();

/// Calls a function of HDF5. @throws Error if it fails.
template <typename Function, typename... Arguments>
auto call(Function function, Arguments... arguments) {
  silence();
  const auto result = function(arguments...);
  if (result < 0) throw_last_error();
  return result;
}

/// Owns one HDF5 identifier, of whatever kind.
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, none)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle();

  /// @throws Error if what was written cannot be brought to the file.
  void close();
  [[nodiscard]] hid_t id() const noexcept { return id_; }

 private:
  static constexpr hid_t none = -1;
  hid_t id_ = none;
};

using Extent = std::vector<hsize_t>;

/// A file that is written. HDF5 itself never learns of a write that fails (it would crash on it): from then
/// on nothing more reaches the disk, and check() tells why.
class WritableFile {
 public:
  enum class Format {
    oldest_readers,
    live_readers,
    timeless  ///< as the first, and its root does not say when it was made
  };

  WritableFile() = default;
  WritableFile(WritableFile&&) noexcept = default;
  // Closing the old handle may still write, and then `failure_` has to be there: both go away together.
  WritableFile& operator=(WritableFile&& other) noexcept {
    std::swap(failure_, other.failure_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  [[nodiscard]] static WritableFile create(const std::filesystem::path& file, Format format);
  [[nodiscard]] static WritableFile open(const std::filesystem::path& file);

  [[nodiscard]] hid_t id() const noexcept { return handle_.id(); }
  /// From here on other processes may follow the file; nothing but rows can be added.
  void start_live();
  /// @throws Error if something could not be written so far.
  void check() const;
  /// Closes, then checks.
  void close();
  /// Why a call failed: what could not be written, else HDF5's own reason.
  [[nodiscard]] Error cause_of(const Error& error) const;

 private:
  WritableFile(std::unique_ptr<int> failure, Handle handle)
      : failure_(std::move(failure)), handle_(std::move(handle)) {}

  std::unique_ptr<int> failure_;  // HDF5 has its address until the handle is closed.
  Handle handle_;
};

/// Settings of a file whose writes never fail as HDF5 sees them; `failure` is the errno of the first that
/// did.
[[nodiscard]] Handle sturdy_access(int& failure);

[[nodiscard]] bool is_hdf5(const std::filesystem::path& file);
/// Opens for reading, also while it is written or after its writer died.
[[nodiscard]] Handle open_file(const std::filesystem::path& file);

/// What large blocks of a file, its texts' among them, begin at a multiple of: 4096 in what is written live,
/// else 1.
[[nodiscard]] std::size_t block_alignment(hid_t file);

// The tree.
[[nodiscard]] bool is_group(hid_t parent, const std::string& path);
[[nodiscard]] bool is_dataset(hid_t parent, const std::string& path);
/// `timeless`: without the time at which it was made.
[[nodiscard]] Handle create_group(hid_t parent, const std::string& path, bool timeless = false);
[[nodiscard]] Handle open(hid_t parent, const std::string& path);
/// A dataset whose rows are read once, from the first to the last: no chunk of it is kept, and none is copied
/// on its way, unless it has to be unpacked.
[[nodiscard]] Handle open_to_pass_through(hid_t parent, const std::string& path);
/// Names in a group, in the order in which they were made where the file knows it.
[[nodiscard]] std::vector<std::string> children(hid_t group);

// Types. A file's type is compared by its name: "float64", "uint32", "text", "{time float64, text text}".
template <typename T>
[[nodiscard]] hid_t native();
template <>
hid_t native<double>();
template <>
hid_t native<float>();
template <>
hid_t native<std::int64_t>();
template <>
hid_t native<std::uint64_t>();
template <>
hid_t native<std::uint32_t>();
template <>
hid_t native<std::uint8_t>();
[[nodiscard]] std::string type_name(hid_t type);
struct Field {
  std::string name;
  std::string type;
  std::size_t size;    ///< bytes; of a text its room
  std::size_t offset;  ///< in memory
};
[[nodiscard]] Handle record_type(std::span<const Field> fields, std::size_t record_size);
[[nodiscard]] Handle packed(const Handle& type);
/// Bytes that a file gives to each field of its records.
[[nodiscard]] std::vector<std::size_t> field_sizes(hid_t dataset);

struct Description {
  std::string type;
  Extent extent;
};

// Datasets. Rows are dimension 0 and can grow.
struct DatasetOptions {
  Extent extent;
  hsize_t chunk_rows = 1;
  const void* fill = nullptr;  ///< value of rows that never reached the file
  bool compressed = false;     ///< shuffle and deflate, without loss
  bool contiguous = false;     ///< in one piece, which cannot grow
  bool timeless = false;       ///< without the time at which it was made
};
[[nodiscard]] Handle create_dataset(hid_t parent, const std::string& path, hid_t type,
                                    const DatasetOptions& options);
[[nodiscard]] Description describe(hid_t dataset);
/// Deflate packs 1000 : 1 at most.
inline constexpr std::uintmax_t max_deflated = 1100;
/// Whether a file of so many bytes can hold a dataset's values, and does not name other files that do. A
/// damaged extent must not make the reader ask for all the memory there is.
[[nodiscard]] bool is_plausible(hid_t dataset, std::uintmax_t file_size);
void write(hid_t dataset, hid_t memory_type, const void* values);
/// Writes `rows` rows from row `first` on, which are there.
void write(hid_t dataset, hid_t memory_type, hsize_t rows, const void* values, hsize_t first);
/// Adds rows after the first `rows_before`.
void append(hid_t dataset, hid_t memory_type, hsize_t rows_before, hsize_t rows, const void* values);
/// Hands it to the operating system.
void flush(hid_t dataset);
/// Reads `rows` rows from row `first` on.
void read(hid_t dataset, hid_t memory_type, hsize_t rows, void* values, hsize_t first = 0);

// Attributes: one value or a list of them.
void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, std::span<const std::string> texts);
void write_attribute(hid_t object, const std::string& name, hid_t native_type, const Extent& extent,
                     const void* values);
void delete_attribute(hid_t object, const std::string& name);
[[nodiscard]] bool has_attribute(hid_t object, const std::string& name);
[[nodiscard]] std::vector<std::string> attributes(hid_t object);
[[nodiscard]] Description describe_attribute(hid_t object, const std::string& name);
[[nodiscard]] std::vector<std::string> read_texts(hid_t object, const std::string& name);
void read_attribute(hid_t object, const std::string& name, hid_t native_type, void* values);

// Dimension scales.
void make_scale(hid_t dataset, const std::string& name);
void attach_scale(hid_t dataset, hid_t scale, unsigned dimension);
void label(hid_t dataset, unsigned dimension, const std::string& name);
[[nodiscard]] bool is_scale(hid_t dataset);
[[nodiscard]] bool has_scale(hid_t dataset, unsigned dimension);

}  // namespace kerf::schema::h5

#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace kerf::bench {

/// What an input of a kind may hold at most [bytes]: more is a mistake, or an attack on the memory.
struct LargestInput {
  static constexpr std::uintmax_t text = std::uintmax_t{16} << 20U;    ///< what people write: TOML
  static constexpr std::uintmax_t table = std::uintmax_t{256} << 20U;  ///< results and tables: JSON, CSV
  static constexpr std::uintmax_t import = std::uintmax_t{4} << 30U;   ///< text of numbers, unless lifted
};

/// A file that somebody named as input, open for reading. One that cannot be opened was named wrongly, which
/// is bad input; what fails later is a system error.
///
/// It is a regular file, or a pipe that was handed over open: standard input, or the `<(command)` of a shell
/// (/dev/stdin, /dev/fd/N). A FIFO or a device that is merely named is refused, and never waited for: it
/// would hang or have no end.
class NamedFile {
 public:
  /// A pipe that stays silent for longer is given up.
  static constexpr std::chrono::milliseconds longest_silence{10'000};

  /// @throws std::invalid_argument with its name: missing, a folder, a device, not to be read.
  explicit NamedFile(const std::filesystem::path& file, std::chrono::milliseconds silence = longest_silence);
  NamedFile(const NamedFile&) = delete;
  NamedFile& operator=(const NamedFile&) = delete;
  ~NamedFile();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  [[nodiscard]] bool is_pipe() const noexcept { return is_pipe_; }
  /// Of a regular file, when it was opened [bytes]; 0 of a pipe.
  [[nodiscard]] std::uintmax_t size() const noexcept { return size_; }
  /// Up to `room` bytes; 0 at the end.
  /// @throws std::invalid_argument for a pipe that stays silent; std::system_error.
  [[nodiscard]] std::size_t read(void* bytes, std::size_t room) const;
  /// All that can be read. @throws as read(); std::invalid_argument if that is more than `at_most` bytes;
  ///         std::system_error if there is no memory for it.
  [[nodiscard]] std::string read_all(std::uintmax_t at_most) const;
  /// @throws std::invalid_argument if the file is larger.
  void require_at_most(std::uintmax_t bytes) const;

 private:
  void wait_for_a_writer() const;

  std::filesystem::path file_;
  std::chrono::milliseconds longest_silence_;
  int descriptor_;
  bool is_pipe_ = false;
  std::uintmax_t size_ = 0;
};

/// All that can be read of a NamedFile. @throws as it does.
[[nodiscard]] std::string read_named_file(const std::filesystem::path& file,
                                          std::uintmax_t at_most = LargestInput::text);

/// @throws std::invalid_argument if there is no such folder, or its files cannot be listed.
void require_named_folder(const std::filesystem::path& folder);

}  // namespace kerf::bench

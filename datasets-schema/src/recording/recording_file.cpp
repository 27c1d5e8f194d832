#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <kerf/schema/recording_file.h>

#include "recording/recording_parts.h"

namespace kerf::schema {
namespace {

/// Rows of one call of HDF5, which keeps its lock meanwhile: 3 MB of 6 axes, a millisecond or two.
constexpr std::uint64_t max_rows_at_once = 65536;

constexpr std::array<const char*, 9> column_paths{
    "/samples/time",           "/samples/position",     "/samples/velocity",  "/samples/force_commanded",
    "/samples/force_measured", "/samples/wake_latency", "/samples/read_time", "/samples/compute_time",
    "/samples/write_time"};

constexpr std::size_t index_of(Column column) { return static_cast<std::size_t>(column); }

constexpr bool is_of_floats(Column column) { return column >= Column::wake_latency; }

/// Holds on to a file whatever it is renamed to, without anything of HDF5.
class Held {
 public:
  explicit Held(const std::filesystem::path& file) : descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) {
      throw std::system_error(errno, std::generic_category(), file.string() + ": cannot read");
    }
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() { ::close(descriptor_); }
  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

struct Dataset {
  std::string path;
  bool is_there = false;
  h5::Handle handle;  ///< closed in a live recording
};

template <typename T>
void read_in_pieces(const h5::Handle& dataset, std::uint64_t first, std::uint64_t rows, std::size_t width,
                    T* values) {
  while (rows > 0) {
    const auto piece = std::min(rows, max_rows_at_once);
    h5::read(dataset.id(), h5::native<T>(), piece, values, first);
    first += piece;
    rows -= piece;
    values += piece * width;
  }
}

}  // namespace

struct RecordingFile::Implementation {
  Implementation(const std::filesystem::path& file, Texts texts) : path(file) {
    auto inspection = inspect_readable(file, texts == Texts::looked_through);
    is_live = inspection.live;
    guarded([&] {
      about = read_all_but_rows(inspection);
      rows = rows_in_every_dataset(inspection);
      const hid_t id = inspection.file.id();
      for (std::size_t i = 0; i < columns.size(); ++i) columns[i] = dataset_at(id, column_paths[i]);
      ticks = dataset_at(id, "/samples/tick");
      flags = dataset_at(id, "/samples/flags");
      for (const auto& channel : about.channels) {
        channels.push_back(dataset_at(id, channel_path(channel.name)));
      }
    });
    if (is_live) held.emplace(file);
    opened = is_live ? h5::Handle() : std::move(inspection.file);
    inspection = {};
    if (rows > 0) {
      first_time_s = time_at(0);
      last_time_s = time_at(rows - 1);
    }
    period_s = median_step();
  }

  /// The writer of a live recording opens it anew to close it, and readers then find what they held before:
  /// nothing of such a file stays open from one call to the next.
  [[nodiscard]] Dataset dataset_at(hid_t file, std::string name) const {
    Dataset dataset{.path = std::move(name), .is_there = false, .handle = {}};
    dataset.is_there = h5::is_dataset(file, dataset.path);
    if (dataset.is_there && !is_live) dataset.handle = h5::open_to_pass_through(file, dataset.path);
    return dataset;
  }

  template <typename Action>
  void guarded(const Action& action) const {
    try {
      action();
    } catch (const h5::Error& error) {
      throw DamageError(path, error);
    } catch (const std::bad_alloc&) {
      throw FormatError(path.string() + ": more than fits into the memory");
    }
  }

  [[nodiscard]] const Dataset& time() const { return columns[index_of(Column::time)]; }

  [[nodiscard]] double time_at(std::uint64_t row) const {
    double time_s = 0.0;
    read(time(), row, 1, 1, std::span(&time_s, 1));
    return time_s;
  }

  [[nodiscard]] double median_step() const {
    constexpr std::uint64_t stretch = 4096;
    std::vector<double> steps;
    for (const std::uint64_t begin : {std::uint64_t{0}, rows / 2, rows - std::min(rows, stretch)}) {
      std::vector<double> times(std::min(stretch, rows - begin));
      read(time(), begin, times.size(), 1, std::span(times));
      for (std::size_t i = 1; i < times.size(); ++i) {
        if (times[i] > times[i - 1]) steps.push_back(times[i] - times[i - 1]);
      }
    }
    if (steps.empty()) return 0.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
  }

  template <typename T>
  void read(const Dataset& dataset, std::uint64_t first, std::uint64_t count, std::size_t width,
            std::span<T> values) const {
    if (!dataset.is_there) throw std::invalid_argument(path.string() + " has no " + dataset.path);
    if (first > rows || count > rows - first) {
      throw std::out_of_range(path.string() + " has " + std::to_string(rows) + " rows, not the " +
                              std::to_string(count) + " from " + std::to_string(first) + " on");
    }
    if (values.size() != count * width) throw std::invalid_argument("values and rows differ in number");
    if (count == 0) return;
    guarded([&] {
      if (!is_live) return read_in_pieces(dataset.handle, first, count, width, values.data());
      const auto file = h5::open_file(held->path());
      read_in_pieces(h5::open_to_pass_through(file.id(), dataset.path), first, count, width, values.data());
    });
  }

  std::filesystem::path path;
  bool is_live = false;
  std::optional<Held> held;
  h5::Handle opened;
  Recording about;
  std::uint64_t rows = 0;
  double first_time_s = std::numeric_limits<double>::quiet_NaN();
  double last_time_s = std::numeric_limits<double>::quiet_NaN();
  double period_s = 0.0;
  std::array<Dataset, column_paths.size()> columns;
  Dataset ticks;
  Dataset flags;
  std::vector<Dataset> channels;
};

RecordingFile::RecordingFile(const std::filesystem::path& file, Texts texts)
    : implementation_(std::make_unique<Implementation>(file, texts)) {}

RecordingFile::RecordingFile(RecordingFile&&) noexcept = default;
RecordingFile& RecordingFile::operator=(RecordingFile&&) noexcept = default;
RecordingFile::~RecordingFile() = default;

const Recording& RecordingFile::about() const noexcept { return implementation_->about; }

std::uint64_t RecordingFile::rows() const noexcept { return implementation_->rows; }

bool RecordingFile::is_live() const noexcept { return implementation_->is_live; }

double RecordingFile::first_time_s() const noexcept { return implementation_->first_time_s; }

double RecordingFile::last_time_s() const noexcept { return implementation_->last_time_s; }

double RecordingFile::period_s() const noexcept { return implementation_->period_s; }

std::size_t RecordingFile::width(Column column) const noexcept {
  if (!implementation_->columns[index_of(column)].is_there) return 0;
  const bool is_per_axis = column >= Column::position && column <= Column::force_measured;
  return is_per_axis ? implementation_->about.dimensions() : 1;
}

bool RecordingFile::has_flags() const noexcept { return implementation_->flags.is_there; }

void RecordingFile::read(Column column, std::uint64_t first_row, std::uint64_t rows,
                         std::span<double> values) const {
  const auto& self = *implementation_;
  const auto& dataset = self.columns[index_of(column)];
  if (!is_of_floats(column)) return self.read(dataset, first_row, rows, width(column), values);
  // HDF5 converts more slowly than the processor.
  std::vector<float> floats(values.size());
  self.read(dataset, first_row, rows, 1, std::span(floats));
  std::ranges::copy(floats, values.begin());
}

void RecordingFile::read_channel(std::size_t channel, std::uint64_t first_row,
                                 std::span<double> values) const {
  const auto& self = *implementation_;
  if (channel >= self.channels.size()) {
    throw std::invalid_argument(self.path.string() + " has " + std::to_string(self.channels.size()) +
                                " channels, there is no channel " + std::to_string(channel));
  }
  self.read(self.channels[channel], first_row, values.size(), 1, values);
}

void RecordingFile::read_ticks(std::uint64_t first_row, std::span<std::uint64_t> values) const {
  implementation_->read(implementation_->ticks, first_row, values.size(), 1, values);
}

void RecordingFile::read_flags(std::uint64_t first_row, std::span<std::uint32_t> values) const {
  implementation_->read(implementation_->flags, first_row, values.size(), 1, values);
}

}  // namespace kerf::schema

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "in_process.h"
#include "recording/recording_parts.h"

namespace kerf::schema::in_process {
namespace {

hid_t native_type(std::size_t dataset) {
  if (dataset == tick_dataset) return h5::native<std::uint64_t>();
  if (dataset == flags_dataset) return h5::native<std::uint32_t>();
  return value_bytes(dataset) == sizeof(float) ? h5::native<float>() : h5::native<double>();
}

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

}  // namespace

struct OpenRecording::Implementation {
  Implementation(const std::filesystem::path& file, Inspection inspection) : path(file) {
    facts.is_live = inspection.live;
    guarded([&] {
      facts.about = read_all_but_rows(inspection);
      facts.rows = rows_in_every_dataset(inspection);
      const hid_t id = inspection.file.id();
      for (const auto name : dataset_paths) datasets.push_back(dataset_at(id, std::string(name)));
      for (const auto& channel : facts.about.channels) {
        datasets.push_back(dataset_at(id, channel_path(channel.name)));
      }
    });
    if (facts.is_live) held.emplace(file);
    opened = facts.is_live ? h5::Handle() : std::move(inspection.file);
    inspection = {};
    for (std::size_t i = 0; i < facts.widths.size(); ++i) facts.widths[i] = width(i);
    if (facts.rows > 0) {
      facts.first_time_s = times(0, 1).front();
      facts.last_time_s = times(facts.rows - 1, 1).front();
    }
    facts.period_s = median_step();
  }

  /// The writer of a live recording opens it anew to close it, and readers then find what they held before:
  /// nothing of such a file stays open from one call to the next.
  [[nodiscard]] Dataset dataset_at(hid_t file, std::string name) const {
    Dataset dataset{.path = std::move(name), .is_there = false, .handle = {}};
    dataset.is_there = h5::is_dataset(file, dataset.path);
    if (dataset.is_there && !facts.is_live) dataset.handle = h5::open_to_pass_through(file, dataset.path);
    return dataset;
  }

  template <typename Action>
  void guarded(const Action& action) const {
    try {
      action();
    } catch (const h5::Error& error) {
      throw DamageError(path, error.what());
    } catch (const std::bad_alloc&) {
      throw FormatError(path.string() + ": more than fits into the memory");
    }
  }

  [[nodiscard]] std::uint32_t width(std::size_t dataset) const {
    if (!datasets.at(dataset).is_there) return 0;
    return is_per_axis(dataset) ? static_cast<std::uint32_t>(facts.about.dimensions()) : 1;
  }

  [[nodiscard]] std::vector<double> times(std::uint64_t first, std::uint64_t rows) const {
    std::vector<double> values(rows);
    read(time_dataset, first, rows, std::as_writable_bytes(std::span(values)));
    return values;
  }

  [[nodiscard]] double median_step() const {
    constexpr std::uint64_t stretch = 4096;
    const std::uint64_t rows = facts.rows;
    std::vector<double> steps;
    for (const std::uint64_t begin : {std::uint64_t{0}, rows / 2, rows - std::min(rows, stretch)}) {
      const auto time = times(begin, std::min(stretch, rows - begin));
      for (std::size_t i = 1; i < time.size(); ++i) {
        if (time[i] > time[i - 1]) steps.push_back(time[i] - time[i - 1]);
      }
    }
    if (steps.empty()) return 0.0;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
  }

  void read(std::size_t number, std::uint64_t first, std::uint64_t rows, std::span<std::byte> values) const {
    const Dataset& dataset = datasets.at(number);
    if (!dataset.is_there || first > facts.rows || rows > facts.rows - first ||
        values.size() != rows * width(number) * value_bytes(number)) {
      throw std::out_of_range(path.string() + " has no such rows of " + dataset.path);
    }
    if (rows == 0) return;
    guarded([&] {
      if (!facts.is_live) {
        return h5::read(dataset.handle.id(), native_type(number), rows, values.data(), first);
      }
      const auto file = h5::open_file(held->path());
      const auto reopened = h5::open_to_pass_through(file.id(), dataset.path);
      h5::read(reopened.id(), native_type(number), rows, values.data(), first);
    });
  }

  std::filesystem::path path;
  std::optional<Held> held;
  h5::Handle opened;
  RecordingFacts facts;
  std::vector<Dataset> datasets;
};

OpenRecording::OpenRecording(const std::filesystem::path& file, bool look_through_texts)
    : implementation_(std::make_unique<Implementation>(file, inspect_readable(file, look_through_texts))) {}

OpenRecording::OpenRecording(const std::filesystem::path& file, Inspection&& inspection)
    : implementation_(std::make_unique<Implementation>(file, std::move(inspection))) {}

OpenRecording::~OpenRecording() = default;

const RecordingFacts& OpenRecording::facts() const noexcept { return implementation_->facts; }

std::size_t OpenRecording::row_bytes(std::size_t dataset) const {
  return implementation_->width(dataset) * value_bytes(dataset);
}

void OpenRecording::read(std::size_t dataset, std::uint64_t first_row, std::uint64_t rows,
                         std::span<std::byte> values) const {
  implementation_->read(dataset, first_row, rows, values);
}

}  // namespace kerf::schema::in_process

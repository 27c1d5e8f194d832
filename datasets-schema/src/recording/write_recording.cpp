#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <kerf/schema/recording.h>

#include "hdf5/files.h"
#include "recording/build.h"

namespace kerf::schema {
namespace {

constexpr hsize_t chunk_rows = 65536;

/// The lengths behind the letters of layout::Dataset::shape.
hsize_t length_of(char letter, const Recording& recording) {
  switch (letter) {
    case 'N':
      return recording.rows();
    case 'D':
      return recording.dimensions();
    case 'E':
      return recording.events.size();
    case 'P':
      return recording.cycles->phases.size();
    case 'C':
      return recording.cycles->closing.size();
    default:
      return recording.cycles->grid.size();
  }
}

h5::Extent extent_of(const layout::Dataset& rule, const Recording& recording) {
  h5::Extent extent;
  for (const char letter : rule.shape) extent.push_back(length_of(letter, recording));
  return extent;
}

void require_length(std::string_view path, std::size_t found, hsize_t expected) {
  if (found == expected) return;
  throw std::invalid_argument("recording: " + std::string(path) + " has " + std::to_string(found) +
                              " values, expected " + std::to_string(expected));
}

/// Writes a recording's datasets into a file that has its head.
class DatasetWriter {
 public:
  DatasetWriter(hid_t file, const Recording& recording)
      : file_(file),
        recording_(recording),
        sources_{recording.header, recording.axes, recording.cycles ? &*recording.cycles : nullptr} {}

  void write_samples() {
    for (const auto& rule : layout::datasets()) {
      if (layout::parent(rule.path) == layout::samples) write(rule);
    }
    if (recording_.channels.empty()) return;
    static_cast<void>(h5::create_group(file_, std::string(layout::channels)));
    for (const auto& channel : recording_.channels) write(channel);
  }

  void write_events() {
    EventRoom room{.kind = 1, .text = 1};
    for (const auto& event : recording_.events) {
      room.kind = std::max(room.kind, event.kind.size());
      room.text = std::max(room.text, event.text.size());
    }
    write_records(layout::dataset("/events"), event_type(room), pack(recording_.events, room).data());
  }

  void write_cycles() {
    if (!recording_.cycles) return;
    write_group("/cycles");
    write_records(layout::dataset("/cycles/phases"), phase_type(), recording_.cycles->phases.data());
    for (const auto& rule : layout::datasets()) {
      if (layout::parent(rule.path) == layout::cycles) write(rule);
    }
  }

 private:
  void write_group(const std::string& path) {
    const auto group = h5::create_group(file_, path);
    write_attributes(group.id(), path, sources_);
  }

  void write(const layout::Dataset& rule) {
    std::visit(
        [&](auto member) {
          using Pointer = decltype(member);
          if constexpr (std::is_same_v<Pointer, std::vector<double> Cycles::*>) {
            write_values(rule, *recording_.cycles.*member);
          } else if constexpr (std::is_same_v<Pointer, std::vector<std::vector<double>> Cycles::*>) {
            write_values(rule, flattened(rule, *recording_.cycles.*member));
          } else if constexpr (!std::is_same_v<Pointer, std::monostate>) {
            write_values(rule, recording_.*member);
          }
        },
        rule.member);
  }

  template <typename T>
  void write_values(const layout::Dataset& rule, const std::vector<T>& values) {
    if (values.empty() && !rule.required) return;
    const auto extent = extent_of(rule, recording_);
    hsize_t count = 1;
    for (const auto length : extent) count *= length;
    require_length(rule.path, values.size(), count);
    auto dataset = create(rule, h5::native<T>(), extent);
    if (count > 0) h5::write(dataset.id(), h5::native<T>(), values.data());
    if (rule.path == "/samples/time" || rule.path == "/cycles/grid") {
      h5::make_scale(dataset.id(), std::string(layout::last_name(rule.path)));
      scale_ = std::move(dataset);
    } else {
      attach(dataset, rule.shape);
    }
  }

  void attach(const h5::Handle& dataset, std::string_view shape) {
    if (shape.starts_with('N')) {
      attach_time(dataset, scale_);
    } else {
      h5::attach_scale(dataset.id(), scale_.id(), static_cast<unsigned>(shape.find('G')));
    }
  }

  void write_records(const layout::Dataset& rule, const h5::Handle& type, const void* records) {
    const auto extent = extent_of(rule, recording_);
    const auto dataset = create(rule, h5::packed(type).id(), extent);
    if (extent.front() > 0) h5::write(dataset.id(), type.id(), records);
  }

  h5::Handle create(const layout::Dataset& rule, hid_t type, const h5::Extent& extent) {
    return make_dataset(file_, rule, type, sources_,
                        {.extent = extent, .chunk_rows = std::min(extent.front(), chunk_rows)});
  }

  std::vector<double> flattened(const layout::Dataset& rule,
                                const std::vector<std::vector<double>>& branches) {
    std::vector<double> values;
    for (const auto& branch : branches) {
      require_length(rule.path, branch.size(), recording_.cycles->grid.size());
      values.insert(values.end(), branch.begin(), branch.end());
    }
    return values;
  }

  void write(const Channel& channel) {
    require_length(std::string(layout::channels) + '/' + channel.name, channel.values.size(),
                   recording_.rows());
    const h5::Extent extent{recording_.rows()};
    const auto dataset =
        make_channel(file_, channel, {.extent = extent, .chunk_rows = std::min(extent[0], chunk_rows)});
    if (extent[0] > 0) h5::write(dataset.id(), h5::native<double>(), channel.values.data());
    attach_time(dataset, scale_);
  }

  hid_t file_;
  const Recording& recording_;
  Sources sources_;
  h5::Handle scale_;
};

void write_datasets(hid_t file, const Recording& recording) {
  DatasetWriter writer(file, recording);
  writer.write_samples();
  writer.write_events();
  writer.write_cycles();
}

}  // namespace

void write_recording(const std::filesystem::path& file, const Recording& recording) {
  if (recording.axes.empty() || recording.axes.size() > max_axes) {
    throw std::invalid_argument("recording: found " + std::to_string(recording.axes.size()) +
                                " axes, expected 1 to " + std::to_string(max_axes));
  }
  TemporaryFile temporary(file);
  h5::WritableFile output;
  try {
    output = h5::WritableFile::create(temporary.path(), h5::WritableFile::Format::oldest_readers);
    write_head(output.id(), {recording.header, recording.axes});
    write_datasets(output.id(), recording);
    output.close();
  } catch (const h5::Error& error) {
    throw write_error(file, output.cause_of(error));
  }
  temporary.commit();
}

}  // namespace kerf::schema

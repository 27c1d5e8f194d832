#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

#include "hdf5/files.h"
#include "in_process.h"
#include "recording/build.h"
#include "recording/cycle_changes.h"

namespace kerf::schema {
namespace {

constexpr hsize_t chunk_rows = 65536;

/// The lengths behind the letters of layout::Dataset::shape.
hsize_t length_of(char letter, const Recording& recording, hsize_t rows) {
  switch (letter) {
    case 'N':
      return rows;
    case 'D':
      return recording.dimensions();
    case 'E':
      return recording.events.size();
    case 'P':
      return recording.cycles->phases.size();
    case 'C':
      return recording.cycles->closing.size();
    case 'K':
      return recording.cycle_flags->flags.size();
    case 'H':
      return recording.cycle_edits.size();
    default:
      return recording.cycles->grid.size();
  }
}

h5::Extent extent_of(const layout::Dataset& rule, const Recording& recording, hsize_t rows) {
  h5::Extent extent;
  for (const char letter : rule.shape) extent.push_back(length_of(letter, recording, rows));
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
  DatasetWriter(hid_t file, const Recording& recording, const RecordedRows& rows)
      : file_(file),
        recording_(recording),
        rows_(rows),
        sources_{recording.header, recording.axes, recording.cycles ? &*recording.cycles : nullptr,
                 recording.cycle_flags ? &*recording.cycle_flags : nullptr} {}

  void write_samples() {
    for (const auto& rule : layout::datasets()) {
      if (layout::parent(rule.path) == layout::samples) write_sample(rule);
    }
    if (recording_.channels.empty()) return;
    static_cast<void>(h5::create_group(file_, std::string(layout::channels)));
    for (std::size_t i = 0; i < recording_.channels.size(); ++i) write_channel(i);
  }

  void write_events() {
    const TextRoom room = room_for(recording_.events);
    write_records(layout::dataset("/events"), event_type(room), pack(recording_.events, room).data());
  }

  void write_cycles() {
    if (!recording_.cycles) return;
    write_group("/cycles");
    write_records(layout::dataset("/cycles/phases"), phase_type(), recording_.cycles->phases.data());
    for (const auto& rule : layout::datasets()) {
      if (layout::parent(rule.path) == layout::cycles) write_of_cycles(rule);
    }
  }

  void write_cycle_flags() {
    if (!recording_.cycle_flags) return;
    write_group("/cycle_flags");
    const auto& flags = recording_.cycle_flags->flags;
    const TextRoom room = room_for(flags);
    write_records(layout::dataset("/cycle_flags/flags"), flag_type(room), pack(flags, room).data());
  }

  void write_cycle_edits() {
    const auto& changes = recording_.cycle_edits;
    if (changes.empty()) return;
    write_group("/cycle_edits");
    const ChangeRoom room = room_for_changes(changes);
    write_records(layout::dataset("/cycle_edits/changes"), change_type(room),
                  pack_changes(changes, room).data());
  }

 private:
  void write_group(const std::string& path) {
    const auto group = h5::create_group(file_, path);
    write_attributes(group.id(), path, sources_);
  }

  void write_sample(const layout::Dataset& rule) {
    const auto number = static_cast<std::size_t>(std::ranges::find(in_process::dataset_paths, rule.path) -
                                                 in_process::dataset_paths.begin());
    if (number == in_process::tick_dataset) {
      write_rows<std::uint64_t>(rule, 1,
                                [&](auto first, auto, auto values) { rows_.read_ticks(first, values); });
    } else if (number == in_process::flags_dataset) {
      if (!rows_.has_flags()) return;
      write_rows<std::uint32_t>(rule, 1,
                                [&](auto first, auto, auto values) { rows_.read_flags(first, values); });
    } else if (number < in_process::tick_dataset) {
      write_column(rule, static_cast<Column>(number));
    }
  }

  void write_column(const layout::Dataset& rule, Column column) {
    const std::size_t width = rows_.width(column);
    if (width == 0 && !rule.required) return;
    const auto read = [&](auto first, auto rows, std::span<double> values) {
      rows_.read(column, first, rows, values);
    };
    if (column < Column::wake_latency) return write_rows<double>(rule, width, read);
    std::vector<double> wide;
    write_rows<float>(rule, width, [&](auto first, auto rows, std::span<float> values) {
      wide.resize(values.size());
      read(first, rows, wide);
      std::ranges::transform(wide, values.begin(), [](double value) { return static_cast<float>(value); });
    });
  }

  template <typename T, typename Read>
  void write_rows(const layout::Dataset& rule, std::size_t width, const Read& read) {
    auto dataset = create(rule, h5::native<T>(), extent_of(rule, recording_, rows_.rows()));
    write_in_blocks<T>(dataset, width, read);
    if (rule.path == layout::dataset("/samples/time").path) {
      keep_as_scale(rule, std::move(dataset));
    } else {
      attach_time(dataset, scale_);
    }
  }

  template <typename T, typename Read>
  void write_in_blocks(const h5::Handle& dataset, std::size_t width, const Read& read) {
    std::vector<T> values;
    for (hsize_t first = 0; first < rows_.rows(); first += chunk_rows) {
      const hsize_t rows = std::min(chunk_rows, rows_.rows() - first);
      values.resize(rows * width);
      read(first, rows, std::span(values));
      h5::write(dataset.id(), h5::native<T>(), rows, values.data(), first);
    }
  }

  void write_channel(std::size_t number) {
    const h5::Extent extent{rows_.rows()};
    const auto dataset = make_channel(file_, recording_.channels[number],
                                      {.extent = extent, .chunk_rows = std::min(extent[0], chunk_rows)});
    write_in_blocks<double>(dataset, 1, [&](auto first, auto, std::span<double> values) {
      rows_.read_channel(number, first, values);
    });
    attach_time(dataset, scale_);
  }

  void keep_as_scale(const layout::Dataset& rule, h5::Handle dataset) {
    h5::make_scale(dataset.id(), std::string(layout::last_name(rule.path)));
    scale_ = std::move(dataset);
  }

  void write_of_cycles(const layout::Dataset& rule) {
    std::visit(
        [&](auto member) {
          using Pointer = decltype(member);
          if constexpr (std::is_same_v<Pointer, std::vector<double> Cycles::*>) {
            write_branches(rule, *recording_.cycles.*member);
          } else if constexpr (std::is_same_v<Pointer, std::vector<std::vector<double>> Cycles::*>) {
            write_branches(rule, flattened(rule, *recording_.cycles.*member));
          }
        },
        rule.member);
  }

  void write_branches(const layout::Dataset& rule, const std::vector<double>& values) {
    if (values.empty() && !rule.required) return;
    const auto extent = extent_of(rule, recording_, rows_.rows());
    hsize_t count = 1;
    for (const auto length : extent) count *= length;
    require_length(rule.path, values.size(), count);
    auto dataset = create(rule, h5::native<double>(), extent);
    if (count > 0) h5::write(dataset.id(), h5::native<double>(), values.data());
    if (rule.path == layout::dataset("/cycles/grid").path) {
      keep_as_scale(rule, std::move(dataset));
    } else {
      h5::attach_scale(dataset.id(), scale_.id(), static_cast<unsigned>(rule.shape.find('G')));
    }
  }

  void write_records(const layout::Dataset& rule, const h5::Handle& type, const void* records) {
    const auto extent = extent_of(rule, recording_, rows_.rows());
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

  hid_t file_;
  const Recording& recording_;
  const RecordedRows& rows_;
  Sources sources_;
  h5::Handle scale_;
};

/// Nothing of the file is open any more when it returns: only then does closing the file bring all to it, and
/// tell what failed.
void write_datasets(hid_t file, const Recording& about, const RecordedRows& rows) {
  DatasetWriter writer(file, about, rows);
  writer.write_samples();
  writer.write_events();
  writer.write_cycles();
  writer.write_cycle_flags();
  writer.write_cycle_edits();
}

void require_axes(const Recording& recording) {
  if (!recording.axes.empty() && recording.axes.size() <= max_axes) return;
  throw std::invalid_argument("recording: found " + std::to_string(recording.axes.size()) +
                              " axes, expected 1 to " + std::to_string(max_axes));
}

/// Every column has as many rows as there are times, or none if it need not be there.
void require_lengths(const Recording& recording) {
  for (const auto& rule : layout::datasets()) {
    std::visit(
        [&](auto member) {
          if constexpr (std::is_invocable_v<decltype(member), const Recording&>) {
            const std::size_t found = (recording.*member).size();
            if (!rule.shape.starts_with('N') || (found == 0 && !rule.required)) return;
            const hsize_t width = rule.shape == "ND" ? recording.dimensions() : 1;
            require_length(rule.path, found, recording.rows() * width);
          }
        },
        rule.member);
  }
  for (const Channel& channel : recording.channels) {
    require_length(std::string(layout::channels) + '/' + channel.name, channel.values.size(),
                   recording.rows());
  }
}

}  // namespace

void write_recording(const std::filesystem::path& file, const Recording& about, const RecordedRows& rows,
                     Existing existing) {
  require_axes(about);
  TemporaryFile temporary(file);
  h5::WritableFile output;
  try {
    output = temporary.create();
    write_head(output.id(), {about.header, about.axes});
    write_datasets(output.id(), about, rows);
    output.close();
  } catch (const h5::Error& error) {
    throw write_error(file, output.cause_of(error));
  }
  temporary.commit(existing);
}

void write_recording(const std::filesystem::path& file, const Recording& recording, Existing existing) {
  require_axes(recording);
  require_lengths(recording);
  write_recording(file, recording, RowsInMemory(recording), existing);
}

}  // namespace kerf::schema

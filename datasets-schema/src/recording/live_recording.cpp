#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <kerf/schema/live_recording.h>

#include "hdf5/files.h"
#include "in_process.h"
#include "recording/build.h"
#include "validate/inspect.h"

namespace kerf::schema {
namespace {

/// A writer's chunk: so many rows at the end may not have reached the file.
constexpr hsize_t rows_in_doubt = 4096;

hsize_t rows_of(hid_t file, const std::string& path) {
  return h5::describe(h5::open(file, path).id()).extent.front();
}

/// Rows that are in `time`, which is written last; those that a crash kept from the disk read as NaN.
hsize_t rows_in_time(hid_t file) {
  const hsize_t extent = rows_of(file, "/samples/time");
  const hsize_t doubtful = std::min(extent, rows_in_doubt);
  std::vector<double> time(doubtful);
  if (doubtful > 0) {
    h5::read(h5::open(file, "/samples/time").id(), h5::native<double>(), doubtful, time.data(),
             extent - doubtful);
  }
  const auto missing = std::ranges::find_if(time, [](double value) { return std::isnan(value); });
  return extent - static_cast<hsize_t>(time.end() - missing);
}

void read_last(hid_t file, const layout::Dataset& rule, hsize_t row, std::size_t width, Row& last) {
  const std::string path(rule.path);
  if (!h5::is_dataset(file, path) || rows_of(file, path) <= row) return;
  std::visit(
      [&](auto member) {
        if constexpr (!std::is_same_v<decltype(member), std::monostate>) {
          auto& value = last.*member;
          using Value = std::remove_reference_t<decltype(value)>;
          const auto dataset = h5::open(file, path);
          if constexpr (std::is_arithmetic_v<Value>) {
            h5::read(dataset.id(), h5::native<Value>(), 1, &value, row);
          } else {
            std::vector<double> values(width);
            h5::read(dataset.id(), h5::native<double>(), 1, values.data(), row);
            std::ranges::copy(values, value.begin());
          }
        }
      },
      rule.row_member);
}

std::vector<Axis> axes_of(hid_t file) {
  const auto samples = h5::open(file, "/samples");
  const auto names = h5::read_texts(samples.id(), "axes");
  const auto forces = h5::read_texts(samples.id(), "force_units");
  const auto positions = h5::read_texts(h5::open(file, "/samples/position").id(), "units");
  std::vector<Axis> axes(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    axes[i] = {.name = names[i], .position_unit = positions[i], .force_unit = forces[i]};
  }
  return axes;
}

void read_last_event(hid_t file, Tail& tail) {
  const auto dataset = h5::open(file, "/events");
  tail.events = h5::describe(dataset.id()).extent.front();
  if (tail.events == 0) return;
  const auto sizes = h5::field_sizes(dataset.id());
  const TextRoom room{.kind = sizes[1], .text = sizes[2]};
  std::vector<std::byte> record(sizes[0] + sizes[1] + sizes[2]);
  h5::read(dataset.id(), event_type(room).id(), 1, record.data(), tail.events - 1);
  tail.last_event = unpack_events(record, room).front();
}

}  // namespace

Place find_recording(const std::filesystem::path& name) {
  const bool named_partial = name.extension() == ".partial";
  const auto partial = named_partial ? name : partial_name(name);
  if (std::filesystem::exists(partial)) {
    return {.file = partial, .partial = true, .being_written = is_marked(partial)};
  }
  auto closed = name;
  if (named_partial) closed.replace_extension();
  require_readable(closed, "a recording");
  return {.file = closed};
}

Tail in_process::read_tail(const std::filesystem::path& file) {
  // No look through all texts: that takes as long as reading the file.
  const auto inspection = inspect_readable(file, false);
  const hid_t opened = inspection.file.id();
  try {
    const auto text_of = [&](const char* name) {
      return h5::has_attribute(opened, name) ? h5::read_texts(opened, name).front() : std::string();
    };
    Tail tail{.uuid = text_of("uuid"),
              .status = text_of("status"),
              .axes = axes_of(opened),
              .measures_force = h5::is_dataset(opened, "/samples/force_measured"),
              .rows = rows_in_time(opened)};
    if (tail.rows > 0) {
      for (const auto& rule : layout::datasets()) {
        read_last(opened, rule, tail.rows - 1, tail.axes.size(), tail.last);
      }
    }
    read_last_event(opened, tail);
    return tail;
  } catch (const h5::Error& error) {
    throw DamageError(file, error.what());
  }
}

}  // namespace kerf::schema

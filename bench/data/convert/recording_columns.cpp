#include "convert/recording_columns.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

using Group = RecordingColumn::Group;
using Number = RecordingColumn::Number;

std::string meaning_of_flags() {
  std::string meaning = "What happened in the tick, bit by bit:";
  for (const schema::FlagInfo& flag : schema::flag_table)
    meaning += fmt::format(" {} {},", static_cast<std::uint32_t>(flag.flag), flag.name);
  meaning.pop_back();
  return meaning;
}

std::string unit_of_axis(const schema::Axis& axis, schema::Column column) {
  if (column == schema::Column::position) return axis.position_unit;
  if (column == schema::Column::velocity) return axis.position_unit + "/s";
  return axis.force_unit;
}

}  // namespace

RecordingColumns::RecordingColumns(const schema::RecordedRows& rows) : rows_(&rows) {
  const auto single = [](const std::string& name, std::string unit, std::string meaning, Group group,
                         Number number) {
    return RecordingColumn{.quantity = name,
                           .part = {},
                           .unit = std::move(unit),
                           .meaning = std::move(meaning),
                           .source = "/samples/" + name,
                           .group = group,
                           .number = number};
  };
  add(single("time", "s", "Time from the start", Group::motion, Number::float64), {});
  add(single("tick", "1", "Number of the tick; a jump is a gap", Group::motion, Number::uint64), {});
  const std::string& derived = about().header.velocity_derived;
  add_axes(single("position", "", "Position of the tool", Group::motion, Number::float64),
           schema::Column::position);
  add_axes(single("velocity", "",
                  derived.empty() ? "Velocity of the tool"
                                  : "Velocity of the tool, derived from the position: " + derived,
                  Group::motion, Number::float64),
           schema::Column::velocity);
  add_axes(
      single("force_commanded", "", "Force that the device was told to exert", Group::force, Number::float64),
      schema::Column::force_commanded);
  add_axes(single("force_measured", "", "Force that a sensor measured; not a number where it had none",
                  Group::force, Number::float64),
           schema::Column::force_measured);
  for (std::size_t i = 0; i < about().channels.size(); ++i) {
    const schema::Channel& channel = about().channels[i];
    add({.quantity = "channel",
         .part = channel.name,
         .unit = channel.unit,
         .meaning = "A further measured channel",
         .source = "/samples/channels/" + channel.name,
         .group = Group::channels,
         .number = Number::float64},
        {.of = i});
  }
  const auto timing = [&](const char* name, const char* meaning, schema::Column column) {
    if (rows_->width(column) > 0)
      add(single(name, "s", meaning, Group::timing, Number::float32), {.column = column});
  };
  timing("wake_latency", "From the deadline to the wake-up", schema::Column::wake_latency);
  timing("read_time", "Reading the device", schema::Column::read_time);
  timing("compute_time", "Computing the law", schema::Column::compute_time);
  timing("write_time", "Writing the force", schema::Column::write_time);
  if (rows_->has_flags()) add(single("flags", "1", meaning_of_flags(), Group::timing, Number::uint32), {});
}

void RecordingColumns::add(RecordingColumn column, Place place) {
  columns_.push_back(std::move(column));
  places_.push_back(place);
}

void RecordingColumns::add_axes(RecordingColumn column, schema::Column from) {
  const std::size_t width = rows_->width(from);
  for (std::size_t axis = 0; axis < width; ++axis) {
    column.part = about().axes[axis].name;
    column.unit = unit_of_axis(about().axes[axis], from);
    add(column, {.column = from, .of = axis, .width = width});
  }
}

std::uint64_t RecordingColumns::rows_of_a_block() const noexcept {
  constexpr std::size_t numbers = std::size_t{1} << 18U;
  return std::max<std::uint64_t>(64, numbers / columns_.size());
}

void RecordingColumns::read(std::size_t column, std::uint64_t first, std::uint64_t count,
                            ColumnValues& values) const {
  const RecordingColumn& what = columns_[column];
  const Place& place = places_[column];
  const auto size = static_cast<std::size_t>(count);
  if (what.number == Number::uint64) {
    values.whole.resize(size);
    rows_->read_ticks(first, values.whole);
  } else if (what.number == Number::uint32) {
    std::vector<std::uint32_t> flags(size);
    rows_->read_flags(first, flags);
    values.whole.assign(flags.begin(), flags.end());
  } else if (what.group == Group::channels) {
    values.real.resize(size);
    rows_->read_channel(place.of, first, values.real);
  } else if (place.width == 1) {
    values.real.resize(size);
    rows_->read(place.column, first, count, values.real);
  } else {
    std::vector<double> all(size * place.width);
    rows_->read(place.column, first, count, all);
    values.real.resize(size);
    for (std::size_t i = 0; i < size; ++i) values.real[i] = all[i * place.width + place.of];
  }
}

void RecordingColumns::read_all(std::uint64_t first, std::uint64_t count,
                                std::vector<ColumnValues>& values) const {
  values.resize(columns_.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (places_[i].width == 1) {
      read(i, first, count, values[i]);
      continue;
    }
    // The axes of one dataset follow each other: it is read once for all of them.
    const std::size_t width = places_[i].width;
    std::vector<double> all(static_cast<std::size_t>(count) * width);
    rows_->read(places_[i].column, first, count, all);
    for (std::size_t axis = 0; axis < width; ++axis) {
      std::vector<double>& real = values[i + axis].real;
      real.resize(static_cast<std::size_t>(count));
      for (std::size_t row = 0; row < real.size(); ++row) real[row] = all[row * width + axis];
    }
    i += width - 1;
  }
}

}  // namespace kerf::bench

#include "recordings/summary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "signal/streamed_median.h"

namespace kerf::bench {
namespace {

/// Smallest and largest finite value, and how many are not finite.
struct Range {
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
  std::size_t not_finite = 0;

  void add(double value) {
    if (!std::isfinite(value)) {
      ++not_finite;
      return;
    }
    min = std::min(min, value);
    max = std::max(max, value);
  }
};

void add_channel(nlohmann::ordered_json& summary, const std::string& name, const std::string& unit,
                 const Range& range) {
  nlohmann::ordered_json channel{{"unit", unit}, {"min", nullptr}, {"max", nullptr}};
  if (range.min <= range.max) {
    channel["min"] = range.min;
    channel["max"] = range.max;
  }
  summary["channels"][name] = std::move(channel);
  if (range.not_finite > 0) {
    summary["warnings"].push_back(
        fmt::format("{} holds {} values that are not finite", name, range.not_finite));
  }
}

constexpr std::uint64_t block_rows = 65536;

/// Calls `look` with a block of values after the other, each with the row that it begins with.
template <typename Number, typename Read, typename Look>
void in_blocks(std::uint64_t rows, std::size_t width, const Read& read, const Look& look) {
  std::vector<Number> values;
  for (std::uint64_t first = 0; first < rows; first += block_rows) {
    values.resize(std::min(block_rows, rows - first) * width);
    read(first, std::span(values));
    look(first, std::span<const Number>(values));
  }
}

template <typename Look>
void in_blocks(const schema::RecordedRows& rows, schema::Column column, const Look& look) {
  const std::size_t width = rows.width(column);
  const auto read = [&](std::uint64_t first, std::span<double> values) {
    rows.read(column, first, values.size() / width, values);
  };
  if (width > 0) in_blocks<double>(rows.rows(), width, read, look);
}

/// One channel an axis; with a single axis the dataset's name alone, else "position.theta".
void add_axes(nlohmann::ordered_json& summary, const schema::RecordedRows& rows, const std::string& name,
              schema::Column column, std::string (*unit)(const schema::Axis&)) {
  const std::vector<schema::Axis>& axes = rows.about().axes;
  if (rows.width(column) == 0) return;
  std::vector<Range> ranges(axes.size());
  in_blocks(rows, column, [&](std::uint64_t, std::span<const double> values) {
    for (std::size_t i = 0; i < values.size(); ++i) ranges[i % ranges.size()].add(values[i]);
  });
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    add_channel(summary, axes.size() == 1 ? name : name + "." + axes[axis].name, unit(axes[axis]),
                ranges[axis]);
  }
}

void add_latency(nlohmann::ordered_json& summary, const schema::RecordedRows& rows, const std::string& name,
                 schema::Column column) {
  if (rows.width(column) == 0) return;
  Range range;
  in_blocks(rows, column, [&](std::uint64_t, std::span<const double> values) {
    for (const double value : values) range.add(value);
  });
  add_channel(summary, name, "s", range);
}

void add_channels(nlohmann::ordered_json& summary, const schema::RecordedRows& rows) {
  for (std::size_t i = 0; i < rows.about().channels.size(); ++i) {
    Range range;
    in_blocks<double>(
        rows.rows(), 1,
        [&](std::uint64_t first, std::span<double> values) { rows.read_channel(i, first, values); },
        [&](std::uint64_t, std::span<const double> values) {
          for (const double value : values) range.add(value);
        });
    add_channel(summary, rows.about().channels[i].name, rows.about().channels[i].unit, range);
  }
}

double median_step(const schema::RecordedRows& rows) {
  if (rows.rows() < 2) return 0.0;
  return StreamedMedian::of([&](const auto& look) {
    double before = 0.0;
    in_blocks(rows, schema::Column::time, [&](std::uint64_t first, std::span<const double> time) {
      for (std::size_t i = 0; i < time.size(); ++i) {
        if (first + i > 0) look(time[i] - before);
        before = time[i];
      }
    });
  });
}

/// What is odd about the times, looked at in one pass.
struct TimeFacts {
  std::size_t gaps = 0;  ///< places where ticks are missing, or where a period is far longer than the others
  std::size_t repeated = 0;
  std::size_t backward = 0;
  std::size_t not_finite = 0;

  TimeFacts(const schema::RecordedRows& rows, double period_s) {
    constexpr double far_longer = 2.5;
    double before_s = 0.0;
    std::uint64_t tick_before = 0;
    std::vector<std::uint64_t> ticks;
    in_blocks(rows, schema::Column::time, [&](std::uint64_t first, std::span<const double> time) {
      ticks.resize(time.size());
      rows.read_ticks(first, ticks);
      for (std::size_t i = 0; i < time.size(); ++i) {
        not_finite += std::isfinite(time[i]) ? 0 : 1;
        if (first + i > 0) {
          gaps += ticks[i] > tick_before + 1 || time[i] - before_s > far_longer * period_s ? 1 : 0;
          repeated += time[i] == before_s ? 1 : 0;
          backward += time[i] < before_s ? 1 : 0;
        }
        before_s = time[i];
        tick_before = ticks[i];
      }
    });
  }

  void warn(nlohmann::ordered_json& warnings) const {
    if (not_finite > 0)
      warnings.push_back(fmt::format("time holds {} values that are not finite", not_finite));
    if (repeated > 0) warnings.push_back(fmt::format("time repeats at {} rows", repeated));
    if (backward > 0) warnings.push_back(fmt::format("time goes back at {} rows", backward));
  }
};

double time_at(const schema::RecordedRows& rows, std::uint64_t row) {
  double time_s = 0.0;
  rows.read(schema::Column::time, row, 1, std::span(&time_s, 1));
  return time_s;
}

nlohmann::ordered_json lines_of(const std::string& text) {
  nlohmann::ordered_json lines = nlohmann::ordered_json::array();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin) lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

void add_header(nlohmann::ordered_json& summary, const schema::Recording& recording) {
  const schema::Header& header = recording.header;
  summary["schema"] = schema::schema_name;
  summary["schema_version"] = schema::schema_version;
  summary["status"] = header.status;
  summary["created"] = header.created;
  summary["software"] = header.software;
  summary["uuid"] = header.uuid;
  if (!header.source.empty()) summary["source"] = header.source;
  if (!header.history.empty()) summary["history"] = lines_of(header.history);
  if (!header.device_uri.empty()) summary["device"] = header.device_uri;
  if (!header.velocity_derived.empty()) summary["velocity_derived"] = header.velocity_derived;
  summary["axes"] = nlohmann::ordered_json::array();
  for (const schema::Axis& axis : recording.axes) {
    summary["axes"].push_back({{"name", axis.name},
                               {"position_unit", axis.position_unit},
                               {"force_unit", axis.force_unit},
                               {"lever", axis.lever}});
    if (std::isnan(axis.contact_position)) continue;
    summary["axes"].back()["contact"] = {{"position", axis.contact_position},
                                         {"direction", axis.contact_direction}};
  }
  summary["events"] = recording.events.size();
}

void add_cycles(nlohmann::ordered_json& summary, const schema::Recording& recording) {
  if (!recording.cycles) return;
  const schema::Cycles& cycles = *recording.cycles;
  summary["cycles"] = {{"count", cycles.closing.size()},
                       {"axis", cycles.axis < recording.axes.size() ? recording.axes[cycles.axis].name : "?"},
                       {"closing_direction", cycles.closing_direction},
                       {"contact_position", cycles.contact_position},
                       {"filter_corner_hz", cycles.filter_corner_hz},
                       {"phases", cycles.phases.size()},
                       {"grid_points", cycles.grid.size()}};
}

}  // namespace

nlohmann::ordered_json recording_summary(const schema::RecordedRows& rows) {
  using schema::Column;
  const double period_s = median_step(rows);
  const TimeFacts time(rows, period_s);
  nlohmann::ordered_json summary{
      {"samples", rows.rows()},
      {"duration_s", rows.rows() == 0 ? 0.0 : time_at(rows, rows.rows() - 1) - time_at(rows, 0)},
      {"rate_hz", period_s > 0.0 ? 1.0 / period_s : 0.0},
      {"gaps", time.gaps},
      {"channels", nlohmann::ordered_json::object()},
      {"warnings", nlohmann::ordered_json::array()}};
  time.warn(summary["warnings"]);
  const auto position = [](const schema::Axis& axis) { return axis.position_unit; };
  const auto velocity = [](const schema::Axis& axis) { return axis.position_unit + "/s"; };
  const auto force = [](const schema::Axis& axis) { return axis.force_unit; };
  add_axes(summary, rows, "position", Column::position, position);
  add_axes(summary, rows, "velocity", Column::velocity, velocity);
  add_axes(summary, rows, "force_commanded", Column::force_commanded, force);
  add_axes(summary, rows, "force_measured", Column::force_measured, force);
  add_latency(summary, rows, "wake_latency", Column::wake_latency);
  add_latency(summary, rows, "read_time", Column::read_time);
  add_latency(summary, rows, "compute_time", Column::compute_time);
  add_latency(summary, rows, "write_time", Column::write_time);
  add_channels(summary, rows);
  add_header(summary, rows.about());
  add_cycles(summary, rows.about());
  return summary;
}

nlohmann::ordered_json recording_summary(const schema::Recording& recording) {
  return recording_summary(schema::RowsInMemory(recording));
}

std::string summary_table(const nlohmann::ordered_json& summary) {
  std::string table;
  const auto line = [&](std::string_view name, const std::string& value) {
    table += fmt::format("{:<12}{}\n", name, value);
  };
  line("status", summary["status"].get<std::string>());
  line("created", fmt::format("{} by {}", summary["created"].get<std::string>(),
                              summary["software"].get<std::string>()));
  line("uuid", summary["uuid"].get<std::string>());
  for (const char* origin : {"source", "device"}) {
    if (summary.contains(origin)) line(origin, summary[origin].get<std::string>());
  }
  line("samples", fmt::format("{} over {:.3f} s at {:.6g} Hz", summary["samples"].get<std::size_t>(),
                              summary["duration_s"].get<double>(), summary["rate_hz"].get<double>()));
  line("gaps", std::to_string(summary["gaps"].get<std::size_t>()));
  line("events", std::to_string(summary["events"].get<std::size_t>()));
  if (summary.contains("cycles")) {
    const auto& cycles = summary["cycles"];
    line("cycles",
         fmt::format("{} along {}", cycles["count"].get<std::size_t>(), cycles["axis"].get<std::string>()));
  }
  if (summary.contains("history")) {
    for (const auto& step : summary["history"]) line("history", step.get<std::string>());
  }
  table += fmt::format("\n{:<28}{:>14}{:>14}  {}\n", "channel", "least", "most", "unit");
  const auto number = [](const nlohmann::ordered_json& value) {
    return value.is_null() ? std::string("-") : fmt::format("{:.6g}", value.get<double>() + 0.0);
  };
  for (const auto& [name, channel] : summary["channels"].items()) {
    table += fmt::format("{:<28}{:>14}{:>14}  {}\n", name, number(channel["min"]), number(channel["max"]),
                         channel["unit"].get<std::string>());
  }
  table.pop_back();
  return table;
}

}  // namespace kerf::bench

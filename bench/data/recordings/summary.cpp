#include "recordings/summary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "signal/quantiles.h"

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

/// One channel an axis; with a single axis the dataset's name alone, else "position.theta".
void add_axes(nlohmann::ordered_json& summary, const schema::Recording& recording, const std::string& name,
              const std::vector<double>& values, std::string (*unit)(const schema::Axis&)) {
  const std::size_t dimensions = recording.dimensions();
  if (values.empty()) return;
  for (std::size_t axis = 0; axis < dimensions; ++axis) {
    Range range;
    for (std::size_t i = axis; i < values.size(); i += dimensions) range.add(values[i]);
    add_channel(summary, dimensions == 1 ? name : name + "." + recording.axes[axis].name,
                unit(recording.axes[axis]), range);
  }
}

void add_latency(nlohmann::ordered_json& summary, const std::string& name, const std::vector<float>& values) {
  if (values.empty()) return;
  Range range;
  for (const float value : values) range.add(static_cast<double>(value));
  add_channel(summary, name, "s", range);
}

/// Places where ticks are missing, or where a period is far longer than the others.
std::size_t count_gaps(const schema::Recording& recording, double period_s) {
  constexpr double far_longer = 2.5;
  std::size_t gaps = 0;
  for (std::size_t i = 1; i < recording.rows(); ++i) {
    const bool jumps =
        recording.tick.size() == recording.rows() && recording.tick[i] > recording.tick[i - 1] + 1;
    const bool pauses = recording.time[i] - recording.time[i - 1] > far_longer * period_s;
    gaps += jumps || pauses ? 1 : 0;
  }
  return gaps;
}

void add_time_warnings(nlohmann::ordered_json& summary, const std::vector<double>& time) {
  std::size_t repeated = 0;
  std::size_t backward = 0;
  std::size_t not_finite = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    not_finite += std::isfinite(time[i]) ? 0 : 1;
    repeated += i > 0 && time[i] == time[i - 1] ? 1 : 0;
    backward += i > 0 && time[i] < time[i - 1] ? 1 : 0;
  }
  auto& warnings = summary["warnings"];
  if (not_finite > 0) warnings.push_back(fmt::format("time holds {} values that are not finite", not_finite));
  if (repeated > 0) warnings.push_back(fmt::format("time repeats at {} rows", repeated));
  if (backward > 0) warnings.push_back(fmt::format("time goes back at {} rows", backward));
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

nlohmann::ordered_json recording_summary(const schema::Recording& recording) {
  const double period_s = median_period(recording.time);
  nlohmann::ordered_json summary{
      {"samples", recording.rows()},
      {"duration_s", recording.time.empty() ? 0.0 : recording.time.back() - recording.time.front()},
      {"rate_hz", period_s > 0.0 ? 1.0 / period_s : 0.0},
      {"gaps", count_gaps(recording, period_s)},
      {"channels", nlohmann::ordered_json::object()},
      {"warnings", nlohmann::ordered_json::array()}};
  add_time_warnings(summary, recording.time);
  const auto position = [](const schema::Axis& axis) { return axis.position_unit; };
  const auto velocity = [](const schema::Axis& axis) { return axis.position_unit + "/s"; };
  const auto force = [](const schema::Axis& axis) { return axis.force_unit; };
  add_axes(summary, recording, "position", recording.position, position);
  add_axes(summary, recording, "velocity", recording.velocity, velocity);
  add_axes(summary, recording, "force_commanded", recording.force_commanded, force);
  add_axes(summary, recording, "force_measured", recording.force_measured, force);
  add_latency(summary, "wake_latency", recording.wake_latency);
  add_latency(summary, "read_time", recording.read_time);
  add_latency(summary, "compute_time", recording.compute_time);
  add_latency(summary, "write_time", recording.write_time);
  for (const schema::Channel& channel : recording.channels) {
    Range range;
    for (const double value : channel.values) range.add(value);
    add_channel(summary, channel.name, channel.unit, range);
  }
  add_header(summary, recording);
  add_cycles(summary, recording);
  return summary;
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

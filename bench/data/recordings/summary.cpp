#include "recordings/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "clocks/time_stamp.h"
#include "files/json_number.h"
#include "segment/cycle_edit.h"

namespace kerf::bench {
namespace {

void add_channel(nlohmann::ordered_json& summary, const std::string& name, const std::string& unit,
                 const ValueRange& range) {
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

/// What a column is called, and the unit of its values along an axis; without one they are times.
struct ColumnText {
  std::string_view name;
  std::string (*unit)(const schema::Axis&) = nullptr;
};

constexpr auto unit_of_force = [](const schema::Axis& axis) { return axis.force_unit; };

/// In the order of schema::Column.
constexpr std::array<ColumnText, 9> column_texts{
    {{.name = "time"},
     {.name = "position", .unit = [](const schema::Axis& axis) { return axis.position_unit; }},
     {.name = "velocity", .unit = [](const schema::Axis& axis) { return axis.position_unit + "/s"; }},
     {.name = "force_commanded", .unit = unit_of_force},
     {.name = "force_measured", .unit = unit_of_force},
     {.name = "wake_latency"},
     {.name = "read_time"},
     {.name = "compute_time"},
     {.name = "write_time"}}};

/// One channel an axis, "position.theta"; where a row has one value, the dataset's name alone.
void add_columns(nlohmann::ordered_json& summary, const std::vector<schema::Axis>& axes,
                 const RowFigures& figures) {
  for (const auto& [column, ranges] : figures.columns) {
    const auto& [name, unit] = column_texts.at(static_cast<std::size_t>(column));
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      add_channel(summary, ranges.size() == 1 ? std::string(name) : fmt::format("{}.{}", name, axes[i].name),
                  unit != nullptr ? unit(axes[i]) : "s", ranges[i]);
    }
  }
}

void add_channels(nlohmann::ordered_json& summary, const std::vector<schema::Channel>& channels,
                  const RowFigures& figures) {
  for (std::size_t i = 0; i < channels.size(); ++i) {
    add_channel(summary, channels[i].name, channels[i].unit, figures.channels[i]);
  }
}

void warn_of_times(nlohmann::ordered_json& warnings, const RowFigures& figures) {
  if (figures.times_not_finite > 0)
    warnings.push_back(fmt::format("time holds {} values that are not finite", figures.times_not_finite));
  if (figures.repeated > 0) warnings.push_back(fmt::format("time repeats at {} rows", figures.repeated));
  if (figures.backward > 0) warnings.push_back(fmt::format("time goes back at {} rows", figures.backward));
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
  if (header.start_ns)
    summary["start"] = {
        {"ns", *header.start_ns}, {"clock", header.start_clock}, {"text", start_text(header)}};
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
                                         {"direction", axis.contact_direction},
                                         {"error", json_number(axis.contact_error)}};
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
  for (const ToldEdit& edit : edits_of(recording))
    summary["cycles"]["edits"].push_back({{"time", edit.time}, {"author", edit.author}, {"what", edit.what}});
  if (!recording.cycle_flags) return;
  std::set<std::uint32_t> flagged;
  std::set<std::uint32_t> accepted;
  for (const schema::CycleFlag& flag : recording.cycle_flags->flags)
    (flag.fault == "accepted" ? accepted : flagged).insert(flag.cycle);
  std::erase_if(flagged, [&](std::uint32_t cycle) { return accepted.contains(cycle); });
  summary["cycles"]["flagged"] = flagged;
}

}  // namespace

nlohmann::ordered_json recording_summary(const schema::Recording& about, const RowFigures& figures) {
  nlohmann::ordered_json summary{{"samples", figures.rows},
                                 {"duration_s", figures.last_s - figures.first_s},
                                 {"rate_hz", figures.period_s > 0.0 ? 1.0 / figures.period_s : 0.0},
                                 {"gaps", figures.gaps},
                                 {"channels", nlohmann::ordered_json::object()},
                                 {"warnings", nlohmann::ordered_json::array()}};
  warn_of_times(summary["warnings"], figures);
  add_columns(summary, about.axes, figures);
  add_channels(summary, about.channels, figures);
  add_header(summary, about);
  add_cycles(summary, about);
  return summary;
}

nlohmann::ordered_json recording_summary(const schema::RecordedRows& rows) {
  return recording_summary(rows.about(), figures_of(rows));
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
  if (summary.contains("start")) line("start", summary["start"]["text"].get<std::string>());
  line("samples", fmt::format("{} over {:.3f} s at {:.6g} Hz", summary["samples"].get<std::size_t>(),
                              summary["duration_s"].get<double>(), summary["rate_hz"].get<double>()));
  line("gaps", std::to_string(summary["gaps"].get<std::size_t>()));
  line("events", std::to_string(summary["events"].get<std::size_t>()));
  if (summary.contains("cycles")) {
    const auto& cycles = summary["cycles"];
    line(
        "cycles",
        fmt::format(
            "{} along {}{}", cycles["count"].get<std::size_t>(), cycles["axis"].get<std::string>(),
            cycles.contains("flagged") ? fmt::format(", {} of them flagged", cycles["flagged"].size()) : ""));
    if (cycles.contains("edits")) {
      const auto& last = cycles["edits"].back();
      line("edited", fmt::format("by {} at {}: {}", last["author"].get<std::string>(),
                                 last["time"].get<std::string>(), last["what"].get<std::string>()));
    }
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

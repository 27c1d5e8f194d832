#include "replay/replay_files.h"

#include <fmt/core.h>

#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "recordings/provenance.h"
#include "replay/replay_page.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

json list_of(const std::vector<ForceEvent>& events) {
  json all = json::array();
  for (const ForceEvent& event : events) {
    json one{{"kind", force_event_names[static_cast<std::size_t>(event.kind)]}, {"time_s", event.time_s}};
    if (event.kind == ForceEventKind::drop) one["size"] = event.size;
    all.push_back(std::move(one));
  }
  return all;
}

json match_as_json(const EventMatch& match) {
  return {{"recorded", match.recorded},
          {"rendered", match.rendered},
          {"matched", match.late_s.size()},
          {"mean_late_ms", match.late_s.empty() ? json(nullptr) : json(1e3 * match.mean_s())},
          {"worst_late_ms", match.late_s.empty() ? json(nullptr) : json(1e3 * match.worst_s())}};
}

json axis_as_json(const AxisComparison& one, const schema::Axis& axis) {
  json result{{"axis", axis.name},
              {"unit", axis.force_unit},
              {"against", one.measured ? "measured" : "commanded"},
              {"samples", one.samples},
              {"recorded_rms", one.force_rms},
              {"jnd", one.jnd},
              {"rms", one.rms},
              {"rms_jnd", one.rms_jnd},
              {"worst", one.worst},
              {"worst_at_s", one.worst_at_s},
              {"worst_jnd", one.worst_jnd}};
  for (std::size_t kind = 0; kind < one.events.size(); ++kind)
    result["events"][std::string(force_event_names[kind])] = match_as_json(one.events[kind]);
  result["recorded_events"] = list_of(one.recorded_events);
  result["rendered_events"] = list_of(one.rendered_events);
  if (one.exact) {
    result["untouched_rows"] = one.exact->untouched;
    result["identical_rows"] = one.exact->identical;
  }
  return result;
}

}  // namespace

json open_loop_as_json(const Source& source, const OpenLoopResult& result) {
  json all{{"mode", "through"},
           {"recording_uuid", source.recording.header.uuid},
           {"rows", result.rows},
           {"from_s", source.recording.time.front()},
           {"to_s", source.recording.time[std::max<std::size_t>(result.rows, 1) - 1]},
           {"period_s", source.period_s},
           {"on_grid", source.on_grid},
           {"from_first_row", source.from_start},
           {"gaps", source.gaps.size()}};
  if (result.punctuality) {
    all["realtime"] = {{"late_ticks", result.punctuality->late},
                       {"worst_late_ms", result.punctuality->worst_ms}};
  }
  all["laws"] = json::array();
  for (const LawTrace& trace : result.laws) {
    const bool spatial = trace.file.law.is_spatial();
    json law{{"name", trace.name},
             {"model", trace.file.law.model()},
             {"direction", spatial ? json(nullptr) : json(trace.file.contact.direction)},
             {"faults", trace.faults}};
    for (const AxisComparison& one : trace.axes)
      law["axes"].push_back(axis_as_json(one, source.recording.axes[one.axis]));
    all["laws"].push_back(std::move(law));
  }
  return all;
}

json path_as_json(const Path& path, const PathReport& report, const drivers::DeviceInfo& device) {
  json result{{"pieces", path.pieces.size()},
              {"loop", path.loop},
              {"playing_ticks", report.playing},
              {"played_to_its_end", report.finished}};
  for (const std::size_t axis : path.axes) {
    const PathReport::Axis& one = report.axes[axis];
    result["axes"].push_back({{"axis", device.axes[axis].name},
                              {"unit", device.axes[axis].position_unit},
                              {"error_rms", report.error_rms(axis)},
                              {"error_worst", one.worst},
                              {"largest_reference_speed", one.largest_step / path.period_s},
                              {"speed_limit", device.axes[axis].speed_limit},
                              {"ticks_at_force_limit", one.limited}});
  }
  return result;
}

void write_open_loop(const fs::path& folder, const Source& source, const OpenLoopResult& result,
                     const json& all, bool replace) {
  require_output(folder / "replay.json", replace);
  for (const LawTrace& trace : result.laws) require_output(folder / (trace.name + ".h5"), replace);
  WholeFolder whole(folder, schema::existing_if(replace));
  for (const LawTrace& trace : result.laws)
    schema::write_recording(whole.path() / (trace.name + ".h5"), recording_of(source, trace));
  const std::vector<std::string> charts = draw_all(replay_charts(source, result));
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const std::string name = i == 0 ? "replay.svg" : fmt::format("replay-{}.svg", i + 1);
    write_whole_file(whole.path() / name, charts[i]);
  }
  write_whole_file(whole.path() / "replay.html", replay_page(all, charts));
  write_json_file(whole.path() / "replay.json", all);
  whole.commit();
}

}  // namespace kerf::bench

#include "views/recording_json.h"

#include <algorithm>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "files/for_terminal.h"
#include "files/json_number.h"
#include "segment/segment.h"
#include "views/hysteresis_loops.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t max_events = 2000;
constexpr std::size_t max_spans = 20'000;

/// Texts of a damaged file may be no UTF-8.
std::string dumped(const ordered_json& json) {
  return json_for_page(json.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

/// A loop has some hundred numbers, and there may be a hundred loops.
void append_member(std::string& text, const char* name, std::span<const double> values) {
  text += fmt::format(",\"{}\":", name);
  append_json_numbers(text, values);
}

ordered_json axes_of(const schema::Recording& about) {
  ordered_json axes = ordered_json::array();
  for (const schema::Axis& axis : about.axes) {
    axes.push_back(
        {{"name", axis.name}, {"position_unit", axis.position_unit}, {"force_unit", axis.force_unit}});
  }
  return axes;
}

ordered_json traces_of(const RecordingView& recording) {
  ordered_json traces = ordered_json::array();
  for (const Trace& trace : recording.traces()) {
    traces.push_back({{"name", trace.name}, {"unit", trace.unit}, {"group", trace.group}});
  }
  return traces;
}

ordered_json events_of(const schema::Recording& about) {
  ordered_json events = ordered_json::array();
  for (std::size_t i = 0; i < std::min(about.events.size(), max_events); ++i) {
    const schema::Event& event = about.events[i];
    events.push_back({{"time_s", json_number(event.time_s)}, {"kind", event.kind}, {"text", event.text}});
  }
  return events;
}

/// Null while nobody knows.
ordered_json gaps_of(const RowIndex* rows) {
  if (rows == nullptr) return nullptr;
  ordered_json gaps = ordered_json::array();
  for (const auto& [from_s, to_s] : rows->gaps()) gaps.push_back({json_number(from_s), json_number(to_s)});
  return gaps;
}

/// Times of rows that are asked for roughly in their order: read some thousand at a time.
class TimesInOrder {
 public:
  explicit TimesInOrder(const schema::RecordingFile& file) : file_(file) {}

  double at(std::uint64_t row) {
    if (row < first_ || row >= first_ + time_s_.size()) {
      constexpr std::uint64_t rows_at_once = 4096;
      first_ = row;
      time_s_.resize(static_cast<std::size_t>(std::min(rows_at_once, file_.rows() - row)));
      file_.read(schema::Column::time, first_, time_s_.size(), time_s_);
    }
    return time_s_[static_cast<std::size_t>(row - first_)];
  }

 private:
  const schema::RecordingFile& file_;
  std::uint64_t first_ = 0;
  std::vector<double> time_s_;
};

/// What is said of cycles in the file; null: nobody has looked.
ordered_json flags_of(const schema::Recording& about) {
  if (!about.cycle_flags) return nullptr;
  ordered_json flags = ordered_json::array();
  for (const schema::CycleFlag& flag : about.cycle_flags->flags) {
    if (flags.size() == max_spans) break;
    flags.push_back({{"cycle", flag.cycle}, {"kind", flag.fault}, {"reason", flag.reason}});
  }
  return flags;
}

ordered_json cycles_of(const RecordingView& recording) {
  const auto& cycles = recording.file().about().cycles;
  if (!cycles) return nullptr;
  ordered_json spans = ordered_json::array();
  TimesInOrder times(recording.file());
  for (const schema::PhaseSpan& span : cycles->phases) {
    if (span.begin >= span.end || span.end > recording.file().rows()) continue;
    if (spans.size() == max_spans) break;
    spans.push_back({{"cycle", span.cycle},
                     {"phase", name_of(span.phase)},
                     {"from_s", json_number(times.at(span.begin))},
                     {"to_s", json_number(times.at(span.end - 1))}});
  }
  return {{"axis", cycles->axis},
          {"closing_direction", json_number(cycles->closing_direction)},
          {"contact_position", json_number(cycles->contact_position)},
          {"spans", std::move(spans)},
          {"flags", flags_of(recording.file().about())}};
}

}  // namespace

std::string recording_json(const RecordingView& recording, const std::string& id) {
  const schema::RecordingFile& file = recording.file();
  const schema::Recording& about = file.about();
  const schema::Header& header = about.header;
  const RowIndex* const rows = recording.rows();
  return dumped({{"id", id},
                 {"rows", file.rows()},
                 {"seconds", json_number(file.rows() > 0 ? file.last_time_s() - file.first_time_s() : 0.0)},
                 {"from_s", json_number(file.rows() > 0 ? file.first_time_s() : 0.0)},
                 {"period_s", file.period_s()},
                 {"status", header.status},
                 {"device", header.device_uri},
                 {"software", header.software},
                 {"created", header.created},
                 {"history", header.history},
                 {"source", header.source},
                 {"axes", axes_of(about)},
                 {"traces", traces_of(recording)},
                 {"events", events_of(about)},
                 {"events_in_all", about.events.size()},
                 {"gaps", gaps_of(rows)},
                 {"gaps_in_all", rows == nullptr ? ordered_json(nullptr) : ordered_json(rows->gaps_in_all())},
                 {"prepared", recording.prepared()},
                 {"cycles", cycles_of(recording)}});
}

std::string loops_json(RecordingView& recording, std::size_t axis, std::size_t first, std::size_t count) {
  const AxisCycles& cycles = recording.cycles_along(axis);
  const schema::Axis& about = recording.file().about().axes[axis];
  std::string text = dumped({{"axis", about.name},
                             {"position_unit", about.position_unit},
                             {"force_unit", about.force_unit},
                             {"cycles_in_all", cycles.cycles.size()},
                             {"averaged", cycles.averaged},
                             {"segmented_here", cycles.segmented_here},
                             {"reason", cycles.why_none}});
  text.pop_back();  // the closing brace
  text += ",\"loops\":[";
  for (const ForceLoop& loop : force_loops(recording.file(), axis, cycles, first, count)) {
    text += fmt::format("{}{{\"cycle\":{},\"rows\":{}", text.back() == '[' ? "" : ",", loop.cycle, loop.rows);
    append_member(text, "position", loop.position);
    append_member(text, "force", loop.force);
    text += '}';
  }
  text += "],\"average\":{\"position\":";
  append_json_numbers(text, cycles.grid);
  append_member(text, "closing", cycles.closing);
  append_member(text, "opening", cycles.opening);
  text += '}';
  if (cycles.cycles.empty()) {
    const ForceLoop whole = whole_loop(recording.file(), axis, cycles);
    if (!whole.position.empty()) {
      text += ",\"whole\":{\"position\":";
      append_json_numbers(text, whole.position);
      append_member(text, "force", whole.force);
      text += '}';
    }
  }
  return text + '}';
}

}  // namespace kerf::bench

#include "live/live_event.h"

#include <algorithm>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "files/json_number.h"

namespace kerf::bench {
namespace {

// What a frame costs: the viewer that catches up takes a few more of them instead.
constexpr std::uint64_t max_columns_at_once = 600;
constexpr std::uint64_t max_ticks = 6000;

/// [[..],[..]], trace by trace.
void append_columns(fmt::memory_buffer& text, const std::vector<double>& values, std::size_t traces,
                    std::size_t columns) {
  text.push_back('[');
  for (std::size_t trace = 0; trace < traces; ++trace) {
    if (trace > 0) text.push_back(',');
    append_json_numbers(text, std::span(values).subspan(trace * columns, columns));
  }
  text.push_back(']');
}

/// In one line; bytes of a name that are no UTF-8 are replaced.
std::string text_of(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

nlohmann::ordered_json percentiles_as_json(const Percentiles& it) {
  return {{"p50", 1e-6 * it.p50_us},
          {"p99", 1e-6 * it.p99_us},
          {"p999", 1e-6 * it.p999_us},
          {"max", 1e-6 * it.max_us}};
}

}  // namespace

std::string to_json(const LiveFrame& frame, std::size_t traces, std::uint64_t run, double period_s) {
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), R"({{"run":{},"from":{},"ticks":{},"period_s":{},"smallest":)",
                 run, frame.from, frame.ticks_per_column, period_s);
  const std::size_t begin = text.size();
  append_columns(text, frame.smallest, traces, frame.columns);
  const std::string smallest(text.data() + begin, text.size() - begin);
  fmt::format_to(std::back_inserter(text), R"(,"largest":)");
  if (frame.ticks_per_column == 1) {
    text.append(smallest);  // of one row each
  } else {
    append_columns(text, frame.largest, traces, frame.columns);
  }
  nlohmann::ordered_json events = nlohmann::ordered_json::array();
  for (const schema::Event& event : frame.events) {
    events.push_back({{"time_s", event.time_s}, {"kind", event.kind}, {"text", event.text}});
  }
  fmt::format_to(std::back_inserter(text), R"(,"events":{}}})", text_of(events));
  return fmt::to_string(text);
}

nlohmann::ordered_json status_as_json(const LiveStatus& status) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (const drivers::AxisInfo& axis : status.axes) {
    axes.push_back(
        {{"name", axis.name}, {"position_unit", axis.position_unit}, {"force_unit", axis.force_unit}});
  }
  nlohmann::ordered_json json{{"running", status.is_running},
                              {"starting", status.is_starting},
                              {"run", status.run},
                              {"device", status.device_uri},
                              {"axes", std::move(axes)},
                              {"rate_hz", status.rate_hz},
                              {"law", status.law},
                              {"released", status.is_released},
                              {"blending", status.is_blending},
                              {"recording", nullptr},
                              {"warning", status.warning},
                              {"recording_failure", status.recording_failure},
                              {"ticks", status.ticks},
                              {"missed", status.missed},
                              {"rows_lost", status.rows_lost},
                              {"wake_s", percentiles_as_json(status.wake)},
                              {"cycle_s", percentiles_as_json(status.cycle)},
                              {"whole_wake_s", percentiles_as_json(status.whole_wake)},
                              {"whole_cycle_s", percentiles_as_json(status.whole_cycle)},
                              {"ended", status.ended},
                              {"session", status.is_session},
                              {"force", name_of(force_state(status))},
                              {"force_reason", force_reason(status)}};
  if (status.recording) {
    json["recording"] = {{"name", status.recording->name},
                         {"rows", status.recording->rows},
                         {"seconds", status.recording->seconds}};
  }
  return json;
}

nlohmann::ordered_json session_status_as_json(bool is_released) {
  LiveStatus nothing;
  nothing.is_released = is_released;
  nothing.is_session = true;
  return status_as_json(nothing);
}

nlohmann::ordered_json traces_as_json(const std::vector<Trace>& traces) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Trace& it : traces) {
    json.push_back({{"name", it.name}, {"unit", it.unit}, {"group", it.group}});
  }
  return json;
}

std::string status_event(const nlohmann::ordered_json& status) {
  return fmt::format("event: status\ndata: {}\n\n", text_of(status));
}

std::string live_event(const LiveLoop& loop, LiveCursor& cursor) {
  if (is_status_due(cursor)) {
    return status_event(status_as_json(loop.status()));
  }
  const LiveLoop::Watched watched = loop.watched();
  if (!watched.hub) return {};
  if (cursor.run != watched.run)
    cursor = {.calls = cursor.calls, .ticks_per_column = cursor.ticks_per_column, .run = watched.run};
  const RowHistory& history = watched.history();
  const std::uint64_t columns = std::clamp<std::uint64_t>(
      max_ticks / std::max<std::uint64_t>(cursor.ticks_per_column, 1), 1, max_columns_at_once);
  const LiveFrame frame = history.frame_since(cursor.tick, cursor.ticks_per_column, columns);
  cursor.tick = frame.next;
  if (frame.columns == 0) return {};
  return fmt::format("event: frame\ndata: {}\n\n",
                     to_json(frame, history.traces().size(), watched.run, history.period_s()));
}

}  // namespace kerf::bench

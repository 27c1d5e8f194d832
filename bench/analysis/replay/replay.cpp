#include "replay/replay.h"

#include <cmath>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

std::string events_in_words(const AxisComparison& one) {
  std::string words;
  for (const EventMatch& match : one.events) {
    words += fmt::format("{}{}/{}", words.empty() ? "" : ", ", match.late_s.size(), match.recorded);
    if (!match.late_s.empty()) words += fmt::format(" ({:+.1f} ms)", 1e3 * match.worst_s());
  }
  return words;
}

/// Whether the rows follow each other by one period and whole multiples of it, but for digits that a text
/// has not written.
bool is_even(const Source& source) {
  constexpr double of_a_period = 1e-3;
  const std::vector<double>& time_s = source.recording.time;
  for (std::size_t row = 1; row < time_s.size(); ++row) {
    const double periods = (time_s[row] - time_s[row - 1]) / source.period_s;
    if (!(std::abs(periods - std::round(periods)) < of_a_period)) return false;
  }
  return true;
}

}  // namespace

ThroughReplay replay_through(Source source, const std::vector<NamedLaw>& laws, const ThroughOptions& options,
                             const std::atomic<bool>& stop) {
  ThroughReplay replay;
  if (const std::string gaps = gaps_in_words(source, options.bridge); !gaps.empty())
    replay.notes.push_back(gaps);
  if (options.bridge) source = bridged(source);
  replay.source = at_speed(source, options.speed);
  if (!replay.source.on_grid && !is_even(replay.source))
    replay.notes.emplace_back(
        "the times are no whole ticks of one period, as a loop would give them; each step takes the time "
        "since the row before");
  replay.result = run_open_loop(replay.source, laws, options.open_loop, stop);
  return replay;
}

std::vector<std::string> through_lines(const ThroughReplay& replay) {
  std::vector<std::string> lines{fmt::format("  {:20} {:8} {:>9} {:>8} {:>9} {:>9} {:>8}  {}", "law", "axis",
                                             "rms", "JND", "worst", "at s", "JND",
                                             "events matched: contact, release, drop")};
  for (const LawTrace& law : replay.result.laws) {
    for (const AxisComparison& one : law.axes) {
      lines.push_back(fmt::format("  {:20} {:8} {:9.3g} {:8.2f} {:9.3g} {:9.3f} {:8.2f}  {}", law.name,
                                  replay.source.recording.axes[one.axis].name, one.rms, one.rms_jnd,
                                  one.worst, one.worst_at_s, one.worst_jnd, events_in_words(one)));
      if (!one.exact) continue;
      lines.push_back(
          fmt::format("  {:20} {} of {} commands that no safety touched are identical to the last bit", "",
                      one.exact->identical, one.exact->untouched));
    }
  }
  if (const auto& clock = replay.result.punctuality)
    lines.push_back(
        fmt::format("  by the wall clock: {} of {} ticks a period late or more, {:.2f} ms at worst",
                    clock->late, replay.result.rows, clock->worst_ms));
  return lines;
}

nlohmann::ordered_json table_as_json(const FittedLaw& table, std::size_t rows) {
  nlohmann::ordered_json json{{"mode", "table"},
                              {"rows", rows},
                              {"axis", table.file.axis},
                              {"rmse", table.result.rmse},
                              {"rmse_rendered", table.result.rendered.rmse}};
  for (const auto& [name, value] : table.file.law.options())
    std::visit([&, key = name](const auto& held) { json["law_options"][key] = held; }, value);
  return json;
}

PathReplay replay_path(const Source& source, const PathReplayOptions& options,
                       const std::atomic<bool>& stop) {
  PathReplay replay;
  RunOptions run = options.run;
  std::optional<PathRendering> rendering;
  run.rendering = [&](const drivers::DeviceInfo& device) {
    const double period_s = 1.0 / run.rate_hz;
    replay.path = make_path(source, device, period_s, options.path);
    rendering.emplace(replay.path, couplings(options.coupling, device), run.ramp_s, replay.report);
    const auto fade = static_cast<std::uint64_t>(std::ceil(run.ramp_s / period_s)) + 2;
    return OtherRendering{.step = [&](const drivers::Sample& sample,
                                      double elapsed_s) { return (*rendering)(sample, elapsed_s); },
                          .finished = [&] { return rendering->finished(); },
                          .max_ticks = replay.path.loop ? 0 : replay.path.max_ticks + fade};
  };
  replay.run = run_on_device(run, stop);
  return replay;
}

std::vector<std::string> path_lines(const PathReplay& replay) {
  std::vector<std::string> lines;
  for (const std::size_t axis : replay.path.axes) {
    const drivers::AxisInfo& about = replay.run.device.axes[axis];
    const PathReport::Axis& one = replay.report.axes[axis];
    lines.push_back(fmt::format(
        "  {}: {:.3g} {} off the path (rms), {:.3g} at worst; {} ticks at the coupling's force limit",
        about.name, replay.report.error_rms(axis), about.position_unit, one.worst, one.limited));
  }
  return lines;
}

}  // namespace kerf::bench

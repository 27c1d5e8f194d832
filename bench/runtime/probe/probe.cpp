#include "probe/probe.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "files/json_number.h"

namespace kerf::bench {
namespace {

constexpr double rate_hz = 1000.0;

bool is_wrong(const ProbedAxis& probed) noexcept { return probed.judgement.verdict == PushVerdict::wrong; }

/// Millimetres are what a person sees; an angle stays one.
std::string moved_in_words(const ProbedAxis& probed, const drivers::AxisInfo& axis) {
  const double per_force = 1e3 * probed.judgement.moved / probed.force;
  return fmt::format("{:.3g} m{}/{}", per_force, axis.position_unit, axis.force_unit);
}

}  // namespace

bool ProbeResult::all_right() const noexcept {
  return finished && std::ranges::all_of(axes, [](const ProbedAxis& probed) {
           return probed.judgement.verdict == PushVerdict::right;
         });
}

ProbeResult probe_device(const std::string& uri, const ProbeOptions& options, const std::atomic<bool>& stop) {
  std::optional<ProbeRendering> pushing;
  RunOptions run{.device_uri = uri, .rate_hz = rate_hz, .virtual_time = uri.starts_with("sim:")};
  run.is_probe = true;
  run.progress = options.progress;
  run.seconds = 1e6;
  run.rendering = [&](const drivers::DeviceInfo& device) {
    pushing.emplace(device);
    if (pushing->probed().empty()) {
      throw std::invalid_argument(
          fmt::format("{}: no axis of it has a force; there is nothing to probe", uri));
    }
    if (options.before) options.before(device, pushing->probed());
    // As much again for what is made anew.
    const double longest_s = 5.0 + 2.0 * pushing->longest_s();
    return OtherRendering{.step = [&](const drivers::Sample& sample,
                                      double elapsed_s) { return pushing->step(sample, elapsed_s); },
                          .finished = [&] { return pushing->finished(); },
                          .max_ticks = static_cast<std::uint64_t>(longest_s * rate_hz)};
  };
  run.each_row = [&](const schema::Row& row) { pushing->see(row); };
  ProbeResult result{.device = run_on_device(run, stop).device, .axes = {}};
  result.axes = pushing->probed();
  result.finished = pushing->finished();
  return result;
}

nlohmann::ordered_json probe_as_json(const ProbeResult& result) {
  nlohmann::ordered_json axes = nlohmann::ordered_json::array();
  for (const ProbedAxis& probed : result.axes) {
    const drivers::AxisInfo& axis = result.device.axes[probed.axis];
    nlohmann::ordered_json one{{"name", axis.name},
                               {"verdict", name_of(probed.judgement.verdict)},
                               {"pushes", probed.pushes},
                               {"stopped", probed.stopped},
                               {"force", probed.force},
                               {"force_unit", axis.force_unit},
                               {"moved", json_number(probed.judgement.moved)},
                               {"moved_uncertainty", json_number(probed.judgement.uncertainty)},
                               {"position_unit", axis.position_unit},
                               {"moved_per_force", json_number(probed.judgement.moved / probed.force)}};
    if (probed.judgement.instead) one["moves_instead"] = result.device.axes[*probed.judgement.instead].name;
    axes.push_back(std::move(one));
  }
  return {{"device", result.device.uri},          {"model", result.device.model},
          {"simulated", result.device.simulated}, {"finished", result.finished},
          {"all_right", result.all_right()},      {"axes", std::move(axes)}};
}

std::vector<std::string> probe_lines(const ProbeResult& result) {
  std::vector<std::string> lines{fmt::format("  {:8}{:9}{:>18}  {}", "axis", "verdict", "moved", "pushes")};
  for (const ProbedAxis& probed : result.axes) {
    const drivers::AxisInfo& axis = result.device.axes[probed.axis];
    std::string line =
        fmt::format("  {:8}{:9}{:>18}  {} of {:.3g} {}", axis.name, name_of(probed.judgement.verdict),
                    moved_in_words(probed, axis), probed.pushes, probed.force, axis.force_unit);
    if (probed.stopped > 0) line += fmt::format(", {} stopped", probed.stopped);
    if (probed.judgement.instead) {
      line += fmt::format("; {} moves instead", result.device.axes[*probed.judgement.instead].name);
    } else if (is_wrong(probed)) {
      line += "; it moves against the push";
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace kerf::bench

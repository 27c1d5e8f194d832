#include "regress/renderers/step_cost.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

std::string microseconds(double time_s) { return fmt::format("{:.3g} us", 1e6 * time_s); }

}  // namespace

StepCost step_cost(std::vector<double> times_s) {
  if (times_s.empty()) return {};
  std::ranges::sort(times_s);
  const auto at = [&](double share) {
    return times_s[static_cast<std::size_t>(std::floor(share * static_cast<double>(times_s.size() - 1)))];
  };
  return {.median_s = at(0.5), .near_all_s = at(0.99), .largest_s = times_s.back()};
}

std::string step_cost_in_words(const RenderedForces& got) {
  if (got.compute_time_s.empty()) return {};
  const StepCost cost = step_cost(got.compute_time_s);
  return fmt::format("a tick {}, 99 of 100 within {} ({}){}", microseconds(cost.median_s),
                     microseconds(cost.near_all_s), got.compute_time_of,
                     got.late == 0 ? "" : fmt::format(", {} answered after the next was due", got.late));
}

std::vector<std::string> judge_step_cost(const OutsideRenderer& renderer, const schema::StoredForces& stored,
                                         const RenderedForces& got) {
  if (!renderer.compute_times && !renderer.compute_time_s) return {};
  if (got.compute_time_s.empty())
    return {"the suite asks for compute_time, and the renderer gives none: no column compute_time[s]"};
  const StepCost now = step_cost(got.compute_time_s);
  if (renderer.compute_time_s && now.near_all_s > *renderer.compute_time_s) {
    return {fmt::format("99 of 100 ticks took up to {} ({}), and {} is allowed", microseconds(now.near_all_s),
                        got.compute_time_of, microseconds(*renderer.compute_time_s))};
  }
  if (!renderer.compute_times || stored.compute_time_s.empty()) return {};
  if (stored.compute_time_of != got.compute_time_of) {
    return {fmt::format("the time of a tick is that of the {}, and what is stored is that of the {}",
                        got.compute_time_of, stored.compute_time_of)};
  }
  const double before_s = step_cost(stored.compute_time_s).median_s;
  if (now.median_s <= *renderer.compute_times * before_s) return {};
  return {fmt::format(
      "a tick takes {} where {} are stored ({}, medians): {:.2g} times as much, and {:g} times is "
      "allowed",
      microseconds(now.median_s), microseconds(before_s), got.compute_time_of, now.median_s / before_s,
      *renderer.compute_times)};
}

}  // namespace kerf::bench

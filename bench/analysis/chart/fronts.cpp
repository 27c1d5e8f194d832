#include "chart/fronts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/core.h>

#include "chart/pareto_front.h"

namespace kerf::bench {
namespace {

constexpr double near_factor = 1.5;  // of the least cost at an error
constexpr std::size_t most_near = 16;
constexpr double screening_share = 0.5;  // of the progress

bool can_compete(const ChartPoint& point, double rate_hz) {
  return point.stability.stable != Stable::no && point.rate_hz == rate_hz;
}

/// A point that is within the JND by its root mean square alone counts as one that errs by a whole JND.
double counted_error(const ChartPoint& point) {
  return within_jnd(point) ? point.error_jnd : std::max(point.error_jnd, 1.0);
}

using CostOf = std::function<double(const ChartPoint&)>;

/// How many times a point's cost is the least of those that are as good; infinite if it is not known.
double times_the_least(const ChartPoint& of, const SpeedAccuracy& chart, const CostOf& cost) {
  double least = std::numeric_limits<double>::infinity();
  for (const ChartPoint& rival : chart.points) {
    if (!can_compete(rival, chart.rate_hz) || !as_good_as(rival, of, chart.jnd_n)) continue;
    if (std::isfinite(cost(rival))) least = std::min(least, cost(rival));
  }
  return std::isfinite(cost(of)) ? cost(of) / std::max(least, 1.0) : std::numeric_limits<double>::infinity();
}

std::vector<std::size_t> front_by(const SpeedAccuracy& chart, const CostOf& cost) {
  std::vector<ParetoEntry> entries;
  for (const ChartPoint& point : chart.points) {
    entries.push_back({.cost_ns = cost(point),
                       .error = counted_error(point),
                       .parameters = point.parameters,
                       .name = point.law,
                       .competes = can_compete(point, chart.rate_hz)});
  }
  return pareto_front(entries, [&](std::size_t one, std::size_t other) {
    return as_good_as(chart.points[one], chart.points[other], chart.jnd_n);
  });
}

ColdTail measured_tail(const std::vector<ChartPoint>& points) {
  const auto any = [&](ColdTail tail) {
    return std::ranges::any_of(
        points, [&](const ChartPoint& point) { return std::isfinite(cold_tail_ns(point, tail)); });
  };
  if (any(ColdTail::p999)) return ColdTail::p999;
  return any(ColdTail::p99) ? ColdTail::p99 : ColdTail::none;
}

}  // namespace

bool as_good_as(const ChartPoint& point, const ChartPoint& best, double jnd_n) {
  if (within_jnd(best) && !within_jnd(point)) return false;
  const auto has_folds = [](const ChartPoint& it) {
    return it.fit != nullptr && std::isfinite(it.fit->held_out_rmse());
  };
  if (has_folds(point) && has_folds(best)) return fitting::as_good_as(*point.fit, *best.fit, jnd_n);
  return fitting::left_out(counted_error(point), counted_error(best)) <= 1.0;
}

double cold_tail_ns(const ChartPoint& point, ColdTail tail) {
  if (tail == ColdTail::none) return std::numeric_limits<double>::quiet_NaN();
  return tail == ColdTail::p999 ? point.cost.cold.p999_ns : point.cost.cold.p99_ns;
}

std::vector<std::size_t> near_fronts(const SpeedAccuracy& chart) {
  const std::vector<ChartPoint>& points = chart.points;
  struct Near {
    double times = 0.0;
    std::size_t place = 0;
  };
  std::vector<Near> near;
  for (std::size_t place = 0; place < points.size(); ++place) {
    const ChartPoint& point = points[place];
    if (!can_compete(point, chart.rate_hz) || !std::isfinite(point.error_jnd)) continue;
    const auto times = [&](const CostOf& cost) { return times_the_least(point, chart, cost); };
    const double typical = times([](const ChartPoint& it) { return it.cost.p50_ns; });
    const double cold = times([](const ChartPoint& it) { return it.cost.cold.p99_ns; });
    near.push_back({std::min(typical, cold), place});
  }
  for (const std::size_t place : front_by(chart, [](const ChartPoint& it) { return it.cost.p50_ns; })) {
    for (Near& it : near) it.times = it.place == place ? 0.0 : it.times;
  }
  std::erase_if(near, [](const Near& it) { return it.times > near_factor; });
  std::ranges::stable_sort(near, {}, &Near::times);
  if (near.size() > most_near) near.resize(most_near);
  std::vector<std::size_t> places;
  for (const Near& it : near) places.push_back(it.place);
  std::ranges::sort(places);
  return places;
}

bool measure_costs(SpeedAccuracy& chart, std::span<const TimedLaw> laws, const ChartOptions& options,
                   std::size_t from) {
  const auto tell = [&](double share) {
    if (options.done == nullptr) return;
    *options.done = from + static_cast<std::size_t>(share * static_cast<double>(chart_steps - from));
  };
  const std::size_t asked = options.timing.cold_ticks;
  TickCostOptions timing = options.timing;
  timing.stop = options.stop;
  timing.cold_ticks = std::min(asked, ticks_for_p99);
  timing.told = [&](double share) { tell(screening_share * share); };
  const auto costs = tick_costs(laws, timing);
  if (costs.empty() && !laws.empty()) return false;
  for (std::size_t i = 0; i < costs.size(); ++i) chart.points[i].cost = costs[i];
  if (asked <= ticks_for_p99) return true;
  const std::vector<std::size_t> near = near_fronts(chart);
  std::vector<TimedLaw> again;
  for (const std::size_t place : near) again.push_back(laws[place]);
  const ColdCosts cold = cold_costs(again, {.ticks = asked, .stop = options.stop, .told = [&](double share) {
                                              tell(screening_share + (1.0 - screening_share) * share);
                                            }});
  if (cold.laws.size() != near.size()) return false;
  for (std::size_t i = 0; i < near.size(); ++i) chart.points[near[i]].cost.cold = cold.laws[i];
  chart.empty_tick = cold.empty;
  const bool short_of_time =
      std::ranges::any_of(cold.laws, [&](const ColdCost& it) { return it.ticks < asked; });
  if (short_of_time)
    chart.notes.push_back(fmt::format("there was no time for {} cold ticks of each point near the fronts: {}",
                                      asked, cold.laws.back().ticks));
  return true;
}

void mark_fronts(SpeedAccuracy& chart) {
  chart.cold_tail = measured_tail(chart.points);
  for (ChartPoint& point : chart.points) point.on_front = point.on_cold_front = false;
  const auto typical = [](const ChartPoint& point) { return point.cost.p50_ns; };
  for (const std::size_t place : front_by(chart, typical)) chart.points[place].on_front = true;
  const auto tail = [&](const ChartPoint& point) { return cold_tail_ns(point, chart.cold_tail); };
  for (const std::size_t place : front_by(chart, tail)) chart.points[place].on_cold_front = true;
}

}  // namespace kerf::bench

#pragma once

#include <span>
#include <vector>

#include "chart/speed_accuracy.h"

namespace kerf::bench {

/// Measures what the points cost, `laws` in their order. Every point has up to ticks_for_p99 cold ticks;
/// those that are near_fronts() have options.timing.cold_ticks of them, in their turn. False if it was
/// stopped. What of options.done is left from `from` on is filled.
[[nodiscard]] bool measure_costs(SpeedAccuracy& chart, std::span<const TimedLaw> laws,
                                 const ChartOptions& options, std::size_t from);

/// The points, by their places, that could be on a front by median or by cold p99 if these were measured
/// better: no point that is as good costs less than two thirds of theirs, by one of the two. Those of
/// the front by median are among them. The sixteen
/// nearest if they are more.
[[nodiscard]] std::vector<std::size_t> near_fronts(const SpeedAccuracy& chart);

/// Whether a point is as good as another by the rule of simplicity of fits (fitting::as_good_as(), by its
/// folds; else it leaves out no more than a JND), except that nothing else is as good as what is
/// within_jnd().
[[nodiscard]] bool as_good_as(const ChartPoint& point, const ChartPoint& best, double jnd_n);

/// Marks the points of both fronts (pareto_front.h): one by cost p50, warm, and one by the cold tail, which
/// is p99.9 if any point has it, else p99.
void mark_fronts(SpeedAccuracy& chart);

/// A point's cost by that tail [ns]; NaN if it was not measured.
[[nodiscard]] double cold_tail_ns(const ChartPoint& point, ColdTail tail);

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "plot/plot.h"
#include "report/fit_view.h"

namespace kerf::bench {

/// What a law leaves over time, on a scale that several laws share.
[[nodiscard]] Chart residual_over_time(const FitView& view, const FittedTrace& trace, double largest);

/// Against penetration and velocity: samples, and the mean with its spread in bins.
[[nodiscard]] Chart residual_over_penetration(const FitView& view, const FittedTrace& trace, double largest);
[[nodiscard]] Chart residual_over_velocity(const FitView& view, const FittedTrace& trace, double largest);

/// Its autocorrelation, with the band in which 95 % of that of white noise would lie.
[[nodiscard]] Chart residual_autocorrelation(const FitView& view, const FittedTrace& trace);

/// Its histogram beside the normal distribution of the same mean and deviation.
[[nodiscard]] Chart residual_histogram(const FitView& view, const FittedTrace& trace);

/// Autocorrelation of the numbers among values, by the pairs of which both are, at lags of 0, step, 2 step,
/// ... up to `most` samples.
[[nodiscard]] std::vector<double> autocorrelation(std::span<const double> values, std::size_t step,
                                                  std::size_t most);

}  // namespace kerf::bench

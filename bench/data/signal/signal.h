#pragma once

#include <span>
#include <vector>

namespace kerf::bench {

/// Zero-phase low-pass: a second-order Butterworth filter run forward and backward over uniform samples
/// (so fourth order in magnitude, -6 dB at `corner_hz`), with odd reflection at the ends.
/// Requires 0 < corner_hz < rate_hz / 2 and at least two samples; throws std::invalid_argument otherwise.
[[nodiscard]] std::vector<double> low_pass_zero_phase(std::span<const double> values, double rate_hz,
                                                      double corner_hz);

/// Slope of a quadratic fitted by least squares to the samples within +- window_s / 2 of each one
/// (Savitzky-Golay for samples that need not be uniform): zero phase, exact on parabolas.
[[nodiscard]] std::vector<double> differentiate(std::span<const double> time_s,
                                                std::span<const double> values, double window_s);

/// Linear interpolation at `new_time_s`; outside the range the end values hold. Times must increase strictly.
[[nodiscard]] std::vector<double> interpolate(std::span<const double> time_s, std::span<const double> values,
                                              std::span<const double> new_time_s);

}  // namespace kerf::bench

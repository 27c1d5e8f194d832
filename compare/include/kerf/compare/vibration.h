#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace kerf::compare {

/// Smallest vibration that a hand feels on a tool that it holds, as RMS of the force [N] at a frequency [Hz]:
/// some 15 mN at 10 Hz, 3 mN between 160 and 250 Hz, 30 mN at 1 kHz, along straight lines of the logarithms
/// between. Orders of magnitude, from memory of [Israr2006] (a stylus) and [Hatzfeld2012] (a fingertip); of a
/// torque [N·m] that of a force at the fingers (`fingers_m`), as [ZhangBoyles2018] found across a stylus.
[[nodiscard]] double vibration_threshold(double frequency_hz, std::string_view force_unit) noexcept;

/// What is in one band of frequency.
struct BandLevel {
  double from_hz = 0.0;
  double to_hz = 0.0;
  double rms = 0.0;           ///< over the whole run, in the unit of the force
  double worst_rms = 0.0;     ///< of the worst window
  double worst_time_s = 0.0;  ///< the middle of that window, from the first row
  double threshold = 0.0;     ///< the smallest vibration_threshold() within the band
  [[nodiscard]] double thresholds() const noexcept { return worst_rms / threshold; }
};

/// RMS of values by band: octaves from 20 Hz to half the rate, over windows of a quarter of a second that
/// overlap by half, each without its straight line and under a Hann window. None for fewer rows than a window
/// has, or a rate that leaves no band. Values that are not finite count as zero.
[[nodiscard]] std::vector<BandLevel> band_levels(std::span<const double> values, double rate_hz,
                                                 std::string_view force_unit);

}  // namespace kerf::compare

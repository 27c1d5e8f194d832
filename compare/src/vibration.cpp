#include "kerf/compare/vibration.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kerf/compare/jnd.h"
#include "spectrum.h"

namespace kerf::compare {
namespace {

struct FeltVibration {
  double frequency_hz;
  double rms_n;
};
/// [Israr2006], [Hatzfeld2012]: rounded, see the header.
constexpr std::array<FeltVibration, 8> felt_vibrations{{{10.0, 0.015},
                                                        {20.0, 0.012},
                                                        {40.0, 0.008},
                                                        {80.0, 0.005},
                                                        {160.0, 0.003},
                                                        {250.0, 0.003},
                                                        {500.0, 0.008},
                                                        {1000.0, 0.03}}};
constexpr double first_band_hz = 20.0;
constexpr double window_s = 0.25;  ///< about as long as a hand gathers a vibration

/// Below and above what was measured the threshold stays as it is.
double threshold_n(double frequency_hz) {
  const auto above =
      std::ranges::lower_bound(felt_vibrations, frequency_hz, {}, &FeltVibration::frequency_hz);
  if (above == felt_vibrations.begin()) return above->rms_n;
  if (above == felt_vibrations.end()) return felt_vibrations.back().rms_n;
  const auto below = above - 1;
  const double share =
      std::log(frequency_hz / below->frequency_hz) / std::log(above->frequency_hz / below->frequency_hz);
  return below->rms_n * std::pow(above->rms_n / below->rms_n, share);
}

/// Octaves up to half the rate, which belongs to the last one.
std::vector<BandLevel> bands_of(double rate_hz, std::string_view force_unit) {
  std::vector<BandLevel> bands;
  const double most_hz = 0.5 * rate_hz;
  for (double from = first_band_hz; from < most_hz; from *= 2.0) {
    BandLevel band{.from_hz = from, .to_hz = std::min(2.0 * from, most_hz)};
    if (most_hz < 2.4 * from) band.to_hz = most_hz;
    band.threshold =
        std::min(vibration_threshold(band.from_hz, force_unit), vibration_threshold(band.to_hz, force_unit));
    for (const FeltVibration& one : felt_vibrations) {
      if (one.frequency_hz > band.from_hz && one.frequency_hz < band.to_hz)
        band.threshold = std::min(band.threshold, vibration_threshold(one.frequency_hz, force_unit));
    }
    bands.push_back(band);
    if (band.to_hz == most_hz) break;
  }
  return bands;
}

}  // namespace

double vibration_threshold(double frequency_hz, std::string_view force_unit) noexcept {
  return threshold_n(frequency_hz) * (force_unit == "N·m" ? fingers_m : 1.0);
}

std::vector<BandLevel> band_levels(std::span<const double> values, double rate_hz,
                                   std::string_view force_unit) {
  const Windows windows = windows_of(values.size(), rate_hz, window_s);
  if (windows.count == 0) return {};
  std::vector<BandLevel> bands = bands_of(rate_hz, force_unit);
  WindowSpectrum spectrum(windows.length);
  const double bin_hz = rate_hz / static_cast<double>(windows.length);
  for (std::size_t window = 0; window < windows.count; ++window) {
    const auto& bins = spectrum.of(values.subspan(windows.begin(window), windows.length));
    for (BandLevel& band : bands) {
      const auto begin = static_cast<std::size_t>(std::ceil(band.from_hz / bin_hz));
      const bool last = band.to_hz >= 0.5 * rate_hz;
      const auto end = last ? bins.size() : static_cast<std::size_t>(std::ceil(band.to_hz / bin_hz));
      double square = 0.0;
      for (std::size_t bin = begin; bin < end; ++bin) square += std::norm(bins[bin]);
      band.rms += square / static_cast<double>(windows.count);
      if (std::sqrt(square) <= band.worst_rms) continue;
      band.worst_rms = std::sqrt(square);
      band.worst_time_s =
          (static_cast<double>(windows.begin(window)) + 0.5 * static_cast<double>(windows.length)) / rate_hz;
    }
  }
  for (BandLevel& band : bands) band.rms = std::sqrt(band.rms);
  return bands;
}

}  // namespace kerf::compare

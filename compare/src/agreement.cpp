#include "kerf/compare/agreement.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include <fmt/core.h>

#include "lag.h"
#include "spectrum.h"

namespace kerf::compare {
namespace {

/// By Welch's method: windows of a second that overlap by half, octaves from 5 Hz on.
std::vector<BandCoherence> coherence_of(std::span<const double> a, std::span<const double> b,
                                        double rate_hz) {
  constexpr double first_hz = 5.0;
  const Windows windows = windows_of(a.size(), rate_hz, 1.0);
  if (windows.count < 4) return {};
  WindowSpectrum spectrum(windows.length);
  const std::size_t bins = windows.length / 2 + 1;
  std::vector<double> aa(bins, 0.0);
  std::vector<double> bb(bins, 0.0);
  std::vector<std::complex<double>> ab(bins);
  for (std::size_t window = 0; window < windows.count; ++window) {
    const auto x = spectrum.of(a.subspan(windows.begin(window), windows.length));
    const auto& y = spectrum.of(b.subspan(windows.begin(window), windows.length));
    for (std::size_t bin = 0; bin < bins; ++bin) {
      aa[bin] += std::norm(x[bin]);
      bb[bin] += std::norm(y[bin]);
      ab[bin] += std::conj(x[bin]) * y[bin];
    }
  }
  const double bin_hz = rate_hz / static_cast<double>(windows.length);
  std::vector<BandCoherence> bands;
  for (double from = first_hz; from < 0.5 * rate_hz; from *= 2.0) {
    BandCoherence band{.from_hz = from, .to_hz = std::min(2.0 * from, 0.5 * rate_hz)};
    double weights = 0.0;
    for (auto bin = static_cast<std::size_t>(std::ceil(from / bin_hz));
         bin < bins && static_cast<double>(bin) * bin_hz < band.to_hz; ++bin) {
      if (!(aa[bin] > 0.0) || !(bb[bin] > 0.0)) continue;
      band.coherence += std::norm(ab[bin]) / bb[bin];
      weights += aa[bin];
    }
    band.coherence = weights > 0.0 ? std::min(1.0, band.coherence / weights) : 0.0;
    bands.push_back(band);
  }
  return bands;
}

ChannelAgreement agreement_of(const Channel& expected, const Channel& got, double period_s, double most_lag_s,
                              const Stretch& stretch) {
  ChannelAgreement result{.channel = {.name = expected.name, .unit = expected.unit}};
  // Rows in which either is no number say nothing of the others.
  const auto is_number = [&](std::size_t row) {
    return std::isfinite(expected.value[row]) && std::isfinite(got.value[row]);
  };
  const auto rows = static_cast<double>(expected.value.size());
  double count = 0.0;
  double sum_e = 0.0;
  double sum_g = 0.0;
  for (std::size_t row = 0; row < expected.value.size(); ++row) {
    if (!is_number(row)) continue;
    count += 1.0;
    sum_e += expected.value[row];
    sum_g += got.value[row];
  }
  double ee = 0.0;
  double eg = 0.0;
  double gg = 0.0;
  double square = 0.0;
  double moment = 0.0;
  for (std::size_t row = 0; row < expected.value.size(); ++row) {
    if (!is_number(row)) continue;
    const double e = expected.value[row] - sum_e / count;
    const double g = got.value[row] - sum_g / count;
    const double apart = got.value[row] - expected.value[row];
    ee += e * e;
    eg += e * g;
    gg += g * g;
    square += apart * apart;
    moment += (static_cast<double>(row) - 0.5 * (rows - 1.0)) * apart;
  }
  if (count == 0.0) return result;
  result.gain = ee > 0.0 ? eg / ee : 1.0;
  result.offset = sum_g / count - result.gain * sum_e / count;
  result.drift = moment * 12.0 / (rows * (rows + 1.0));
  result.rms_difference = std::sqrt(square / count);
  result.correlation = ee > 0.0 && gg > 0.0 ? eg / std::sqrt(ee * gg) : 0.0;
  if (ee > 0.0 && gg > 0.0 && count == rows) {
    const auto most = static_cast<std::size_t>(std::max(4.0, most_lag_s / period_s));
    const auto fit =
        fit_lag(stretch.of(expected.value), stretch.of(got.value), {.most_ticks = most, .free_gain = true});
    if (fit && !fit->is_longer) {
      result.latency_s = fit->ticks * period_s;
      result.latency_std_error_s = fit->std_error * period_s;
    }
    result.coherence = coherence_of(expected.value, got.value, 1.0 / period_s);
  }
  return result;
}

}  // namespace

std::vector<ChannelAgreement> agreement(const Series& expected, const Series& got, double most_lag_s) {
  if (expected.rows() != got.rows() || expected.channels.size() != got.channels.size() || expected.rows() < 2)
    throw std::invalid_argument(fmt::format("{} rows of {} channels beside {} of {}: align them first",
                                            got.rows(), got.channels.size(), expected.rows(),
                                            expected.channels.size()));
  std::vector<ChannelAgreement> all;
  const double period_s = expected.period();
  const Stretch stretch = longest_stretch(expected.time_s, expected.rows(), period_s);
  for (std::size_t channel = 0; channel < expected.channels.size(); ++channel)
    all.push_back(
        agreement_of(expected.channels[channel], got.channels[channel], period_s, most_lag_s, stretch));
  return all;
}

}  // namespace kerf::compare

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <fmt/core.h>

#include "diagnosis/pair.h"
#include "least_squares.h"
#include "spectrum.h"

namespace kerf::compare {
namespace {

constexpr double slowest_vibration_hz = 5.0;

/// The difference in all rows, or where there is contact alone.
struct Gate {
  bool contact = false;
  [[nodiscard]] bool open(const ForcePair& pair, std::size_t row) const {
    return !contact || pair.contact[row] != 0;
  }
};

/// Weights of cosine and sine at a frequency (in half turns a tick), and what they leave.
struct Wave {
  double turn = 0.0;  ///< rad a tick
  double cosine = 0.0;
  double sine = 0.0;
  [[nodiscard]] double at(std::size_t row) const {
    const double phase = turn * static_cast<double>(row);
    return cosine * std::cos(phase) + sine * std::sin(phase);
  }
};

Wave fit_wave(const ForcePair& pair, double turn, Gate gate) {
  double cc = 0.0;
  double cs = 0.0;
  double ss = 0.0;
  double dc = 0.0;
  double ds = 0.0;
  for (std::size_t row = 0; row < pair.rows(); ++row) {
    if (!gate.open(pair, row)) continue;
    const double c = std::cos(turn * static_cast<double>(row));
    const double s = std::sin(turn * static_cast<double>(row));
    cc += c * c;
    cs += c * s;
    ss += s * s;
    dc += pair.difference[row] * c;
    ds += pair.difference[row] * s;
  }
  const double det = cc * ss - cs * cs;
  if (det < 1e-9 * cc * cc) return {.turn = turn, .cosine = cc > 0.0 ? dc / cc : 0.0};
  return {.turn = turn, .cosine = (dc * ss - ds * cs) / det, .sine = (ds * cc - dc * cs) / det};
}

double wave_remainder(const ForcePair& pair, const Wave& wave, Gate gate) {
  return pair.remainder(
      [&](std::size_t row) { return pair.expected[row] + (gate.open(pair, row) ? wave.at(row) : 0.0); });
}

/// Finer and finer around the loudest bin of the spectrum.
Wave refined_wave(const ForcePair& pair, double turn, double step, Gate gate) {
  Wave best = fit_wave(pair, turn, gate);
  double least = wave_remainder(pair, best, gate);
  for (int round = 0; round < 14; ++round, step *= 0.5) {
    for (const double other : {best.turn - step, best.turn + step}) {
      if (other <= 0.0 || other > std::numbers::pi) continue;
      const Wave wave = fit_wave(pair, other, gate);
      const double left = wave_remainder(pair, wave, gate);
      if (left >= least) continue;
      least = left;
      best = wave;
    }
  }
  return best;
}

/// Of the energy above the slowest vibration, the share around a bin; and how even the spectrum is.
struct Shape {
  std::size_t loudest = 0;
  double narrow = 0.0;    ///< share of all energy within a sixth of an octave of the loudest bin
  double flatness = 0.0;  ///< geometric over arithmetic mean of eight and more bands of equal width
};

Shape shape_of(const std::vector<double>& energy) {
  Shape shape;
  const double all = std::accumulate(energy.begin() + 1, energy.end(), 0.0);
  shape.loudest =
      static_cast<std::size_t>(std::max_element(energy.begin() + 1, energy.end()) - energy.begin());
  const auto from = static_cast<std::size_t>(static_cast<double>(shape.loudest) / 1.06);
  const auto to = std::min(energy.size() - 1,
                           static_cast<std::size_t>(std::ceil(static_cast<double>(shape.loudest) * 1.06)));
  for (std::size_t bin = from; bin <= to; ++bin) shape.narrow += energy[bin] / all;
  constexpr std::size_t bands = 12;
  double logarithms = 0.0;
  for (std::size_t band = 0; band < bands; ++band) {
    double sum = 0.0;
    const std::size_t begin = 1 + band * (energy.size() - 1) / bands;
    const std::size_t end = 1 + (band + 1) * (energy.size() - 1) / bands;
    for (std::size_t bin = begin; bin < end; ++bin) sum += energy[bin];
    logarithms += std::log(std::max(sum, 1e-300) * bands / all) / bands;
  }
  shape.flatness = std::exp(logarithms);
  return shape;
}

void find_vibration(const ForcePair& pair, const Shape& shape, std::size_t bins, Findings& found) {
  const double bin_turn = std::numbers::pi / static_cast<double>(bins - 1);
  const double rate_hz = 1.0 / pair.period_s;
  for (const Gate gate : {Gate{false}, Gate{true}}) {
    const Wave wave = refined_wave(pair, bin_turn * static_cast<double>(shape.loudest), 0.5 * bin_turn, gate);
    const double hz = wave.turn * rate_hz / (2.0 * std::numbers::pi);
    if (hz < slowest_vibration_hz) continue;
    const double amplitude = std::hypot(wave.cosine, wave.sine);
    const double remainder = wave_remainder(pair, wave, gate);
    add_finding(found, pair,
                {.change = Change::vibration,
                 .remainder = remainder,
                 .sentence = fmt::format("a vibration of {:.4g} Hz is added, {:.3g} {} of amplitude{}", hz,
                                         amplitude, pair.unit, gate.contact ? ", in contact" : ""),
                 .numbers = {{"hz", hz}, {"amplitude", amplitude}}});
    if (remainder <= named_remainder) return;
  }
  // No pure tone, and yet all in one place of the spectrum.
  const double hz = static_cast<double>(shape.loudest) * bin_turn * rate_hz / (2.0 * std::numbers::pi);
  if (hz < slowest_vibration_hz || shape.narrow < 1.0 - named_remainder * named_remainder) return;
  add_finding(found, pair,
              {.change = Change::vibration,
               .remainder = std::sqrt(std::max(0.0, 1.0 - shape.narrow)),
               .sentence = fmt::format("a vibration around {:.3g} Hz is added, {:.3g} {} RMS", hz,
                                       pair.rms_difference, pair.unit),
               .numbers = {{"hz", hz}}});
}

double correlation(std::span<const double> a, std::span<const double> b, std::size_t apart) {
  double ab = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  for (std::size_t i = 0; i + apart < a.size(); ++i) {
    ab += a[i] * b[i + apart];
    aa += a[i] * a[i];
    bb += b[i + apart] * b[i + apart];
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

std::vector<double> second_differences(std::span<const double> values) {
  std::vector<double> result(values.size(), 0.0);
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
    result[i] = values[i + 1] - 2.0 * values[i] + values[i - 1];
  return result;
}

/// Whether a difference is as strong all along.
bool is_steady(const std::vector<double>& values) {
  constexpr std::size_t blocks = 8;
  double least = 1e300;
  double most = 0.0;
  for (std::size_t block = 0; block < blocks; ++block) {
    double square = 0.0;
    const std::size_t begin = block * values.size() / blocks;
    const std::size_t end = (block + 1) * values.size() / blocks;
    for (std::size_t i = begin; i < end; ++i) square += values[i] * values[i];
    square /= static_cast<double>(end - begin);
    least = std::min(least, square);
    most = std::max(most, square);
  }
  return most < 4.0 * least;
}

/// What has no structure: as strong all along, at all frequencies, and without a trace of the force itself.
/// What a name of it leaves is what hangs together.
void find_noise(const ForcePair& pair, Findings& found) {
  std::vector<double> difference;
  std::vector<double> expected;
  std::size_t differing = 0;
  const bool everywhere = std::ranges::count_if(pair.difference, [&](double one) {
                            return std::abs(one) > pair.tiny;
                          }) > static_cast<long>(pair.rows() * 9 / 10);
  for (std::size_t row = 0; row < pair.rows(); ++row) {
    if (!everywhere && pair.contact[row] == 0) continue;
    difference.push_back(pair.difference[row]);
    expected.push_back(pair.expected[row]);
    if (std::abs(pair.difference[row]) > pair.tiny) ++differing;
  }
  if (difference.size() < 200 || differing * 10 < difference.size() * 9 || !is_steady(difference)) return;
  const double chance = 5.0 / std::sqrt(static_cast<double>(difference.size()));
  const std::vector<double> sharp = second_differences(expected);
  double trace = 0.0;
  for (const std::size_t apart : {0U, 1U, 2U, 3U}) {
    for (const std::vector<double>* other : std::array<const std::vector<double>*, 2>{&expected, &sharp}) {
      trace = std::max({trace, std::abs(correlation(difference, *other, apart)),
                        std::abs(correlation(*other, difference, apart))});
    }
  }
  const double mean =
      std::accumulate(difference.begin(), difference.end(), 0.0) / static_cast<double>(difference.size());
  double square = 0.0;
  for (const double one : difference) square += one * one / static_cast<double>(difference.size());
  const auto spectrum = transform_of(difference, difference.size());
  std::vector<double> energy;
  for (const auto& bin : spectrum) energy.push_back(std::norm(bin));
  if (shape_of(energy).flatness < 0.5 || trace > std::max(chance, 0.08)) return;
  add_finding(found, pair,
              {.change = Change::noise,
               .remainder = std::abs(mean) / std::sqrt(square) < chance ? 0.0 : named_remainder * 2.0,
               .sentence = fmt::format("noise is added, {:.3g} {} RMS{}", std::sqrt(square), pair.unit,
                                       everywhere ? "" : ", in contact"),
               .numbers = {{"rms", std::sqrt(square)}}});
}

}  // namespace

void find_waves(const ForcePair& pair, Findings& found) {
  if (pair.rows() < 32) return;
  const auto spectrum = transform_of(pair.difference, pair.rows());
  std::vector<double> energy;
  energy.reserve(spectrum.size());
  for (const auto& bin : spectrum) energy.push_back(std::norm(bin));
  find_vibration(pair, shape_of(energy), energy.size(), found);
  find_noise(pair, found);
}

}  // namespace kerf::compare

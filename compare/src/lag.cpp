#include "lag.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "spectrum.h"

namespace kerf::compare {
namespace {

/// Sums of a straight line through pairs, got over expected.
struct Line {
  double gain = 1.0;
  double offset = 0.0;
  double left = 0.0;  ///< sum of squares beside it
};

/// Two signals with one shifted against the other.
class Shifted {
 public:
  Shifted(std::span<const double> expected, std::span<const double> got, const LagFitOptions& options)
      : expected_(expected), got_(got), free_gain_(options.free_gain) {
    const std::size_t margin = options.most_ticks + kernel_reach + 2;
    rows_ = rows_for_all(margin, expected.size() - margin);
  }

  [[nodiscard]] Line line(double ticks, Kernel kernel) const {
    double sum_e = 0.0;
    double sum_g = 0.0;
    double ee = 0.0;
    double eg = 0.0;
    double gg = 0.0;
    double left = 0.0;
    const Delayed delayed(expected_, ticks, kernel);
    for (const std::size_t row : rows_) {
      const double e = delayed(row);
      const double g = got_[row];
      left += (g - e) * (g - e);
      sum_e += e;
      sum_g += g;
      ee += e * e;
      eg += e * g;
      gg += g * g;
    }
    if (!free_gain_) return {.left = left};
    const auto count = static_cast<double>(rows_.size());
    const double spread = ee - sum_e * sum_e / count;
    const double gain = spread > 0.0 ? (eg - sum_e * sum_g / count) / spread : 0.0;
    return {.gain = gain,
            .offset = (sum_g - gain * sum_e) / count,
            .left = std::max(0.0, gg - sum_g * sum_g / count - gain * (eg - sum_e * sum_g / count))};
  }

  /// Sum of squares of the slope of the signal, a tick.
  [[nodiscard]] double slopes(const LagFit& fit) const {
    double slopes = 0.0;
    const Delayed delayed(expected_, fit.ticks, fit.kernel);
    for (const std::size_t row : rows_) {
      const double slope = 0.5 * fit.gain * (delayed(row + 1) - delayed(row - 1));
      slopes += slope * slope;
    }
    return slopes;
  }

  /// Mean square of what is left beside it, as of so many fewer rows as hang together.
  [[nodiscard]] double variance(const LagFit& fit) const {
    std::vector<double> left;
    left.reserve(rows_.size());
    const Delayed delayed(expected_, fit.ticks, fit.kernel);
    for (const std::size_t row : rows_) left.push_back(got_[row] - fit.gain * delayed(row) - fit.offset);
    double square = 0.0;
    for (const double one : left) square += one * one;
    double together = 1.0;  // how many residuals say the same
    for (std::size_t apart = 1; apart < left.size() / 10 && square > 0.0; ++apart) {
      double product = 0.0;
      for (std::size_t i = apart; i < left.size(); ++i) product += left[i] * left[i - apart];
      if (product < 0.05 * square) break;
      together += 2.0 * product / square;
    }
    return together * square / static_cast<double>(left.size());
  }

 private:
  std::span<const double> expected_;
  std::span<const double> got_;
  bool free_gain_;
  std::vector<std::size_t> rows_;
};

/// A Gaussian of six ticks over a signal: between smoothed rows there is nearly as much noise as at them.
std::vector<double> smoothed(std::span<const double> values) {
  constexpr double width = 6.0;
  constexpr long reach = 20;
  std::array<double, 2 * reach + 1> weights{};
  for (long k = -reach; k <= reach; ++k)
    weights.at(static_cast<std::size_t>(k + reach)) =
        std::exp(-0.5 * static_cast<double>(k * k) / (width * width));
  std::vector<double> smooth(values.size());
  const auto count = static_cast<long>(values.size());
  for (long i = 0; i < count; ++i) {
    double sum = 0.0;
    double weight = 0.0;
    for (long k = std::max(-reach, -i); k <= std::min(reach, count - 1 - i); ++k) {
      const double w = weights.at(static_cast<std::size_t>(k + reach));
      sum += w * values[static_cast<std::size_t>(i + k)];
      weight += w;
    }
    smooth[static_cast<std::size_t>(i)] = sum / weight;
  }
  return smooth;
}

std::vector<double> changes_of(std::span<const double> values) {
  std::vector<double> changes(values.size(), 0.0);
  for (std::size_t i = 1; i < values.size(); ++i) changes[i] = values[i] - values[i - 1];
  return changes;
}

/// Of a long run the stretch in which most happens: a lag is the same all along.
std::size_t busiest(std::span<const double> values, std::size_t length) {
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t begin = 0; begin + length <= values.size(); begin += length / 2) {
    double square = 0.0;
    for (std::size_t i = begin + 1; i < begin + length; ++i) square += std::abs(values[i] - values[i - 1]);
    if (square > most) best = begin;
    most = std::max(most, square);
  }
  return best;
}

std::vector<double> without_mean(std::span<const double> values) {
  double mean = 0.0;
  for (const double one : values) mean += one / static_cast<double>(values.size());
  std::vector<double> result(values.begin(), values.end());
  for (double& one : result) one -= mean;
  return result;
}

/// The whole shift at which two signals correlate most.
long best_shift(std::span<const double> expected, std::span<const double> got, std::size_t most,
                bool any_sign) {
  const std::size_t length = std::bit_ceil(expected.size() + most + 1);
  auto a = transform_of(expected, length);
  const auto b = transform_of(got, length);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = std::conj(a[i]) * b[i];
  const std::vector<double> products = back_from(a, length);
  long best = 0;
  double largest = -std::numeric_limits<double>::infinity();
  for (long shift = -static_cast<long>(most); shift <= static_cast<long>(most); ++shift) {
    const auto at = shift < 0 ? length - static_cast<std::size_t>(-shift) : static_cast<std::size_t>(shift);
    const double product = any_sign ? std::abs(products[at]) : products[at];
    if (product <= largest) continue;
    largest = product;
    best = shift;
  }
  return best;
}

/// The whole shift that leaves least, from one near it: the peak of a correlation is not always there.
long least_whole(const Shifted& shifted, long whole, long most) {
  const auto left = [&](long ticks) { return shifted.line(static_cast<double>(ticks), Kernel::linear).left; };
  double least = left(whole);
  for (const long step : {1L, -1L}) {
    while (std::abs(whole + step) <= most) {
      const double next = left(whole + step);
      if (next >= least) break;
      least = next;
      whole += step;
    }
  }
  return whole;
}

/// The least difference within a tick of a whole shift, by the kernel that leaves least.
struct FineLag {
  LagFit fit;
  double left = std::numeric_limits<double>::infinity();
};
FineLag fine_lag(const Shifted& shifted, long whole) {
  FineLag best;
  for (const Kernel kernel : kernels) {
    const double middle = static_cast<double>(whole);
    const auto left = [&](double ticks) { return shifted.line(ticks, kernel).left; };
    const double ticks = least_within(left, middle - 1.0, middle + 1.0);
    const Line line = shifted.line(ticks, kernel);
    if (line.left >= best.left) continue;
    best = {.fit = {.ticks = ticks, .gain = line.gain, .offset = line.offset, .kernel = kernel},
            .left = line.left};
  }
  return best;
}

/// Whether a lag stands at the end of what was looked for, and a tick beyond it less is left.
bool is_longer(const Shifted& shifted, double ticks, std::size_t most_ticks) {
  const double most = std::copysign(static_cast<double>(most_ticks), ticks);
  if (std::abs(ticks) <= std::abs(most) - 1.0) return false;
  const double beyond = most + std::copysign(1.0, ticks);
  return shifted.line(beyond, Kernel::linear).left < shifted.line(most, Kernel::linear).left;
}

}  // namespace

std::vector<std::size_t> rows_for_all(std::size_t begin, std::size_t end) {
  constexpr std::size_t most = 20000;
  constexpr std::size_t block = 1000;
  std::vector<std::size_t> rows;
  if (end <= begin) return rows;
  const std::size_t count = end - begin;
  const std::size_t blocks = most / block;
  if (count <= most) {
    for (std::size_t row = begin; row < end; ++row) rows.push_back(row);
    return rows;
  }
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t from = begin + i * (count - block) / (blocks - 1);
    for (std::size_t row = from; row < from + block; ++row) rows.push_back(row);
  }
  return rows;
}

Stretch longest_stretch(const std::vector<double>& time_s, std::size_t rows, double period_s) {
  constexpr double longest_step = 2.5;  // periods
  const Stretch all{.count = rows};
  Stretch best;
  Stretch now;
  for (std::size_t row = 0; row < std::min(rows, time_s.size()); ++row) {
    if (row > 0 && time_s[row] - time_s[row - 1] > longest_step * period_s) now = {.begin = row};
    ++now.count;
    if (now.count > best.count) best = now;
  }
  return 4 * best.count < rows ? all : best;
}

std::optional<LagFit> fit_lag(std::span<const double> expected, std::span<const double> got,
                              const LagFitOptions& options) {
  constexpr double explained = 0.1;  // of what a whole shift leaves; where more is left, it is noise
  // Strokes that repeat match half a period off as well, turned round: that has to leave less than half.
  constexpr double turned_costs = 2.0;
  constexpr double unshifted_counts = 1e-6;  // of what no shift leaves: less is nothing either way
  LagFitOptions used = options;
  const std::size_t rows = expected.size();
  if (rows < 4 * (kernel_reach + 4)) return {};
  used.most_ticks = std::min(used.most_ticks, rows / 4);
  const Shifted shifted(expected, got, used);
  const std::size_t length = std::min(rows, std::max<std::size_t>(65536, 4 * used.most_ticks));
  const std::size_t begin = busiest(expected, length);
  const auto part_e = expected.subspan(begin, length);
  const auto part_g = got.subspan(begin, length);
  const auto means_e = without_mean(part_e);
  const auto means_g = without_mean(part_g);
  const auto changes_e = changes_of(part_e);
  const auto changes_g = changes_of(part_g);
  std::vector<long> candidates{0};
  for (const bool any_sign : {false, true}) {
    if (any_sign && !used.free_gain) continue;
    candidates.push_back(best_shift(means_e, means_g, used.most_ticks, any_sign));
    candidates.push_back(best_shift(changes_e, changes_g, used.most_ticks, any_sign));
  }
  const auto line_at = [&](long ticks) { return shifted.line(static_cast<double>(ticks), Kernel::linear); };
  const double nothing = unshifted_counts * line_at(0).left;
  double least = std::numeric_limits<double>::infinity();
  long whole = 0;
  for (const long one : candidates) {
    const Line line = line_at(one);
    const double left = (line.gain < 0.0 ? turned_costs : 1.0) * std::max(line.left, nothing);
    if (left < least) whole = one;
    least = std::min(least, left);
  }
  const auto most = static_cast<long>(used.most_ticks);
  whole = least_whole(shifted, whole, most);
  least = shifted.line(static_cast<double>(whole), Kernel::linear).left;
  const FineLag raw = fine_lag(shifted, whole);
  LagFit best = raw.fit;
  double variance = shifted.variance(best);
  double slopes = shifted.slopes(best);
  best.is_longer = is_longer(shifted, best.ticks, used.most_ticks);
  if (raw.left > explained * least) {
    // Half way between two rows their noise averages out, which would pass for a better fit.
    const std::vector<double> smooth_e = smoothed(expected);
    const std::vector<double> smooth_g = smoothed(got);
    const Shifted calm(smooth_e, smooth_g, used);
    best = fine_lag(calm, least_whole(calm, whole, most)).fit;  // which noise has moved by ticks
    best.is_longer = is_longer(calm, best.ticks, used.most_ticks);
    slopes = calm.slopes(best);  // those of the noise are none of the signal's
    best.kernel = Kernel::sinc;  // which keeps the noise as it is
    variance = shifted.variance(best);
  }
  if (!(slopes > 0.0)) return {};
  best.std_error = std::sqrt(variance / slopes);
  return best;
}

}  // namespace kerf::compare

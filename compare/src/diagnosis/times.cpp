#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/core.h>

#include "diagnosis/pair.h"
#include "lag.h"

namespace kerf::compare {
namespace {

constexpr double most_lag_s = 0.5;

std::string ticks_in_words(double ticks) {
  const double size = std::abs(ticks);
  return fmt::format("{:.4g} tick{}", size, size == 1.0 ? "" : "s");
}

void find_lag(const ForcePair& pair, Findings& found) {
  const auto most = static_cast<std::size_t>(std::max(8.0, most_lag_s / pair.period_s));
  const auto fit = fit_lag(pair.expected, pair.got, {.most_ticks = most});
  if (!fit || fit->is_longer || std::abs(fit->ticks) < 1e-4) return;
  const auto margin = static_cast<std::size_t>(std::abs(fit->ticks)) + kernel_reach + 2;
  if (2 * margin >= pair.rows()) return;
  const double remainder =
      pair.remainder(Delayed(pair.expected, fit->ticks, fit->kernel), margin, pair.rows() - margin);
  add_finding(found, pair,
              {.change = Change::lag,
               .remainder = remainder,
               .sentence = fmt::format("the force comes {} ({:.4g} ms) too {}", ticks_in_words(fit->ticks),
                                       1e3 * std::abs(fit->ticks) * pair.period_s,
                                       fit->ticks > 0.0 ? "late" : "early"),
               .numbers = {{"ticks", fit->ticks},
                           {"ms", 1e3 * fit->ticks * pair.period_s},
                           {"std_error_ticks", fit->std_error}}});
}

/// Means of stretches, so that a signal of any length is looked at as a whole.
std::vector<double> shortened(std::span<const double> values, std::size_t length) {
  std::vector<double> means(length, 0.0);
  for (std::size_t i = 0; i < length; ++i) {
    const std::size_t begin = i * values.size() / length;
    const std::size_t end = std::max(begin + 1, (i + 1) * values.size() / length);
    for (std::size_t row = begin; row < end; ++row)
      means[i] += values[row] / static_cast<double>(end - begin);
  }
  return means;
}

/// got(i) = expected(speed i): over how much other time the same goes on.
class OtherSpeed {
 public:
  OtherSpeed(std::span<const double> expected, std::span<const double> got)
      : expected_(expected), got_(got) {}

  [[nodiscard]] double left(double speed, Kernel kernel) const {
    double squares = 0.0;
    std::size_t count = 0;
    for (const std::size_t row : rows_) {
      const double at = speed * static_cast<double>(row);
      if (at > static_cast<double>(expected_.size() - 1)) continue;
      const double rest = got_[row] - value_between(expected_, at, kernel);
      squares += rest * rest;
      ++count;
    }
    return count * 4 < rows_.size() ? 1e300 : squares / static_cast<double>(count);
  }

  /// By trial on a shortened signal, so that no narrow valley is missed.
  [[nodiscard]] static double roughly(std::span<const double> expected, std::span<const double> got) {
    constexpr std::size_t length = 512;
    if (std::min(expected.size(), got.size()) < 2 * length) {
      return scan(OtherSpeed(expected, got), 0.4, 2.5, 1.0 + 1.5 / static_cast<double>(got.size()));
    }
    const auto e = shortened(expected, length);
    const auto g = shortened(got, length);
    const double same_scale = static_cast<double>(expected.size()) / static_cast<double>(got.size());
    double speed = scan(OtherSpeed(e, g), 0.4 / same_scale, 2.5 / same_scale, 1.002) * same_scale;
    for (std::size_t finer = 4 * length; finer < std::min(expected.size(), got.size()); finer *= 4) {
      const auto fine_e = shortened(expected, finer);
      const auto fine_g = shortened(got, finer);
      const double step = 4.0 / static_cast<double>(finer);
      speed = same_scale * scan(OtherSpeed(fine_e, fine_g), speed / same_scale * (1.0 - 8.0 * step),
                                speed / same_scale * (1.0 + 8.0 * step), 1.0 + 0.5 * step);
    }
    return speed;
  }

 private:
  [[nodiscard]] static double scan(const OtherSpeed& signals, double low, double high, double ratio) {
    double best = 1.0;
    double least = std::numeric_limits<double>::infinity();
    for (double speed = low; speed <= high; speed *= ratio) {
      const double left = signals.left(speed, Kernel::linear);
      if (left < least) best = speed;
      least = std::min(least, left);
    }
    return best;
  }

  std::span<const double> expected_;
  std::span<const double> got_;
  std::vector<std::size_t> rows_ = rows_for_all(0, got_.size());
};

struct SpeedFit {
  double speed = 1.0;
  Kernel kernel = Kernel::linear;
};

SpeedFit fit_speed(std::span<const double> expected, std::span<const double> got, double roughly) {
  const OtherSpeed signals(expected, got);
  const double within = 3.0 / static_cast<double>(got.size());
  SpeedFit best;
  double least = std::numeric_limits<double>::infinity();
  // The finest kernel takes its time, and is asked where the others do not quite do.
  const double straight = signals.left(1.0, Kernel::linear);
  bool worth = false;
  for (const Kernel kernel : kernels) {
    if (kernel == Kernel::sinc && !worth) break;
    const auto left = [&](double speed) { return signals.left(speed, kernel); };
    double speed = least_within(left, roughly * (1.0 - within), roughly * (1.0 + within));
    // What was meant, if it is as good: the counts of rows, a speed in per mille.
    for (const double meant : {std::round(1000.0 * speed) / 1000.0, roughly}) {
      if (left(meant) <= left(speed)) speed = meant;
    }
    if (left(speed) >= least) continue;
    least = left(speed);
    worth = least > 1e-4 * straight && least < 0.3 * straight;
    best = {.speed = speed, .kernel = kernel};
  }
  return best;
}

void add_rate(const ForcePair& pair, std::span<const double> expected, std::span<const double> got,
              const SpeedFit& fit, Findings& found) {
  constexpr double most_speed = 20.0;
  if (std::abs(fit.speed - 1.0) * static_cast<double>(pair.rows()) < 0.5) return;
  if (!(fit.speed > 1.0 / most_speed && fit.speed < most_speed)) return;
  const auto end =
      std::min(pair.rows(), static_cast<std::size_t>(static_cast<double>(expected.size() - 1) / fit.speed));
  const double remainder = pair.remainder(
      [&](std::size_t row) {
        return value_between(expected, fit.speed * static_cast<double>(row), fit.kernel);
      },
      0, end);
  if (static_cast<double>(end) < 0.5 * static_cast<double>(got.size()) / std::max(1.0, fit.speed)) return;
  // What is faster ends earlier: of a difference that begins behind that end it explains nothing.
  const auto square = [](double sum, double one) { return sum + one * one; };
  const auto middle = pair.difference.begin() + static_cast<std::ptrdiff_t>(end);
  const double before = std::accumulate(pair.difference.begin(), middle, 0.0, square);
  if (before < 0.1 * std::accumulate(middle, pair.difference.end(), before, square)) return;
  const double rate = 1.0 / pair.period_s;
  add_finding(
      found, pair,
      {.change = Change::rate,
       .remainder = remainder,
       .sentence = fmt::format("the same force over {:.5g} times the ticks ({} for {}): another rate, "
                               "{:.5g} Hz where {:.5g} Hz are meant, or another speed",
                               1.0 / fit.speed, got.size(), expected.size(), rate / fit.speed, rate),
       .numbers = {{"speed", fit.speed}}});
}

}  // namespace

void find_times(const ForcePair& pair, Findings& found) {
  find_lag(pair, found);
  if (pair.rows() < 64) return;
  const double roughly = OtherSpeed::roughly(pair.expected, pair.got);
  add_rate(pair, pair.expected, pair.got, fit_speed(pair.expected, pair.got, roughly), found);
}

void find_rate(const ForcePair& pair, std::span<const double> expected, std::span<const double> got,
               Findings& found) {
  if (std::min(expected.size(), got.size()) < 16) return;
  const double by_count = static_cast<double>(expected.size()) / static_cast<double>(got.size());
  add_rate(pair, expected, got, fit_speed(expected, got, by_count), found);
}

}  // namespace kerf::compare

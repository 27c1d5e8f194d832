#include "inspect/lag.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace kerf::bench {
namespace {

constexpr double farthest_s = 0.1;
constexpr double finest_s = 0.001;
constexpr double least_correlation = 0.5;
constexpr std::size_t fewest_rows_of_a_lag = 100;

/// Sums over pairs of a force and a position so many rows before, about a first one so that nothing cancels.
struct PairSums {
  double x = 0.0;
  double xx = 0.0;
  double xf = 0.0;
};

struct Correlator {
  std::size_t reach;   ///< lags to each side
  std::size_t stride;  ///< rows between two of them
  std::vector<PairSums> lags = std::vector<PairSums>(2 * reach + 1);
  double rows = 0.0;
  double f = 0.0;
  double ff = 0.0;

  /// `position` begins `reach * stride` rows before the force and goes on as long after it.
  void add(std::span<const double> force, std::span<const double> position) {
    rows += static_cast<double>(force.size());
    for (const double value : force) {
      f += value;
      ff += value * value;
    }
    for (std::size_t lag = 0; lag < lags.size(); ++lag) {
      const auto moved = position.subspan((2 * reach - lag) * stride, force.size());
      PairSums sums;
      for (std::size_t i = 0; i < force.size(); ++i) {
        sums.x += moved[i];
        sums.xx += moved[i] * moved[i];
        sums.xf += moved[i] * force[i];
      }
      lags[lag].x += sums.x;
      lags[lag].xx += sums.xx;
      lags[lag].xf += sums.xf;
    }
  }

  [[nodiscard]] double correlation(std::size_t lag) const {
    const PairSums& sums = lags[lag];
    const double of_force = ff - f * f / rows;
    const double of_position = sums.xx - sums.x * sums.x / rows;
    if (!(of_force > 0.0 && of_position > 0.0)) return 0.0;
    return (sums.xf - sums.x * f / rows) / std::sqrt(of_force * of_position);
  }
};

/// Hands the finite stretches of the contacts to the correlator, a block at a time.
void add_contacts(Correlator& correlator, const BlockedValues& position, const BlockedValues& force,
                  std::span<const RowSpan> contacts) {
  constexpr std::size_t at_once = 8192;
  const std::size_t margin = correlator.reach * correlator.stride;
  const std::size_t rows = force.size();
  if (rows <= 2 * margin || contacts.empty()) return;
  const double first_x = position[contacts.front().begin];
  const double first_f = force[contacts.front().begin];
  std::vector<double> x;
  std::vector<double> f;
  for (const RowSpan& contact : contacts) {
    const std::size_t last = std::min(contact.end, rows - margin);
    for (std::size_t begin = std::max(contact.begin, margin); begin < last; begin += at_once) {
      const std::size_t end = std::min(begin + at_once, last);
      x.clear();
      f.clear();
      for (std::size_t row = begin; row < end; ++row) f.push_back(force[row] - first_f);
      for (std::size_t row = begin - margin; row < end + margin; ++row) x.push_back(position[row] - first_x);
      const auto finite = [](double value) { return std::isfinite(value); };
      if (std::ranges::all_of(f, finite) && std::ranges::all_of(x, finite)) correlator.add(f, x);
    }
  }
}

}  // namespace

std::optional<Lag> lag_between(const BlockedValues& position, const BlockedValues& force,
                               std::span<const RowSpan> contacts, double period_s) {
  if (!(period_s > 0.0)) return std::nullopt;
  const auto stride = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(finest_s / period_s)));
  const double step_s = static_cast<double>(stride) * period_s;
  const auto reach = static_cast<std::size_t>(farthest_s / step_s);
  if (reach < 2) return std::nullopt;
  Correlator correlator{.reach = reach, .stride = stride};
  add_contacts(correlator, position, force, contacts);
  if (correlator.rows < static_cast<double>(fewest_rows_of_a_lag)) return std::nullopt;
  std::size_t best = 0;
  const auto size = [&](std::size_t lag) { return std::abs(correlator.correlation(lag)); };
  for (std::size_t lag = 1; lag <= 2 * reach; ++lag) best = size(lag) > size(best) ? lag : best;
  if (best == 0 || best == 2 * reach || size(best) < least_correlation) return std::nullopt;
  const double bend = size(best - 1) - 2.0 * size(best) + size(best + 1);
  const double beside = bend < 0.0 ? 0.5 * (size(best - 1) - size(best + 1)) / bend : 0.0;
  return Lag{.seconds = step_s * (static_cast<double>(best) - static_cast<double>(reach) + beside),
             .correlation = correlator.correlation(best),
             .correlation_now = correlator.correlation(reach),
             .rows = static_cast<std::size_t>(correlator.rows)};
}

}  // namespace kerf::bench

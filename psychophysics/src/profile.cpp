#include "profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <kerf/psychophysics/random.h>

#include "checks.h"

namespace kerf::psychophysics {
namespace {

double ratio_at(const Problem& problem, const Maximum& best, Held held, const Point& truth,
                std::size_t index) {
  held[index] = true;
  Point start = best.at;
  start[index] = truth[index];
  const Maximum found = maximise(problem, start, held);
  const Maximum other = maximise(problem, truth, held);
  return std::max(0.0, 2.0 * (best.log_likelihood - std::max(found.log_likelihood, other.log_likelihood)));
}

}  // namespace

double Profile::end(std::size_t index, double direction) const {
  const double bound = direction < 0.0 ? problem_.lower[index] : problem_.upper[index];
  Point like = best_.at;
  double inside = like[index];
  double below = -loss_;
  double step = 0.05;
  while (true) {
    const double next = direction < 0.0 ? std::max(bound, inside - step) : std::min(bound, inside + step);
    const double here = excess(index, next, like);
    if (here > 0.0) return crossing(index, like, inside, below, next, here);
    if (next == bound) return direction * std::numeric_limits<double>::infinity();
    inside = next;
    below = here;
    step *= 1.5;
  }
}

/// False position after Illinois. It keeps the signs that it was given, since what is found from another
/// start may differ by more than nothing.
double Profile::crossing(std::size_t index, Point& like, double inside, double below, double outside,
                         double above) const {
  for (int i = 0; i < 80 && std::abs(outside - inside) > 1e-9; ++i) {
    const double share = std::clamp(below / (below - above), 0.01, 0.99);
    const double middle = inside + share * (outside - inside);
    const double here = excess(index, middle, like);
    if (std::abs(here) < 1e-9) return middle;
    if (here > 0.0) {
      outside = middle;
      above = here;
      below *= 0.5;
    } else {
      inside = middle;
      below = here;
      above *= 0.5;
    }
  }
  return 0.5 * (inside + outside);
}

/// Begins at the point last found, which it moves.
double Profile::excess(std::size_t index, double value, Point& like) const {
  Held held = held_;
  held[index] = true;
  like[index] = value;
  Maximum found = maximise(problem_, like, held);
  // A step and a gentle slope may both fit: nothing is outside before other starts have been tried.
  if (2.0 * (best_.log_likelihood - found.log_likelihood) > loss_) {
    const Maximum other = maximise_from_many(problem_, like, held);
    if (other.log_likelihood > found.log_likelihood) found = other;
  }
  like = found.at;
  return 2.0 * (best_.log_likelihood - found.log_likelihood) - loss_;
}

Calibration calibration(const Problem& problem, const Maximum& best, const Held& held,
                        const FitOptions& options) {
  require(options.calibration >= 0 && options.calibration <= 100000,
          "a calibration takes 0 to 100,000 experiments");
  if (options.calibration == 0) return {};
  Random random(options.seed);
  Problem drawn = problem;
  const double rho = best.at[dispersion_index] / (1.0 + best.at[dispersion_index]);
  double threshold = 0.0;
  double slope = 0.0;
  for (int i = 0; i < options.calibration; ++i) {
    for (Cell& cell : drawn.cells)
      cell.answers.successes =
          random.successes(cell.answers.trials, probability_at(problem, best.at, cell.at), rho);
    const Maximum found = maximise_from_many(drawn, best.at, held);
    threshold += ratio_at(drawn, found, held, best.at, threshold_index);
    slope += ratio_at(drawn, found, held, best.at, slope_index);
  }
  return {.threshold = std::max(1.0, threshold / options.calibration),
          .slope = std::max(1.0, slope / options.calibration)};
}

}  // namespace kerf::psychophysics

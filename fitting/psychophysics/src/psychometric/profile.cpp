#include "psychometric/profile.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/math/tools/toms748_solve.hpp>

namespace kerf::psychophysics {
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

/// The values at both ends are those that were found on the way: from another start there may be others.
double Profile::crossing(std::size_t index, Point& like, double inside, double below, double outside,
                         double above) const {
  const auto loss = [&](double value) { return excess(index, value, like); };
  const auto close = [](double lower, double upper) { return upper - lower < 1e-9; };
  std::uintmax_t rounds = 80;
  const auto [lower, upper] =
      inside < outside
          ? boost::math::tools::toms748_solve(loss, inside, outside, below, above, close, rounds)
          : boost::math::tools::toms748_solve(loss, outside, inside, above, below, close, rounds);
  return 0.5 * (lower + upper);
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

}  // namespace kerf::psychophysics

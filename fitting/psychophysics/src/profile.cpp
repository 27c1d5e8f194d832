#include "profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace kerf::psychophysics

#include "psychometric/support.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace kerf::psychophysics {
namespace {

constexpr double depth = 20.0;
constexpr std::array<int, 3> scanned{25, 7, 3};  ///< thresholds, slopes, lapse rates

double middle_of(const Problem& problem, std::size_t index, int cell) {
  const double share = (cell + 0.5) / scanned[index];
  return problem.lower[index] + share * (problem.upper[index] - problem.lower[index]);
}

std::vector<Maximum> scan(const Problem& problem) {
  std::vector<Maximum> places;
  for (int i = 0; i < scanned[0]; ++i) {
    for (int j = 0; j < scanned[1]; ++j) {
      for (int k = 0; k < scanned[2]; ++k) {
        const Point at{middle_of(problem, 0, i), middle_of(problem, 1, j), middle_of(problem, 2, k), 0.0};
        places.push_back({.at = at, .log_likelihood = log_likelihood(problem, at)});
      }
    }
  }
  std::ranges::sort(places, std::greater{}, &Maximum::log_likelihood);
  return places;
}

/// How far a parameter may go while the others follow; less than an eighth of a step too far.
class ProfileEnd {
 public:
  ProfileEnd(const Problem& problem, const Maximum& best, Held held, std::size_t index)
      : problem_(problem), best_(best), held_(held), index_(index) {
    held_[index] = true;
  }
  [[nodiscard]] double towards(double bound) const {
    const double range = problem_.upper[index_] - problem_.lower[index_];
    Point inside = best_.at;
    for (double step = 1e-3 * range; inside[index_] != bound; step *= 2.0) {
      const double left = bound - inside[index_];
      double outside = std::abs(left) <= step ? bound : inside[index_] + std::copysign(step, left);
      const Maximum found = at(inside, outside);
      if (is_within(found)) {
        inside = found.at;
        continue;
      }
      for (int halving = 0; halving < 3; ++halving) {
        const Maximum between = at(inside, 0.5 * (inside[index_] + outside));
        if (is_within(between))
          inside = between.at;
        else
          outside = between.at[index_];
      }
      return outside;
    }
    return bound;
  }

 private:
  [[nodiscard]] Maximum at(Point like, double value) const {
    like[index_] = value;
    return maximise(problem_, like, held_);
  }
  [[nodiscard]] bool is_within(const Maximum& found) const {
    return found.log_likelihood > best_.log_likelihood - depth;
  }

  const Problem& problem_;
  const Maximum& best_;
  Held held_;
  std::size_t index_;
};

}  // namespace

Support support_of(const Problem& problem, const Held& held) {
  constexpr std::size_t polished = 3;
  const std::vector<Maximum> places = scan(problem);
  Maximum best = places.front();
  for (std::size_t i = 0; i < polished; ++i) {
    const Maximum found = maximise(problem, places[i].at, held);
    if (found.log_likelihood > best.log_likelihood) best = found;
  }
  Support support{.lower = best.at, .upper = best.at, .largest = best.log_likelihood};
  for (const std::size_t index : {threshold_index, slope_index, lapse_index}) {
    if (held[index]) continue;
    const ProfileEnd end(problem, best, held, index);
    double& lower = support.lower[index];
    double& upper = support.upper[index];
    lower = end.towards(problem.lower[index]);
    upper = end.towards(problem.upper[index]);
    // A profile goes along one ridge, and there may be another.
    const double cell = (problem.upper[index] - problem.lower[index]) / scanned[index];
    for (const Maximum& place : places) {
      if (place.log_likelihood < best.log_likelihood - depth) break;
      lower = std::min(lower, std::max(problem.lower[index], place.at[index] - cell));
      upper = std::max(upper, std::min(problem.upper[index], place.at[index] + cell));
    }
  }
  return support;
}

}  // namespace kerf::psychophysics

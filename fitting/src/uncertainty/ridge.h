#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "infinite.h"
#include "least_squares.h"

namespace kerf::fitting {

/// An objective with one coordinate held.
class Held final : public Objective {
 public:
  Held(const Objective& whole, Eigen::Index held, double value) : whole_(whole), held_(held), value_(value) {}
  [[nodiscard]] Eigen::Index size() const override { return whole_.size() - 1; }
  [[nodiscard]] Eigen::VectorXd whole(const Eigen::VectorXd& at) const {
    Eigen::VectorXd all(whole_.size());
    all << at.head(held_), value_, at.tail(size() - held_);
    return all;
  }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override {
    Sums all;
    if (!whole_.evaluate(whole(at), all)) return false;
    std::vector<Eigen::Index> rest;
    for (Eigen::Index k = 0; k < whole_.size(); ++k) {
      if (k != held_) rest.push_back(k);
    }
    sums.squares = all.squares;
    sums.score = all.score(rest);
    sums.normal = all.normal(rest, rest);
    return true;
  }

 private:
  const Objective& whole_;
  Eigen::Index held_;
  double value_;
};

[[nodiscard]] inline Eigen::VectorXd without(const Eigen::VectorXd& all, Eigen::Index k) {
  Eigen::VectorXd rest(all.size() - 1);
  rest << all.head(k), all.tail(all.size() - 1 - k);
  return rest;
}

/// How the others follow near the best, and how far along the held coordinate that is to be believed.
struct RidgeAhead {
  Eigen::VectorXd slope{};  ///< one for each of the others; empty: they stay
  double reach = 0.0;
};

/// How the sum of squares rises when one coordinate is held and the others follow,
///
///     deviation = sqrt((S - S_best) / c),   c its rise in one standard error.
///
/// Each search begins on the straight line through the last two that were kept, so that it is asked outwards:
/// from the best on along a direction that may be known.
class Ridge {
 public:
  Ridge(const Objective& whole, const Bounds& bounds, const Eigen::VectorXd& best, Eigen::Index held,
        double least, double unit, RidgeAhead ahead = {})
      : whole_(whole),
        within_{without(bounds.lower, held), without(bounds.upper, held)},
        best_(without(best, held)),
        best_value_(best[held]),
        first_(ahead.slope.size() == best_.size() && ahead.slope.allFinite()
                   ? std::move(ahead)
                   : RidgeAhead{.slope = Eigen::VectorXd::Zero(best_.size())}),
        held_(held),
        least_(least),
        unit_(unit) {
    begin_anew();
    last_ = best_;
  }

  /// Whether one that followed came to an end of its range; those of `ends` that are infinite do not count.
  [[nodiscard]] bool came_to_an_end(const Bounds& ends) const {
    return (last_.array() <= without(ends.lower, held_).array()).any() ||
           (last_.array() >= without(ends.upper, held_).array()).any();
  }
  /// The next search begins at the best again.
  void begin_anew() {
    rest_ = best_;
    value_ = best_value_;
    ahead_ = first_;
  }
  /// The next search begins where this one ended.
  void keep() {
    const double way = last_value_ - value_;
    if (way != 0.0) ahead_ = {.slope = (last_ - rest_) / way, .reach = 2.0 * std::abs(way)};
    rest_ = last_;
    value_ = last_value_;
  }
  /// Infinite where there is nothing at this value.
  [[nodiscard]] double deviation(double value) {
    // Of one standard error, in which deviations are: the search need not end nearer.
    constexpr double negligible = 1e-5;
    const Held held(whole_, held_, value);
    Sums sums;
    last_value_ = value;
    if (rest_.size() > 0) {
      const double tolerance = std::clamp(negligible * unit_ / least_, 1e-10, 1e-6);
      const double way = std::clamp(value - value_, -ahead_.reach, ahead_.reach);
      Minimum minimum = minimise(held, rest_ + way * ahead_.slope, within_,
                                 {.iterations = 200, .function_tolerance = tolerance});
      if (!std::isfinite(minimum.sums.squares)) return infinite;
      last_ = minimum.at;
      sums = std::move(minimum.sums);
    } else if (!held.evaluate(rest_, sums)) {
      return infinite;
    }
    return std::sqrt(std::max(0.0, sums.squares - least_) / unit_);
  }

 private:
  const Objective& whole_;
  Bounds within_;
  Eigen::VectorXd best_;
  double best_value_;
  RidgeAhead first_;
  RidgeAhead ahead_{};
  Eigen::VectorXd rest_{};
  double value_ = 0.0;  ///< of the held coordinate, at rest_
  Eigen::VectorXd last_{};
  double last_value_ = 0.0;
  Eigen::Index held_;
  double least_;
  double unit_;
};

}  // namespace kerf::fitting

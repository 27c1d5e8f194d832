#pragma once

#include <algorithm>
#include <cmath>
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

/// How the sum of squares rises when one coordinate is held and the others follow,
///
///     deviation = sqrt((S - S_best) / c),   c its rise in one standard error.
///
/// Each search begins where the last one ended that was kept, so that it is asked outwards.
class Ridge {
 public:
  Ridge(const Objective& whole, const Bounds& bounds, const Eigen::VectorXd& best, Eigen::Index held,
        double least, double unit)
      : whole_(whole),
        within_{without(bounds.lower, held), without(bounds.upper, held)},
        best_(without(best, held)),
        rest_(best_),
        last_(best_),
        held_(held),
        least_(least),
        unit_(unit) {}

  /// Whether one that followed came to an end of its range; those of `ends` that are infinite do not count.
  [[nodiscard]] bool came_to_an_end(const Bounds& ends) const {
    return (last_.array() <= without(ends.lower, held_).array()).any() ||
           (last_.array() >= without(ends.upper, held_).array()).any();
  }
  /// The next search begins at the best again.
  void begin_anew() { rest_ = best_; }
  /// The next search begins where this one ended.
  void keep() { rest_ = last_; }
  /// Infinite where there is nothing at this value.
  [[nodiscard]] double deviation(double value) {
    const Held held(whole_, held_, value);
    Sums sums;
    if (rest_.size() > 0) {
      Minimum minimum = minimise(held, rest_, within_, {.iterations = 200, .function_tolerance = 1e-10});
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
  Eigen::VectorXd rest_;
  Eigen::VectorXd last_;
  Eigen::Index held_;
  double least_;
  double unit_;
};

}  // namespace kerf::fitting

#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "infinite.h"
#include "least_squares.h"
#include "profiles/elsewhere.h"

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
        double least, double unit, const Elsewhere& elsewhere, RidgeAhead ahead = {})
      : whole_(whole),
        elsewhere_(elsewhere),
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
  /// The others, where the last search ended.
  [[nodiscard]] const Eigen::VectorXd& last() const noexcept { return last_; }
  /// Whether another objective has the same least sum of squares near where the last search ended.
  [[nodiscard]] bool is_so_by(const Objective& other) const {
    constexpr double negligible = 1e-2;  // of the rise in one standard error
    if (&other == &whole_ || last_.size() == 0) return true;
    const Minimum there = least_from(Held(other, held_, last_value_), last_);
    return std::abs(there.sums.squares - last_squares_) <= negligible * unit_;
  }
  /// Infinite where there is nothing at this value. Where what the law leaves elsewhere is well within
  /// `limit`, that is: the least may be less.
  [[nodiscard]] double deviation(double value, double limit = 0.0) {
    constexpr double well_within = 0.9;
    const Held held(whole_, held_, value);
    last_value_ = value;
    last_squares_ = infinite;
    if (rest_.size() == 0) {
      Sums sums;
      return held.evaluate(rest_, sums) ? ended_at({}, sums.squares) : infinite;
    }
    const std::optional<Place> place = elsewhere(held, value);
    if (place && deviation_of(place->squares) < well_within * limit)
      return ended_at(place->at, place->squares);
    const double way = std::clamp(value - value_, -ahead_.reach, ahead_.reach);
    Minimum minimum = least_from(held, rest_ + way * ahead_.slope);
    if (place && place->squares < minimum.sums.squares) {
      Minimum other = least_from(held, place->at);
      if (other.sums.squares < minimum.sums.squares) minimum = std::move(other);
    }
    if (!std::isfinite(minimum.sums.squares)) return infinite;
    return ended_at(minimum.at, minimum.sums.squares);
  }

 private:
  [[nodiscard]] double deviation_of(double squares) const {
    return std::sqrt(std::max(0.0, squares - least_) / unit_);
  }
  [[nodiscard]] Minimum least_from(const Held& held, const Eigen::VectorXd& start) const {
    // Of one standard error, in which deviations are: the search need not end nearer.
    constexpr double negligible = 1e-5;
    const double tolerance = std::clamp(negligible * unit_ / least_, 1e-10, 1e-6);
    return minimise(held, start, within_, {.iterations = 200, .function_tolerance = tolerance});
  }
  /// Where the law leaves least elsewhere, and how much that is.
  struct Place {
    Eigen::VectorXd at;
    double squares;
  };
  [[nodiscard]] std::optional<Place> elsewhere(const Held& held, double value) const {
    const auto place = elsewhere_.least(held_, value);
    if (!place) return std::nullopt;
    Sums sums;
    Eigen::VectorXd at = without(*place, held_);
    if (!held.evaluate(at, sums)) return std::nullopt;
    return Place{std::move(at), sums.squares};
  }
  double ended_at(const Eigen::VectorXd& at, double squares) {
    last_ = at;
    last_squares_ = squares;
    return deviation_of(squares);
  }

  const Objective& whole_;
  const Elsewhere& elsewhere_;
  Bounds within_;
  Eigen::VectorXd best_;
  double best_value_;
  RidgeAhead first_;
  RidgeAhead ahead_{};
  Eigen::VectorXd rest_{};
  double value_ = 0.0;  ///< of the held coordinate, at rest_
  Eigen::VectorXd last_{};
  double last_value_ = 0.0;
  double last_squares_ = infinite;
  Eigen::Index held_;
  double least_;
  double unit_;
};

}  // namespace kerf::fitting

#include "ruptures/separation.h"

#include <algorithm>
#include <cmath>

#include "infinite.h"

namespace kerf::fitting {
namespace {

/// The margin as a function of the slope is a lower envelope of straight lines. One of them: its value at a
/// slope is sum of weight * force + constant + slope * by_slope.
struct Piece {
  std::vector<Separation::Point> points;
  double constant = 0.0;
  double by_slope = 0.0;
  double at_none = 0.0;  ///< value at a slope of zero

  [[nodiscard]] double at(double slope) const { return at_none + slope * by_slope; }
};

class Margins {
 public:
  Margins(const RupturePoints& points, const Eigen::VectorXd& force, const HeldLine& held)
      : points_(points), force_(force), held_(held) {
    for (const std::size_t i : points.whole) add_to_hull(i);
  }

  /// The piece that is least at a slope.
  [[nodiscard]] Piece at(double slope) const {
    const auto above_line = [&](std::size_t i) { return value(i) - slope * points_.speed[i]; };
    const std::size_t low = *std::ranges::min_element(points_.ruptured, {}, above_line);
    if (hull_.empty())
      return piece({{low, 1.0}}, held_.constant ? -*held_.constant : 0.0, -points_.speed[low]);
    const std::size_t high = *std::ranges::max_element(hull_, {}, above_line);
    if (!held_.constant)
      return piece({{low, 0.5}, {high, -0.5}}, 0.0, 0.5 * (points_.speed[high] - points_.speed[low]));
    const double constant = *held_.constant;
    if (above_line(low) - constant <= constant - above_line(high))
      return piece({{low, 1.0}}, -constant, -points_.speed[low]);
    return piece({{high, -1.0}}, constant, points_.speed[high]);
  }
  /// Half way between the points on both sides.
  [[nodiscard]] double constant_at(double slope) const {
    if (held_.constant) return *held_.constant;
    double above = infinite;
    double below = -infinite;
    for (const std::size_t i : points_.ruptured) above = std::min(above, value(i) - slope * points_.speed[i]);
    for (const std::size_t i : hull_) below = std::max(below, value(i) - slope * points_.speed[i]);
    return std::isfinite(below) ? 0.5 * (above + below) : above;
  }

 private:
  [[nodiscard]] double value(std::size_t i) const { return force_[static_cast<Eigen::Index>(i)]; }
  [[nodiscard]] Piece piece(std::vector<Separation::Point> points, double constant, double by_slope) const {
    Piece piece{.points = std::move(points), .constant = constant, .by_slope = by_slope, .at_none = constant};
    for (const auto& [i, weight] : piece.points) piece.at_none += weight * value(i);
    return piece;
  }
  /// Whole points that push are below the line wherever those on their upper hull are.
  void add_to_hull(std::size_t i) {
    if (!(value(i) > 0.0)) return;
    if (!hull_.empty() && points_.speed[hull_.back()] == points_.speed[i]) {
      if (value(hull_.back()) >= value(i)) return;
      hull_.pop_back();
    }
    const auto turns_left = [&](std::size_t a, std::size_t b) {
      return (points_.speed[b] - points_.speed[a]) * (value(i) - value(a)) >=
             (value(b) - value(a)) * (points_.speed[i] - points_.speed[a]);
    };
    while (hull_.size() >= 2 && turns_left(hull_[hull_.size() - 2], hull_.back())) hull_.pop_back();
    hull_.push_back(i);
  }

  const RupturePoints& points_;
  const Eigen::VectorXd& force_;
  const HeldLine& held_;
  std::vector<std::size_t> hull_;
};

Separation of_piece(const Piece& piece, double slope, double constant) {
  return {.line = {.per_speed = slope, .constant = constant},
          .margin = piece.at(slope),
          .points = piece.points,
          .constant = piece.constant + slope * piece.by_slope};
}

/// Where two pieces cross, one that rises and one that falls: their sum that the slope does not move.
Separation of_crossing(const Piece& rises, const Piece& falls, double slope, double constant) {
  const double share = falls.by_slope / (falls.by_slope - rises.by_slope);
  Separation both{.line = {.per_speed = slope, .constant = constant}, .margin = rises.at(slope)};
  for (const auto& [i, weight] : rises.points) both.points.push_back({i, share * weight});
  for (const auto& [i, weight] : falls.points) both.points.push_back({i, (1.0 - share) * weight});
  both.constant = share * rises.constant + (1.0 - share) * falls.constant;
  return both;
}

}  // namespace

void RupturePoints::sort_whole() {
  std::ranges::stable_sort(whole, {}, [&](std::size_t i) { return speed[i]; });
}

Separation separation_of(const RupturePoints& points, const Eigen::VectorXd& force, const HeldLine& held) {
  constexpr int most_steps = 60;
  constexpr double as_good = 1e-12;
  const Margins margins(points, force, held);
  const double begin = held.per_speed.value_or(0.0);
  Piece here = margins.at(begin);
  if (held.per_speed || here.by_slope == 0.0) return of_piece(here, begin, margins.constant_at(begin));
  // Outwards until the margin falls again.
  const double way = here.by_slope > 0.0 ? 1.0 : -1.0;
  double fastest = 0.0;
  for (const std::size_t i : points.ruptured) fastest = std::max(fastest, points.speed[i]);
  double slope = way * force.cwiseAbs().maxCoeff() / std::max(fastest, 1e-12);
  Piece there = margins.at(slope);
  for (int i = 0; there.by_slope * way > 0.0; ++i, slope *= 4.0) {
    if (i == most_steps) return of_piece(there, slope, margins.constant_at(slope));
    here = there;
    there = margins.at(slope);
  }
  Piece rises = way > 0.0 ? here : there;
  Piece falls = way > 0.0 ? there : here;
  for (int i = 0; i < most_steps && rises.by_slope > 0.0 && falls.by_slope < 0.0; ++i) {
    slope = (falls.at_none - rises.at_none) / (rises.by_slope - falls.by_slope);
    const Piece between = margins.at(slope);
    const double crossing = rises.at(slope);
    if (between.at(slope) >= crossing - as_good * std::abs(crossing)) break;
    (between.by_slope > 0.0 ? rises : falls) = between;
  }
  if (!(rises.by_slope > 0.0)) return of_piece(rises, slope, margins.constant_at(slope));
  if (!(falls.by_slope < 0.0)) return of_piece(falls, slope, margins.constant_at(slope));
  return of_crossing(rises, falls, slope, margins.constant_at(slope));
}

}  // namespace kerf::fitting

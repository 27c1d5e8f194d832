#include "segmented/segmented_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace kerf::fitting::segmented {
namespace {

constexpr double one_position = 1e-6;  ///< of the range: a line that rests on less says nothing

constexpr int stretch_bits = 10;  ///< of the number of stretches between knots that are kept
constexpr std::size_t leaf_points = 32;
/// With more, a search asks for fewer stretches than there are points, and their parts are summed when asked
/// for.
constexpr std::size_t most_parts_kept = 100'000;

void check(const Curve& curve) {
  const std::size_t size = curve.position.size();
  if (curve.force.size() != size || (!curve.weight.empty() && curve.weight.size() != size) ||
      (!curve.branch.empty() && curve.branch.size() != size)) {
    refuse("positions, forces, weights and branches must be equally many");
  }
  if (size > std::numeric_limits<std::uint32_t>::max()) refuse("at most 4,294,967,295 points can be fitted");
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::isfinite(curve.position[i]) || !std::isfinite(curve.force[i])) {
      refuse("point " + std::to_string(i) + " is not finite; remove it");
    }
    if (!curve.weight.empty() && !(curve.weight[i] >= 0.0 && std::isfinite(curve.weight[i]))) {
      refuse("the weight of point " + std::to_string(i) + " must be zero or positive");
    }
    if (!curve.branch.empty() && curve.branch[i] > 1) {
      refuse("the branch of point " + std::to_string(i) + " must be 0 (closing) or 1 (opening)");
    }
  }
}

}  // namespace

void refuse(const std::string& what) { throw std::invalid_argument("segmented fit: " + what); }

Branch::Branch(std::vector<Point> points) {
  const auto earlier = [](const Point& a, const Point& b) { return a.x < b.x; };
  if (!std::is_sorted(points.begin(), points.end(), earlier)) {
    // Among equal positions the order decides nothing but the rounding; it must not depend on the input's.
    std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
      return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.weight < b.weight);
    });
  }
  const bool weighted =
      std::any_of(points.begin(), points.end(), [](const Point& p) { return p.weight != 1.0; });
  x_.reserve(points.size());
  y_.reserve(points.size());
  if (weighted) weight_.reserve(points.size());
  for (const Point& point : points) {
    x_.push_back(point.x);
    y_.push_back(point.y);
    if (weighted) weight_.push_back(point.weight);
  }

  const std::size_t stretches = std::bit_ceil(x_.size() / 8 + 1);
  index_.reserve(stretches + 1);
  std::size_t i = 0;
  for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
    const double from = static_cast<double>(stretch) / static_cast<double>(stretches);
    while (i < x_.size() && x_[i] < from) ++i;
    index_.push_back(static_cast<std::uint32_t>(i));
  }
  index_.push_back(static_cast<std::uint32_t>(x_.size()));

  leaves_ = std::bit_ceil(x_.size() / leaf_points + 1);
  tree_.resize(2 * leaves_);
  for (std::size_t first = 0; first < x_.size(); first += leaf_points) {
    tree_[leaves_ + first / leaf_points] = leaf(first, std::min(first + leaf_points, x_.size()));
  }
  for (std::size_t node = leaves_; node-- > 1;) {
    tree_[node] = tree_[2 * node];
    tree_[node].join(tree_[2 * node + 1]);
  }

  kept_.resize(std::size_t{1} << stretch_bits);
  if (x_.size() > most_parts_kept) return;
  std::vector<Moments> heads, tails;
  heads.reserve(x_.size() + 1);
  tails.reserve(x_.size() + 1);
  for (std::size_t at = 0; at <= x_.size(); ++at) {
    heads.push_back(head(at));
    tails.push_back(tail(at));
  }
  heads_ = std::move(heads);
  tails_ = std::move(tails);
}

/// Of the points from the beginning of a leaf to before a point of it, and of those from there to its end.
Moments Branch::head(std::size_t last) const noexcept {
  return heads_.empty() ? leaf(last / leaf_points * leaf_points, last) : heads_[last];
}
Moments Branch::tail(std::size_t first) const noexcept {
  const std::size_t end = (first + leaf_points - 1) / leaf_points * leaf_points;
  return tails_.empty() ? leaf(first, std::min(end, x_.size())) : tails_[first];
}

std::size_t Branch::before(double position) const noexcept {
  if (position >= 1.0) return x_.size();
  const auto stretch = static_cast<std::size_t>(position * static_cast<double>(index_.size() - 1));
  const auto from = x_.begin() + index_[stretch];
  const auto to = x_.begin() + index_[stretch + 1];
  return static_cast<std::size_t>(std::lower_bound(from, to, position) - x_.begin());
}

std::size_t Branch::between(double from, double to) const noexcept {
  if (from >= 1.0) return 0;
  std::size_t end = before(to);
  while (end < x_.size() && x_[end] == to) ++end;
  return end - before(from);
}

bool Branch::supports(std::size_t first, std::size_t last, std::size_t fewest) const noexcept {
  const std::size_t count = last - first;
  if (count < fewest || count == 0) return count >= fewest;
  return fewest < 2 || x_[last - 1] - x_[first] >= one_position;
}

const Branch::Stretch& Branch::stretch(double from, double to) const noexcept {
  const std::uint64_t mixed = (std::bit_cast<std::uint64_t>(from) * 0x9E3779B97F4A7C15U) ^
                              (std::bit_cast<std::uint64_t>(to) * 0xC2B2AE3D27D4EB4FU);
  Stretch& kept = kept_[static_cast<std::size_t>((mixed * 0x9E3779B97F4A7C15U) >> (64 - stretch_bits))];
  if (kept.from == from && kept.to == to) return kept;
  kept.from = from;
  kept.to = to;
  kept.first = before(from);
  kept.last = kept.first + between(from, to);
  kept.moments = range(kept.first, std::max(kept.first, before(to)));
  kept.line = line_between(kept.moments, from, to);
  return kept;
}

Moments Branch::leaf(std::size_t first, std::size_t last) const noexcept {
  Moments sums;
  if (first == last) return sums;
  for (std::size_t i = first; i < last; ++i) {
    const double weight = weight_.empty() ? 1.0 : weight_[i];
    sums.weight += weight;
    sums.x += weight * (x_[i] - x_[first]);
    sums.y += weight * (y_[i] - y_[first]);
  }
  sums.x = x_[first] + sums.x / sums.weight;
  sums.y = y_[first] + sums.y / sums.weight;
  for (std::size_t i = first; i < last; ++i) {
    const double weight = weight_.empty() ? 1.0 : weight_[i];
    const double dx = x_[i] - sums.x;
    const double dy = y_[i] - sums.y;
    sums.xx += weight * dx * dx;
    sums.xy += weight * dx * dy;
    sums.yy += weight * dy * dy;
  }
  return sums;
}

Moments Branch::range(std::size_t first, std::size_t last) const noexcept {
  std::size_t left = (first + leaf_points - 1) / leaf_points;
  std::size_t right = last / leaf_points;
  if (left >= right) return first < last ? leaf(first, last) : Moments{};
  Moments sums = tail(first);
  Moments end = head(last);
  for (left += leaves_, right += leaves_; left < right; left /= 2, right /= 2) {
    if (left % 2 == 1) sums.join(tree_[left++]);
    if (right % 2 == 1) {
      Moments node = tree_[--right];
      node.join(end);
      end = node;
    }
  }
  sums.join(end);
  return sums;
}

double Branch::error(const std::vector<double>& knots, const std::vector<double>& force) const {
  double total = 0.0;
  std::size_t i = 0;
  for (std::size_t segment = 0; segment + 1 < knots.size(); ++segment) {
    const std::size_t end = before(knots[segment + 1]);
    const double slope = (force[segment + 1] - force[segment]) / (knots[segment + 1] - knots[segment]);
    double sum = 0.0;
    for (; i < end; ++i) {
      const double miss = y_[i] - force[segment] - slope * (x_[i] - knots[segment]);
      sum += (weight_.empty() ? 1.0 : weight_[i]) * miss * miss;
    }
    total += sum;
  }
  return total;
}

Points::Points(const Curve& curve) {
  check(curve);
  const auto weight_of = [&](std::size_t i) { return curve.weight.empty() ? 1.0 : curve.weight[i]; };
  first = std::numeric_limits<double>::infinity();
  last = -first;
  double sum = 0.0;
  for (std::size_t i = 0; i < curve.position.size(); ++i) {
    if (weight_of(i) == 0.0) continue;
    first = std::min(first, curve.position[i]);
    last = std::max(last, curve.position[i]);
    ++count;
    weight += weight_of(i);
    sum += weight_of(i) * curve.force[i];
  }
  if (count == 0) refuse("there are no points");
  if (!(first < last)) refuse("all points are at one position; a curve needs at least two");
  middle = sum / weight;
  double squares = 0.0;
  for (std::size_t i = 0; i < curve.position.size(); ++i) {
    squares += weight_of(i) * (curve.force[i] - middle) * (curve.force[i] - middle);
  }
  if (!std::isfinite(last - first) || !std::isfinite(squares))
    refuse("the numbers are too large to be squared");
  spread = std::sqrt(squares / weight);
  // A constant force leaves nothing but rounding, which must not be blown up.
  if (spread <= 1e-14 * std::abs(middle)) spread = std::max(std::abs(middle), 1e-300);
  if (spread == 0.0) spread = 1.0;

  std::vector<std::vector<Branch::Point>> points(curve.branch.empty() ? 1 : 2);
  for (auto& of_branch : points) of_branch.reserve(count);
  for (std::size_t i = 0; i < curve.position.size(); ++i) {
    if (weight_of(i) == 0.0) continue;
    points[curve.branch.empty() ? 0 : curve.branch[i]].push_back(
        {scaled(curve.position[i]), (curve.force[i] - middle) / spread, weight_of(i)});
  }
  for (auto& of_branch : points) branches.emplace_back(std::move(of_branch));
  for (const Branch& branch : branches) {
    const std::vector<double> before = std::move(places);
    places.clear();
    places.reserve(before.size() + branch.size());
    std::merge(before.begin(), before.end(), branch.positions().begin(), branch.positions().end(),
               std::back_inserter(places));
  }
  places.erase(std::unique(places.begin(), places.end()), places.end());
}

double Points::position(double x) const noexcept {
  return x <= 0.0 ? first : x >= 1.0 ? last : first + x * (last - first);
}

}  // namespace kerf::fitting::segmented

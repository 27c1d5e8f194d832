#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kerf/fitting/segmented.h"
#include "segmented/segmented_line.h"

namespace kerf::fitting::segmented {

/// @throws std::invalid_argument that says what is wrong with a segmented fit.
[[noreturn]] void refuse(const std::string& what);

/// The points of one branch, sorted, in scaled coordinates: positions from 0 to 1 over all branches, forces
/// about zero with a spread of one. A tree over stretches of them gives the moments of any range. What was
/// asked for between two knots is kept, for they change one at a time: not for several threads at once.
class Branch {
 public:
  struct Point {
    double x, y, weight;
  };
  explicit Branch(std::vector<Point> points);

  [[nodiscard]] std::size_t size() const noexcept { return x_.size(); }
  [[nodiscard]] const std::vector<double>& positions() const noexcept { return x_; }
  /// How many points lie before a position; all do before 1, the end.
  [[nodiscard]] std::size_t before(double position) const noexcept;
  /// How many points lie from one position to another, both ends included.
  [[nodiscard]] std::size_t between(double from, double to) const noexcept;
  /// Whether a line may rest on points [first, last): so many, and not all of them at one position where it
  /// is more than one. An encoder visits the same positions again and again.
  [[nodiscard]] bool supports(std::size_t first, std::size_t last, std::size_t fewest) const noexcept;
  [[nodiscard]] Moments range(std::size_t first, std::size_t last) const noexcept;

  /// What lies between two knots.
  struct Stretch {
    double from = std::numeric_limits<double>::quiet_NaN();
    double to = from;
    std::size_t first = 0, last = 0;  ///< the points there, both ends included
    Moments moments;                  ///< of those from `from` to before `to`
    Line line;
  };
  [[nodiscard]] const Stretch& stretch(double from, double to) const noexcept;
  /// Sum of squares about the polygon, point by point.
  [[nodiscard]] double error(const std::vector<double>& knots, const std::vector<double>& force) const;

 private:
  [[nodiscard]] Moments leaf(std::size_t first, std::size_t last) const noexcept;
  [[nodiscard]] Moments head(std::size_t last) const noexcept;
  [[nodiscard]] Moments tail(std::size_t first) const noexcept;

  std::vector<double> x_, y_, weight_;  ///< no weights if all are 1
  std::vector<Moments> tree_;           ///< node i over nodes 2i and 2i + 1
  std::size_t leaves_ = 0;
  std::vector<Moments> heads_, tails_;  ///< of the leaf of each point: what is before it, and the rest
  std::vector<std::uint32_t> index_;    ///< points before each of equal stretches of the position
  mutable std::vector<Stretch> kept_;
};

/// A curve that was checked, sorted and scaled.
struct Points {
  explicit Points(const Curve& curve);

  std::vector<Branch> branches;
  std::vector<double> places;      ///< every scaled position of a point, once
  double first = 0.0, last = 0.0;  ///< positions
  double middle = 0.0;             ///< of the forces
  double spread = 1.0;             ///< of the forces
  std::size_t count = 0;
  double weight = 0.0;

  [[nodiscard]] double position(double x) const noexcept;
  [[nodiscard]] double scaled(double position) const noexcept { return (position - first) / (last - first); }
};

}  // namespace kerf::fitting::segmented

#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kerf::fitting {

/// A function of `x` as means in bins of equal width, linear between them and constant beyond; with slopes
/// each bin is a straight line in `v` by least squares.
class BinnedCurve {
 public:
  BinnedCurve(double least, double most, std::size_t bins, bool with_slopes);
  void add(double x, double v, double y);
  /// Bins of fewer than three values are left out. Once all is added.
  void settle();
  [[nodiscard]] double at(double x, double v) const;

 private:
  struct Bin {
    double x = 0.0;  ///< sums, and once settled means
    double v = 0.0;
    double y = 0.0;
    double vv = 0.0;
    double vy = 0.0;
    double count = 0.0;
    double slope = 0.0;
  };
  double least_;
  double width_;
  bool with_slopes_;
  std::vector<Bin> bins_;
};

/// A function of two variables as means in cells, bilinear between their centres, drawn to zero where a cell
/// holds few values. Rows are cells of `v` between the given borders.
class BinnedSurface {
 public:
  BinnedSurface(double least, double most, std::size_t bins, std::vector<double> borders);
  void add(double x, double v, double y);
  void settle();
  [[nodiscard]] double at(double x, double v) const;

 private:
  [[nodiscard]] double in_row(std::size_t row, double place) const;

  double least_;
  double width_;
  std::size_t bins_;
  std::vector<double> borders_;  ///< inner ones, increasing
  std::vector<double> centre_;   ///< mean v of each row
  std::vector<double> mean_;
  std::vector<double> count_;
};

}  // namespace kerf::fitting

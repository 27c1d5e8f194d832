#include <cmath>
#include <limits>
#include <vector>

#include "kerf/fitting/checked_recordings.h"
#include "least_squares.h"
#include "samples.h"

namespace kerf::fitting {
namespace {

/// Sums over rows that a straight line of force over penetration is found from.
struct LineSums {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();

  void add(double penetration, double force) {
    const Eigen::Vector2d row(1.0, penetration);
    normal += row * row.transpose();
    right += row * force;
  }
  [[nodiscard]] Eigen::Vector2d line() const { return solve_normal(normal, right); }
};

double square_left(const Eigen::Vector2d& line, double penetration, double force) {
  const double error = line[0] + line[1] * penetration - force;
  return error * error;
}

}  // namespace

double line_rmse(const Series& series) {
  const auto counts = [&](std::size_t i) { return series.counts.empty() || series.counts[i] != 0; };
  LineSums sums;
  for (std::size_t i = 0; i < series.force.size(); ++i) {
    if (counts(i)) sums.add(series.penetration[i], series.force[i]);
  }
  const Eigen::Vector2d line = sums.line();
  double squares = 0.0;
  for (std::size_t i = 0; i < series.force.size(); ++i) {
    if (counts(i)) squares += square_left(line, series.penetration[i], series.force[i]);
  }
  return std::sqrt(squares / sums.normal(0, 0));
}

double held_out_line_rmse(const CheckedRecordings& recordings) {
  const Samples& samples = recordings.samples();
  std::vector<LineSums> of_fold(samples.folds);
  const auto is_held_out = [&](std::size_t i) {
    return samples.counts[i] != 0 && samples.fold[i] < samples.folds;
  };
  LineSums all;  // with what is never held out and yet seen
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double penetration = samples.motion[i].penetration;
    if (is_held_out(i)) of_fold[samples.fold[i]].add(penetration, samples.force[i]);
    if (samples.counts[i] != 0 && samples.fold[i] != Samples::test) all.add(penetration, samples.force[i]);
  }
  std::vector<Eigen::Vector2d> without;
  std::size_t folds = 0;
  double held_out = 0.0;
  for (const LineSums& fold : of_fold) {
    without.push_back(LineSums{all.normal - fold.normal, all.right - fold.right}.line());
    folds += fold.normal(0, 0) > 0.0 ? 1 : 0;
    held_out += fold.normal(0, 0);
  }
  if (folds < 2) return std::numeric_limits<double>::quiet_NaN();
  double squares = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (is_held_out(i))
      squares += square_left(without[samples.fold[i]], samples.motion[i].penetration, samples.force[i]);
  }
  return std::sqrt(squares / held_out);
}

}  // namespace kerf::fitting

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Core>
#include <boost/math/distributions/students_t.hpp>

#include <kerf/identification/weak_form.h>

#include "jackknife.h"
#include "modulated.h"

namespace kerf::identification {
namespace {

constexpr double small_delay = 0.1;  // ticks

}  // namespace

std::optional<PlacedModel> first_model(const AxisData& data, std::span<const Stretch> stretches,
                                       std::size_t places, double longest_delay_ticks) {
  const Signals signals(data);
  const std::vector<Window> windows = windows_of(data, stretches);
  const Eigen::MatrixXd columns = columns_of(data, signals, windows, places);
  if (columns.rows() < columns.cols() + 8 || !(columns.col(0).norm() > 0.0)) return std::nullopt;
  std::optional<PlacedModel> best;
  double least = std::numeric_limits<double>::infinity();
  for (double ticks = 0.0; ticks <= longest_delay_ticks; ticks += 0.25) {
    const Eigen::VectorXd forces = forces_of(data, signals, windows, ticks);
    const LeastSquares solved = least_squares(columns, forces);
    const double squares = solved.residual.squaredNorm();
    if (!(squares < least) || !(solved.solution[0] > 0.0)) continue;
    least = squares;
    PlacedModel model;
    model.axis = {.mass_kg = solved.solution[0],
                  .viscous_n_s_per_m = std::max(0.0, solved.solution[1]),
                  .coulomb_n = std::max(0.0, solved.solution[3]),
                  .stiffness_n_per_m = solved.solution[2],
                  .offset_n = 0.0,
                  .delay_s = ticks * data.period_s};
    model.offset_n.assign(places, 0.0);
    for (std::size_t place = 0; place < places; ++place) {
      model.offset_n[place] = solved.solution[static_cast<Eigen::Index>(4 + place)];
    }
    best = model;
  }
  return best;
}

std::optional<MotorConstant> motor_constant(const AxisData& data, std::span<const double> sensor_n,
                                            std::span<const Stretch> stretches, const OutputErrorFit& fit) {
  if (sensor_n.size() != data.position_m.size()) return std::nullopt;
  const PlacedModel& model = fit.model;
  const Signals signals(data, fit);
  std::vector<Window> windows;
  for (const Window& at : windows_of(data, stretches)) {
    bool whole = true;
    for (std::size_t n = at.begin; n < at.begin + window; ++n)
      whole &= std::isfinite(sensor_n[n] + signals.direction(n));
    if (whole) windows.push_back(at);
  }
  const Eigen::MatrixXd all = columns_of(data, signals, windows, model.offset_n.size());
  if (all.rows() < all.cols() + 8) return std::nullopt;
  // Without a spring: what pulls the handle back is the hand, and the sensor reads it. With what an error of
  // the delay would do.
  const double delay_ticks = model.axis.delay_s / data.period_s;
  const double earlier = std::max(0.0, delay_ticks - small_delay);
  Eigen::MatrixXd columns(all.rows(), all.cols() + 1);
  columns << all.leftCols(2), all.rightCols(all.cols() - 3),
      forces_of(data, signals, windows, delay_ticks + small_delay) -
          forces_of(data, signals, windows, earlier),
      -forces_of(data, signals, windows, delay_ticks);
  const Modulating w(data.period_s);
  Eigen::VectorXd sensed(columns.rows());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    sensed[static_cast<Eigen::Index>(i)] =
        product(w.value, windows[i].begin, [&](std::size_t n) { return sensor_n[n]; });
  }
  const LeastSquares solved = least_squares(columns, sensed);
  const double left = solved.residual.squaredNorm();
  const double mean = sensed.mean();
  const double read = (sensed.array() - mean).matrix().squaredNorm();
  if (!(read > 0.0) || left > 0.5 * read) return std::nullopt;
  const auto p = columns.cols();
  std::map<std::size_t, Cluster> clusters;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    clusters[windows[i].cluster] += Cluster(columns.row(row), solved.residual.segment(row, 1));
  }
  const double degrees = static_cast<double>(clusters.size()) - static_cast<double>(p);
  if (degrees < 1.0) return std::nullopt;
  const Eigen::MatrixXd covariance = jackknife(solved.inverse, clusters);
  const boost::math::students_t t(degrees);
  return MotorConstant{.value = solved.solution[p - 1],
                       .half_width = boost::math::quantile(boost::math::complement(t, 0.025)) *
                                     std::sqrt(std::max(0.0, covariance(p - 1, p - 1)))};
}

}  // namespace kerf::identification

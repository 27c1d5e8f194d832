#include "prepare/weight.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/core.h>

#include <kerf/models/rotation.h>

#include "prepare/bias.h"

namespace kerf::bench {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double gravity = 9.80665;
/// Beyond it, a direction of the unknowns is known 50 times worse than another: the vertical moved by some
/// two degrees only.
constexpr double worst_condition = 50.0;
constexpr std::size_t fewest_rows = 30;
/// Of the Jacobian of a rotation vector; 0.2 rad from a whole turn.
constexpr double least_determinant = 1e-3;

/// Where the six axes stand in a row.
struct Places {
  std::array<std::size_t, 3> linear{};
  std::array<std::size_t, 3> angular{};
};

Places find_places(const schema::Recording& recording) {
  Places places;
  const auto find = [&](const std::string& name, const char* position_unit, const char* force_unit) {
    for (std::size_t axis = 0; axis < recording.dimensions(); ++axis) {
      const schema::Axis& about = recording.axes[axis];
      if (about.name == name && about.position_unit == position_unit && about.force_unit == force_unit) {
        return axis;
      }
    }
    throw std::invalid_argument(fmt::format(
        "--weight needs the axes x, y, z in m with forces in N and rx, ry, rz in rad with torques in N·m (a "
        "rotation vector); the recording has no such axis '{}'",
        name));
  };
  constexpr std::array linear{"x", "y", "z"};
  constexpr std::array angular{"rx", "ry", "rz"};
  for (std::size_t i = 0; i < 3; ++i) {
    places.linear[i] = find(linear[i], "m", "N");
    places.angular[i] = find(angular[i], "rad", "N·m");
  }
  if (recording.force_measured.empty()) {
    throw std::invalid_argument("the recording holds no measured force to take a weight off");
  }
  return places;
}

Vector3d take(const double* row, const std::array<std::size_t, 3>& at) {
  return {row[at[0]], row[at[1]], row[at[2]]};
}

/// A row's force and torque in the sensor's frame, and g there.
struct Sensed {
  Vector3d force;
  Vector3d torque;
  Vector3d gravity_here;
  Matrix3d to_world;
  Matrix3d jacobian;  ///< of the rotation vector, where torques are generalised
};

/// As an import of six axes says of itself: torques are J^T of the moment in the world's axes.
bool holds_generalised_torques(const schema::Recording& recording) {
  const auto found = recording.header.device_properties.find("torques");
  return found != recording.header.device_properties.end() &&
         found->second == schema::Properties::mapped_type("generalised");
}

class Rows {
 public:
  Rows(schema::Recording& recording, bool base_frame)
      : recording_(recording),
        places_(find_places(recording)),
        generalised_(holds_generalised_torques(recording)),
        base_frame_(base_frame || generalised_) {}

  [[nodiscard]] Sensed operator[](std::size_t row) const {
    const std::size_t at = row * recording_.dimensions();
    Sensed sensed;
    const Vector3d r = take(&recording_.position[at], places_.angular);
    sensed.to_world = models::rotation_of(r);
    if (generalised_) sensed.jacobian = models::left_jacobian(r);
    sensed.force = take(&recording_.force_measured[at], places_.linear);
    sensed.torque = take(&recording_.force_measured[at], places_.angular);
    sensed.gravity_here = sensed.to_world.transpose() * Vector3d(0.0, 0.0, -gravity);
    if (generalised_) {
      // Near a whole turn the torques of the axes do not tell the moment.
      if (!(sensed.jacobian.determinant() > least_determinant)) sensed.force.setConstant(NAN);
      sensed.torque = sensed.jacobian.transpose().inverse() * sensed.torque;
    }
    if (base_frame_) {
      sensed.force = sensed.to_world.transpose() * sensed.force;
      sensed.torque = sensed.to_world.transpose() * sensed.torque;
    }
    return sensed;
  }

  void take_off(std::size_t row, const Sensed& sensed, Vector3d force, Vector3d torque) {
    if (base_frame_) {
      force = sensed.to_world * force;
      torque = sensed.to_world * torque;
    }
    if (generalised_) torque = sensed.jacobian.transpose() * torque;
    double* const values = &recording_.force_measured[row * recording_.dimensions()];
    for (std::size_t i = 0; i < 3; ++i) {
      values[places_.linear[i]] -= force[static_cast<Eigen::Index>(i)];
      values[places_.angular[i]] -= torque[static_cast<Eigen::Index>(i)];
    }
  }

 private:
  schema::Recording& recording_;
  Places places_;
  bool generalised_;
  bool base_frame_;
};

Matrix3d cross(const Vector3d& v) {
  Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// Least squares of rows that come three at a time, by the normal equations of columns that are all near one.
struct Solution {
  Eigen::VectorXd values;
  Eigen::VectorXd errors;
  double condition = 0.0;
  double noise = 0.0;
};

template <int unknowns, typename Design, typename Observed>
Solution solve(const std::vector<Sensed>& sensed, Design design, Observed observed) {
  using Normal = Eigen::Matrix<double, unknowns, unknowns>;
  Normal normal = Normal::Zero();
  Eigen::Vector<double, unknowns> right = Eigen::Vector<double, unknowns>::Zero();
  for (const Sensed& row : sensed) {
    const auto a = design(row);
    normal += a.transpose() * a;
    right += a.transpose() * observed(row);
  }
  const Eigen::SelfAdjointEigenSolver<Normal> eigen(normal);
  Solution solution;
  const double least = eigen.eigenvalues()[0];
  solution.condition = least > 0.0 ? std::sqrt(eigen.eigenvalues()[unknowns - 1] / least) : INFINITY;
  if (!(solution.condition <= worst_condition)) return solution;
  const Normal& basis = eigen.eigenvectors();
  const auto inverse = eigen.eigenvalues().cwiseInverse().eval();
  solution.values = basis * inverse.cwiseProduct(basis.transpose() * right);
  std::array<std::vector<double>, 3> residuals;
  double squares = 0.0;
  for (const Sensed& row : sensed) {
    const Vector3d residual = observed(row) - design(row) * solution.values;
    squares += residual.squaredNorm();
    for (std::size_t i = 0; i < 3; ++i) residuals[i].push_back(residual[static_cast<Eigen::Index>(i)]);
  }
  const double variance =
      squares / static_cast<double>(3 * static_cast<Eigen::Index>(sensed.size()) - unknowns);
  solution.noise = std::sqrt(variance);
  double as_one = 1.0;
  for (const auto& one : residuals) as_one = std::max(as_one, rows_that_count_as_one(one));
  solution.errors = (as_one * variance * (basis.cwiseAbs2() * inverse)).cwiseSqrt();
  return solution;
}

double tilt_of(const std::vector<Sensed>& sensed) {
  Vector3d mean = Vector3d::Zero();
  for (const Sensed& row : sensed) mean += row.gravity_here / gravity;
  mean /= static_cast<double>(sensed.size());
  double squares = 0.0;
  for (const Sensed& row : sensed) squares += (row.gravity_here / gravity - mean).squaredNorm();
  return std::sqrt(squares / static_cast<double>(sensed.size())) * 180.0 / std::numbers::pi;
}

[[noreturn]] void refuse(const Weight& weight, const char* unknown, const char* mend) {
  throw std::invalid_argument(fmt::format(
      "--weight: the free rows do not tell {} (condition number {:.3g}, at most {:g}; the vertical moved by "
      "{:.1f} deg in them); {}, or give --mass and --centre",
      unknown, weight.condition, worst_condition, weight.tilt_deg, mend));
}

std::array<double, 3> as_array(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Weight estimate(const std::vector<Sensed>& sensed) {
  Weight weight{.estimated = true, .rows = sensed.size(), .tilt_deg = tilt_of(sensed)};
  weight.has_torque = std::ranges::all_of(sensed, [](const Sensed& row) { return row.torque.allFinite(); });
  const auto force_design = [](const Sensed& row) {
    Eigen::Matrix<double, 3, 4> a;
    a << Matrix3d::Identity(), row.gravity_here / gravity;
    return a;
  };
  const Solution force = solve<4>(sensed, force_design, [](const Sensed& row) { return row.force; });
  weight.condition = force.condition;
  if (force.values.size() == 0) {
    refuse(weight, "the weight from the bias",
           "hold the tool free at three orientations or more that differ by 30 deg");
  }
  weight.mass_kg = force.values[3] / gravity;
  weight.mass_error_kg = force.errors[3] / gravity;
  weight.force_bias_n = as_array(force.values.head<3>());
  weight.force_noise_n = force.noise;
  if (!weight.has_torque) return weight;
  const auto torque_design = [](const Sensed& row) {
    Eigen::Matrix<double, 3, 6> a;
    a << Matrix3d::Identity(), -cross(row.gravity_here / gravity);
    return a;
  };
  const Solution torque = solve<6>(sensed, torque_design, [](const Sensed& row) { return row.torque; });
  weight.condition = std::max(weight.condition, torque.condition);
  if (torque.values.size() == 0) {
    refuse(weight, "the centre of mass", "tilt the tool about a second axis as well, by 30 deg or more");
  }
  weight.torque_bias_nm = as_array(torque.values.head<3>());
  const double force_of_weight = force.values[3];
  weight.centre_m = as_array(torque.values.tail<3>() / force_of_weight);
  weight.centre_error_m = as_array(torque.errors.tail<3>() / std::abs(force_of_weight));
  return weight;
}

}  // namespace

Weight remove_weight(schema::Recording& recording, const std::vector<bool>& free,
                     const WeightOptions& options) {
  Rows rows(recording, options.base_frame);
  Weight weight;
  if (options.mass_kg) {
    weight = {.mass_kg = *options.mass_kg, .centre_m = options.centre_m, .has_torque = true};
  } else {
    std::vector<Sensed> sensed;
    for (std::size_t row = 0; row < free.size(); ++row) {
      if (!free[row]) continue;
      const Sensed one = rows[row];
      if (one.force.allFinite() && one.gravity_here.allFinite()) sensed.push_back(one);
    }
    if (sensed.size() < fewest_rows) {
      throw std::invalid_argument(
          fmt::format("--weight: {} rows are free of contact, {} are needed; --free A:B says when nothing is "
                      "touched",
                      sensed.size(), fewest_rows));
    }
    weight = estimate(sensed);
  }
  const Vector3d centre(weight.centre_m.data());
  const Vector3d force_bias(weight.force_bias_n.data());
  const Vector3d torque_bias(weight.torque_bias_nm.data());
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const Sensed sensed = rows[row];
    const Vector3d pull = weight.mass_kg * sensed.gravity_here;
    const Vector3d torque = weight.has_torque ? Vector3d(torque_bias + centre.cross(pull)) : Vector3d::Zero();
    rows.take_off(row, sensed, force_bias + pull, torque);
  }
  return weight;
}

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace kerf::bench {

/// Several axes of a device in a hand, coupled by their inertia, that meet a wall of matrices:
///
///     M x'' + D x' + S x = F_held,   F = -K x_k - B v_k
///
/// x is read at t = k T; v_k is its difference over T, low-passed as in SampledDevice; the force reaches the
/// motors `delay_s` later and is held for a period. M, D and S are of device and hand together, n by n with n
/// from 1 to 6, in kg, N·s/m, N/m and their angular counterparts.
struct SampledAxes {
  Eigen::MatrixXd mass;                ///< M, symmetric, positive definite
  Eigen::MatrixXd damping;             ///< D, symmetric, positive semidefinite
  Eigen::MatrixXd stiffness;           ///< S of the hand, symmetric, positive semidefinite; empty: none
  double period_s = 1e-3;              ///< T, > 0
  double delay_s = 0.0;                ///< >= 0, at most SampledDevice::max_delay_ticks periods
  double velocity_corner_rad_s = 0.0;  ///< 0: the plain difference

  static constexpr Eigen::Index max_axes = 6;
  [[nodiscard]] Eigen::Index axes() const noexcept { return mass.rows(); }
};

/// K and B of a wall, n by n, of any kind: K need not be symmetric.
struct WallOfAxes {
  Eigen::MatrixXd stiffness;
  Eigen::MatrixXd damping;
};

/// @throws std::invalid_argument naming the matrix that is out of shape or range.
void check(const SampledAxes& device);
void check(const WallOfAxes& wall, const SampledAxes& device);

/// The device, closed over a wall that may be another one each tick, as a linear map from tick to tick.
///
/// State: x, v, the last reading, the filtered velocity, what the motors hold, and the commands on their way,
/// n numbers each. Exact between the ticks by the matrix exponential of [0 I; -M^-1 S, -M^-1 D], until and
/// after a command arrives within a period.
class SystemOfAxes {
 public:
  /// @throws std::invalid_argument as check().
  explicit SystemOfAxes(const SampledAxes& device);

  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  [[nodiscard]] Eigen::Index axes() const noexcept { return axes_; }
  /// The map of one tick.
  [[nodiscard]] Eigen::MatrixXd tick(const WallOfAxes& wall) const;
  /// Largest modulus of its eigenvalues. A direction in which neither hand nor wall pulls back has one at 1.
  [[nodiscard]] double spectral_radius(const WallOfAxes& wall) const;

  /// One tick of the time domain, number by number, from the same state: what simulates, independent of
  /// tick().
  void step(const WallOfAxes& wall, Eigen::VectorXd& state) const;

 private:
  Eigen::Index axes_;
  Eigen::Index size_;
  std::size_t delay_ticks_;
  double share_;
  double gain_;
  double period_s_;
  Eigen::MatrixXd before_, after_;  ///< 2n by 3n: x and v then, from x, v and a force
};

/// How fast a motion from anywhere grows in a tick, by simulation: the tick of the time domain is run from
/// each unit of the state, and the simulated motions are carried on over 2^doublings ticks; the logarithm of
/// their size over that time. Independent of eigenvalues.
[[nodiscard]] double simulated_growth(const SystemOfAxes& system, const WallOfAxes& wall, int doublings = 44);

}  // namespace kerf::bench

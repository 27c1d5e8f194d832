#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "stability/controllers/wall_controller.h"

namespace kerf::bench {

/// A linear controller on a wall and a device in a hand, as a linear system from tick to tick. Its matrix is
/// that of the ticks themselves: each column is what one of them makes of one unit of the state. Encoder
/// steps and Coulomb friction are left out.
class ControlledSystem {
 public:
  /// @throws std::invalid_argument as check(), and for a controller that is not linear.
  ControlledSystem(const ControllerDesign& design, const SampledDevice& device, const Wall& wall);

  /// Largest modulus of its eigenvalues: below 1 the motion dies away.
  [[nodiscard]] double spectral_radius() const;

  /// F = -H(z) x, with the device's own velocity filter: what the controller makes of the positions that are
  /// read, at z = exp(j angle).
  [[nodiscard]] std::complex<double> force_per_position(double angle) const;

  /// What the loop gives the hand at a frequency, at z = exp(j w T), with delay t_d and hold:
  ///
  ///     Z = H(z) exp(-j w t_d) (1 - exp(-j w T)) / (j w T) / (j w)     [N·s/m]
  ///
  /// for a motion that has nothing beyond half of the rate. What the hand feels is that and m j w + b.
  [[nodiscard]] std::complex<double> loop_impedance(double frequency_hz) const;

  /// Whether the wall gives no hand energy on the device's friction: friction_needed() at all frequencies.
  [[nodiscard]] bool is_passive() const;

 private:
  SampledDevice device_;
  Eigen::MatrixXd system_;      ///< of all of it, closed
  Eigen::MatrixXd controller_;  ///< of sensor and controller, fed by a position
  Eigen::VectorXd from_position_;
  Eigen::RowVectorXd to_force_;
  double through_ = 0.0;
};

/// What hold and delay make of a force at a frequency.
[[nodiscard]] std::complex<double> hold_and_delay(const SampledDevice& device, double frequency_hz);

/// Stiffness above `softest` at which the spectral radius first reaches 1; as eigenvalue_boundary().
[[nodiscard]] double controlled_boundary(const ControllerDesign& design, const SampledDevice& device,
                                         double wall_damping, double softest, double stiffest);
/// The stiffest wall of a damping that is passive in any hand, up to `stiffest`; 0: none. Of a controller
/// whose walls are passive up to one stiffness and no more.
[[nodiscard]] double controlled_passive(const ControllerDesign& design, double wall_damping, double stiffest);

}  // namespace kerf::bench

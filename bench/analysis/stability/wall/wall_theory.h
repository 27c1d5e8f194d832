#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "stability/device/sampled_device.h"

namespace kerf::bench {

/// A virtual wall: F = -K x - B v with the x and v that are read.
struct Wall {
  double stiffness_n_per_m = 0.0;
  double damping_n_s_per_m = 0.0;
};

/// Stiffest wall of a given damping that is passive by each of three criteria [N/m]; 0 where none is. All of
/// them speak of the device's own friction: whatever the hand does, it is given no energy.

/// b > K T / 2 + |B|, for the plain difference and no delay [ColgateSchenkel1997].
[[nodiscard]] double colgate_schenkel(const SampledDevice& device, double wall_damping);

/// K <= min(2 b / T, 2 f_c / delta), for B = 0, necessary and sufficient with Coulomb friction f_c and the
/// encoder step delta [AbbottOkamura2005].
[[nodiscard]] double abbott_okamura(const SampledDevice& device);

/// The same theorem of Colgate and Schenkel as it stands for any linear wall F = -H(z) x, with a delay of d
/// periods (a part of a period counts as a whole one): what the right side says at an angle w T > 0.
///
///     b > T / (2 (1 - cos wT)) Re{(1 - exp(-jwT)) exp(-jwTd) H(exp(jwT))}   for 0 <= w <= pi / T
[[nodiscard]] double friction_needed(const SampledDevice& device, double angle, std::complex<double> wall);

/// That theorem of walls with the velocity filter on one device:
///
///     H = K + B g (1 - z^-1) / (T (1 - (1 - g) z^-1)),   g the filter's gain
///
/// What K and B need at every frequency is found once for all of them.
class PassiveWalls {
 public:
  explicit PassiveWalls(const SampledDevice& device);

  /// Stiffest wall of a damping.
  [[nodiscard]] double stiffness(double wall_damping) const;
  /// How much of the device's friction a damper needs to be passive: 1 for the plain difference, less with a
  /// filter, whose lag in turn makes it a spring.
  [[nodiscard]] double worst_of_damping() const;

 private:
  /// What a unit of K and of B need of the device's friction at a frequency.
  struct Needs {
    double of_stiffness;
    double of_damping;
  };

  double viscous_n_s_per_m_;
  std::vector<Needs> needs_;
};

/// Of one wall alone.
[[nodiscard]] double passive_stiffness(const SampledDevice& device, double wall_damping);
[[nodiscard]] double worst_of_damping(const SampledDevice& device);

/// Walls on one device as a linear system from tick to tick: the wall pulls as it pushes; encoder steps and
/// Coulomb friction are left out.
///
/// State: x, v, the last reading, the filtered velocity, and the commands on their way. Exact: between the
/// ticks the device and hand move by the matrix exponential. It is linear in the wall's two numbers.
class SampledSystem {
 public:
  explicit SampledSystem(const SampledDevice& device);

  /// Largest modulus of its eigenvalues: below 1 the motion dies away.
  [[nodiscard]] double spectral_radius(const Wall& wall) const;

 private:
  Eigen::MatrixXd free_, of_stiffness_, of_damping_;
};

/// Of one wall alone.
[[nodiscard]] double spectral_radius(const SampledDevice& device, const Wall& wall);

/// Stiffness above `softest` at which the spectral radius first reaches 1, to a share of 1e-6; `stiffest` if
/// it never does, `softest` if it does at once.
[[nodiscard]] double eigenvalue_boundary(const SampledSystem& system, double wall_damping, double softest,
                                         double stiffest);
[[nodiscard]] double eigenvalue_boundary(const SampledDevice& device, double wall_damping, double softest,
                                         double stiffest);

}  // namespace kerf::bench

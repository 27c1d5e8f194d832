#pragma once

#include <cstddef>

#include "stability/sampled_device.h"
#include "stability/wall_theory.h"

namespace kerf::bench {

/// How a wall is tried: the device begins `start_m` inside it, at rest. With `push_n` the wall is one-sided
/// and the hand leans on it so hard; without, it pulls as it pushes, which is what the eigenvalues speak of.
struct WallTrial {
  double seconds = 2.0;
  double start_m = 1e-3;
  double push_n = 0.0;
};

/// Whether a simulated wall comes to rest.
///
/// The energy of the motion about its mean, M v^2 + K (x - mean)^2, is averaged over the second and the last
/// quarter of the time. It came to rest if it fell from the one to the other, or was small in the last: below
/// an encoder step. A limit cycle does not fall: with an encoder or Coulomb friction it has to fall by 10 %.
[[nodiscard]] bool comes_to_rest(const SampledDevice& device, const Wall& wall, const WallTrial& trial);

/// Stiffness above `softest` at which the wall first does not come to rest, to a share of `share`; as
/// eigenvalue_boundary(). Soft walls swing slowly and are tried for 20 of their periods if that is longer.
[[nodiscard]] double simulated_boundary(const SampledDevice& device, double wall_damping, double softest,
                                        double stiffest, const WallTrial& trial, double share = 2e-3);

}  // namespace kerf::bench

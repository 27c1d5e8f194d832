#pragma once

#include <memory>
#include <span>
#include <vector>

#include <kerf/fitting/jnd.h>

#include "stability/device/sampled_loop.h"
#include "stability/wall/wall_theory.h"

namespace kerf::bench {

/// How a wall is tried: the device begins `start_m` inside it, at rest. With `push_n` the wall is one-sided
/// and the hand leans on it so hard; without, it pulls as it pushes, which is what the eigenvalues speak of.
struct WallTrial {
  double seconds = 2.0;
  double start_m = 1e-3;
  double push_n = 0.0;
  double felt_n = fitting::force_jnd.threshold;  ///< rms of a force about its mean that a hand feels
};

/// Whether simulated walls come to rest.
///
/// The energy of the motion about its mean, M v^2 + K (x - mean)^2, is averaged over the second and the last
/// quarter of the time. A linear wall comes to rest if it falls from the one to the other. With an encoder,
/// Coulomb friction or one side there are limit cycles, which neither grow nor fall, and bounces, whose
/// energy rises and falls by chance: such a wall comes to rest if the force in the last quarter varies by
/// less than a hand feels; or if the energy falls from quarter to quarter, from the second to the last to a
/// half, and goes on to fall through four quarters more, or until no hand feels it.
class WallSimulation {
 public:
  explicit WallSimulation(const SampledDevice& device);

  [[nodiscard]] bool comes_to_rest(const Wall& wall, const WallTrial& trial) const;
  /// Of many walls at once: their ticks are independent of each other and overlap in the processor.
  [[nodiscard]] std::vector<bool> come_to_rest(std::span<const Wall> walls, const WallTrial& trial) const;

  /// Stiffness above `softest` at which the wall first does not come to rest, to a share of `share`; as
  /// eigenvalue_boundary(). Soft walls swing slowly and are tried for 20 of their periods if that is longer.
  [[nodiscard]] double boundary(double wall_damping, double softest, double stiffest, const WallTrial& trial,
                                double share = 2e-3) const;

 private:
  /// Without limit cycles: what the eigenvalues speak of.
  [[nodiscard]] bool is_linear(const WallTrial& trial) const noexcept {
    return device_.is_linear() && trial.push_n == 0.0;
  }

  SampledDevice device_;
  std::shared_ptr<const DeviceMotion> moves_;
};

}  // namespace kerf::bench

#pragma once

#include <vector>

#include "plot/plot.h"

namespace kerf::bench {

/// What a passivity controller costs a wall of some stiffness, on a device that renders 2 b / T passively.
struct ControlCost {
  double share = 0.0;  ///< stiffness over 2 b / T
  double stiffness_n_per_m = 0.0;
  bool holds_without = false;  ///< comes to rest under a leaning weight by itself
  bool holds_with = false;     ///< and with the controller
  /// Rendered force less the wall's own, along one motion (a tap of 2 mm at up to 0.19 m/s) with a perfect
  /// encoder: in newtons, and over what a hand can tell, the larger of 7 % of the force and 0.05 N.
  double rms_n = 0.0;
  double worst_n = 0.0;
  double rms_jnd = 0.0;
  double worst_jnd = 0.0;
  double worst_with_encoder_n = 0.0;  ///< along the same motion with the encoder and velocity of the device
};

struct ControlCosts {
  std::vector<ControlCost> rows;
  Chart picture;  ///< worst difference over stiffness, beside (K T / 2 - b) times the fastest speed
};

/// Walls from half to four times the passive stiffness of the handle of `sim:scissors`.
[[nodiscard]] ControlCosts control_costs();

}  // namespace kerf::bench

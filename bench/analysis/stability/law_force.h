#pragma once

#include <utility>

#include <kerf/models/law.h>

#include "stability/device/sampled_loop.h"

namespace kerf::bench {

/// A scalar law on an axis: travel into the tissue [m] is penetration times the lever, and the force on the
/// device is what the law resists with.
struct AxisLaw {
  models::Law law;
  double lever = 1.0;  ///< metres of travel per unit of penetration; 1 for a law over metres
};

/// An AxisLaw as the Force of a SampledLoop or of strokes.
class LawForce {
 public:
  LawForce(const AxisLaw& of, double period_s)
      : law_(of.law), state_(law_.initial_state()), per_lever_(1.0 / of.lever), period_s_(period_s) {}

  double operator()(const AxisReading& reading) noexcept {
    const models::Motion motion{.penetration = reading.position_m * per_lever_,
                                .velocity = reading.speed_m_s * per_lever_};
    return -law_.step(state_, motion, period_s_).force;
  }

 private:
  models::Law law_;
  models::Law::State state_;
  double per_lever_;
  double period_s_;
};

}  // namespace kerf::bench

#pragma once

#include <cstddef>

#include <kerf/models/law.h>

#include "stability/device/sampled_loop.h"
#include "stability/tool_way.h"

namespace kerf::bench {

/// A law along one line. Of a scalar one travel into the tissue [m] is penetration times the lever, and the
/// force on the device is what the law resists with; a law on several axes is met along its way.
struct AxisLaw {
  models::Law law;
  double lever = 1.0;  ///< metres of travel per unit of penetration; 1 for a law over metres
  ToolWay way = {};    ///< of a law on several axes
};

/// An AxisLaw as the Force of a SampledLoop or of strokes.
class LawForce {
 public:
  LawForce(const AxisLaw& of, double period_s)
      : law_(of.law),
        state_(law_.initial_state()),
        per_lever_(1.0 / of.lever),
        way_(of.way),
        spatial_(law_.is_spatial()),
        period_s_(period_s) {}

  double operator()(const AxisReading& reading) noexcept {
    if (spatial_) return along_the_way(reading);
    const models::Motion motion{.penetration = reading.position_m * per_lever_,
                                .velocity = reading.speed_m_s * per_lever_};
    return -law_.step(state_, motion, period_s_).force;
  }

  /// Energy that the law means to give back, after its last step.
  [[nodiscard]] double stored_j() const noexcept {
    const double stored = law_.stored_energy(state_);
    return spatial_ ? stored : stored / per_lever_;
  }

 private:
  double along_the_way(const AxisReading& reading) noexcept {
    models::SpatialMotion motion;
    for (std::size_t i = 0; i < models::max_law_axes; ++i) {
      motion.position[i] = way_.from[i] + way_.direction[i] * reading.position_m;
      motion.velocity[i] = way_.direction[i] * reading.speed_m_s;
    }
    const models::AxisValues force = law_.step(state_, motion, period_s_).force;
    double along = 0.0;
    for (std::size_t i = 0; i < models::max_law_axes; ++i) along += way_.force_share[i] * force[i];
    return along;
  }

  models::Law law_;
  models::Law::State state_;
  double per_lever_;
  ToolWay way_;
  bool spatial_;
  double period_s_;
};

}  // namespace kerf::bench

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"
#include "loop/passivity.h"

namespace kerf::bench {

/// Flags of a tick whose force is zero, whatever was computed.
inline constexpr std::uint32_t zero_force_flags =
    schema::flag_law_fault | schema::flag_device_fault | schema::flag_position_jump | schema::flag_watchdog;

struct SafetyOptions {
  double period_s = 1e-3;
  double soft_start_s = 0.25;      ///< ramp of the force at the start and after every zero force
  bool passivity_control = false;  ///< add damping where the rendering has given energy
};

/// Stands between a rendering and the hand: believes no reading that cannot be true, and lets no force
/// through that nobody vouches for.
///
/// A position or velocity that is not finite, or a position farther from the last one than hand and mechanism
/// can move, makes the force zero, and so does a law that fails, a number that is not finite, or a loop that
/// had stalled; and so does who asks for it. Zero comes at once (the slew limit is there to spare
/// the hand a jump, not to hold on to a bad force), and the force then comes back along the ramp of a soft
/// start. Every other command is kept within each axis' force and slew limit. A measured force that is not
/// finite is a gap in a measurement, not a fault: no law renders from it, and a sensor that pauses must not
/// take the force from the hand.
class Safety {
 public:
  Safety(const std::vector<drivers::AxisInfo>& axes, const SafetyOptions& options) noexcept
      : options_(options), count_(axes.size()), observer_(axes) {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      limit_[axis] = axes[axis].force_limit;
      step_limit_[axis] = axes[axis].slew_limit * options.period_s;
      speed_limit_[axis] = axes[axis].speed_limit;
      slack_[axis] = 2.0 * axes[axis].resolution;
    }
  }

  /// What is wrong with a reading, `elapsed_s` after the last one: flags, 0 if it may be rendered.
  [[nodiscard]] std::uint32_t judge(drivers::Status status, const drivers::Sample& sample,
                                    double elapsed_s) noexcept {
    since_reading_s_ += elapsed_s;
    if (status != drivers::Status::ok || !is_finite(sample)) return schema::flag_device_fault;
    const bool jumped = has_reading_ && is_jump(sample.position);
    if (jumped || !has_reading_) {
      observer_.restart(sample.position);
    } else {
      observer_.observe(held_, sample.position);
    }
    for (std::size_t axis = 0; axis < count_; ++axis) {
      travelled_[axis] =
          jumped || !has_reading_ ? 0.0 : (sample.position[axis] - last_position_[axis]) / since_reading_s_;
    }
    last_position_ = sample.position;
    since_reading_s_ = 0.0;
    has_reading_ = true;
    return jumped ? schema::flag_position_jump : 0U;
  }

  /// Makes of a command what the device is given at `time_s`.
  void apply(double time_s, Command& command) noexcept {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      if (!std::isfinite(command.force[axis])) command.flags |= schema::flag_law_fault;
    }
    if ((command.flags & zero_force_flags) != 0 || command.is_released) return release(time_s, command);
    if (options_.passivity_control && observer_.control(travelled_, options_.period_s, command.force)) {
      command.flags |= schema::flag_passivity_control;
    }
    const double ramp =
        options_.soft_start_s > 0.0 ? std::min(1.0, (time_s - ramp_start_s_) / options_.soft_start_s) : 1.0;
    if (ramp < 1.0) command.flags |= schema::flag_soft_start;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      const double wanted = ramp * command.force[axis];
      const double limited = std::clamp(wanted, -limit_[axis], limit_[axis]);
      const double slewed =
          std::clamp(limited, held_[axis] - step_limit_[axis], held_[axis] + step_limit_[axis]);
      if (limited != wanted) command.flags |= schema::flag_force_limited;
      if (slewed != limited) command.flags |= schema::flag_slew_limited;
      command.force[axis] = held_[axis] = slewed;
    }
  }

  /// Zero force now; what comes after it starts softly from there.
  void release(double time_s, Command& command) noexcept {
    command.force = held_ = {};
    ramp_start_s_ = time_s;
  }

  [[nodiscard]] const PassivityObserver& observer() const noexcept { return observer_; }

 private:
  [[nodiscard]] bool is_finite(const drivers::Sample& sample) const noexcept {
    bool finite = true;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      finite &= std::isfinite(sample.position[axis]) && std::isfinite(sample.velocity[axis]);
    }
    return finite;
  }

  /// Since the last reading that could be believed, at the speed limit and with two encoder steps to spare.
  [[nodiscard]] bool is_jump(const drivers::Axes& position) const noexcept {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      const double farthest = speed_limit_[axis] * since_reading_s_ + slack_[axis];
      if (speed_limit_[axis] > 0.0 && std::abs(position[axis] - last_position_[axis]) > farthest) return true;
    }
    return false;
  }

  SafetyOptions options_;
  std::size_t count_;
  PassivityObserver observer_;
  drivers::Axes limit_{};
  drivers::Axes step_limit_{};
  drivers::Axes speed_limit_{};
  drivers::Axes slack_{};
  drivers::Axes last_position_{};
  drivers::Axes
      travelled_{};  ///< speed since the reading before: that of a driver lags, and braking on it pushes
  drivers::Axes held_{};
  double since_reading_s_ = 0.0;
  double ramp_start_s_ = 0.0;
  bool has_reading_ = false;
};

}  // namespace kerf::bench

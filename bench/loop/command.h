#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

namespace kerf::bench {

/// What a tick computes: a force per axis, in the sense of the axis, and what happened on the way (schema
/// flags).
struct Command {
  drivers::Axes force{};
  std::uint32_t flags = 0;
};

/// Renders nothing: the device moves freely.
struct NoForce {
  [[nodiscard]] Command operator()(const drivers::Sample&, double) const noexcept { return {}; }
};

/// Renders a law on one axis of a device.
class LawRendering {
 public:
  LawRendering(models::Law law, const models::Contact& contact, std::size_t axis)
      : law_(std::move(law)), state_(law_.initial_state()), contact_(contact), axis_(axis) {}

  [[nodiscard]] Command operator()(const drivers::Sample& sample, double period_s) noexcept {
    const models::Motion motion = contact_.motion(sample.position[axis_], sample.velocity[axis_]);
    const models::Response response = law_.step(state_, motion, period_s);
    Command command;
    command.force[axis_] = -contact_.direction * response.force;
    if (response.fault) command.flags |= schema::flag_law_fault;
    return command;
  }

 private:
  models::Law law_;
  models::Law::State state_;
  models::Contact contact_;
  std::size_t axis_;
};

/// Whether every number that a device gave for its axes is finite.
[[nodiscard]] inline bool is_finite(const drivers::Sample& sample, std::size_t axes) noexcept {
  for (std::size_t axis = 0; axis < axes; ++axis) {
    if (!std::isfinite(sample.position[axis]) || !std::isfinite(sample.velocity[axis]) ||
        !std::isfinite(sample.force_measured[axis])) {
      return false;
    }
  }
  return true;
}

/// Keeps a command within what a device may do: a linear soft start, the limit of each axis, and its slew
/// limit. A fault of the law, or a number that is not finite, makes the whole command zero at once: the slew
/// limit is there to spare the hand a jump, not to hold on to a force that nobody vouches for.
class SafetyLimiter {
 public:
  SafetyLimiter(const std::vector<drivers::AxisInfo>& axes, double period_s, double soft_start_s) noexcept
      : count_(axes.size()), soft_start_s_(soft_start_s) {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      limit_[axis] = axes[axis].force_limit;
      step_limit_[axis] = axes[axis].slew_limit * period_s;
    }
  }

  void apply(double time_s, Command& command) noexcept {
    const double ramp = soft_start_s_ > 0.0 ? std::min(1.0, time_s / soft_start_s_) : 1.0;
    if (ramp < 1.0) command.flags |= schema::flag_soft_start;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      if (!std::isfinite(command.force[axis])) command.flags |= schema::flag_law_fault;
    }
    if ((command.flags & schema::flag_law_fault) != 0) {
      command.force = {};
      reset();
      return;
    }
    for (std::size_t axis = 0; axis < count_; ++axis) {
      const double wanted = ramp * command.force[axis];
      const double limited = std::clamp(wanted, -limit_[axis], limit_[axis]);
      const double slewed =
          std::clamp(limited, last_[axis] - step_limit_[axis], last_[axis] + step_limit_[axis]);
      if (limited != wanted) command.flags |= schema::flag_force_limited;
      if (slewed != limited) command.flags |= schema::flag_slew_limited;
      command.force[axis] = last_[axis] = slewed;
    }
  }

  /// The device was given zero force: the next command starts from there.
  void reset() noexcept { last_ = {}; }

 private:
  std::size_t count_;
  double soft_start_s_;
  drivers::Axes limit_{};
  drivers::Axes step_limit_{};
  drivers::Axes last_{};
};

/// Energy that the rendering has taken out of the hand, by the force held over each tick and the travel in it
/// (Hannaford and Ryu 2002). A rendering is passive while it never has given more than it took.
class PassivityObserver {
 public:
  explicit PassivityObserver(const std::vector<drivers::AxisInfo>& axes) noexcept : count_(axes.size()) {
    for (std::size_t axis = 0; axis < count_; ++axis) lever_[axis] = axes[axis].lever;
  }

  /// The force held since the last tick, and where it has brought the device.
  void observe(const drivers::Axes& held_force, const drivers::Axes& position) noexcept {
    for (std::size_t axis = 0; started_ && axis < count_; ++axis) {
      energy_j_ -= held_force[axis] * lever_[axis] * (position[axis] - last_[axis]);
    }
    last_ = position;
    started_ = true;
    least_j_ = std::min(least_j_, energy_j_);
  }

  [[nodiscard]] double energy_j() const noexcept { return energy_j_; }
  [[nodiscard]] double least_j() const noexcept { return least_j_; }

 private:
  std::size_t count_;
  drivers::Axes lever_{};
  drivers::Axes last_{};
  double energy_j_ = 0.0;
  double least_j_ = 0.0;
  bool started_ = false;
};

}  // namespace kerf::bench

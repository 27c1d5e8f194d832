#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
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
  bool is_released = false;  ///< somebody wants zero force now: Safety gives it past the slew limit
  /// By how much the energy grew since the step before that the rendering means to give back [J]; NaN: it
  /// does not say.
  double stored_change_j = std::numeric_limits<double>::quiet_NaN();
};

/// From one command towards another, softly:
///
///     F = (1 - r) F_old + r F_new,   r from 0 to 1
///
/// with the flags of both and soft_switch.
inline void blend_into(Command& command, const Command& coming, double share) noexcept {
  for (std::size_t axis = 0; axis < command.force.size(); ++axis) {
    command.force[axis] += share * (coming.force[axis] - command.force[axis]);
  }
  command.stored_change_j += share * (coming.stored_change_j - command.stored_change_j);
  command.flags |= coming.flags | schema::flag_soft_switch;
}

/// Renders nothing: the device moves freely.
struct NoForce {
  [[nodiscard]] Command operator()(const drivers::Sample&, double) const noexcept { return {}; }
};

/// Renders a law on the axes of a device: a scalar law on one of them, through its contact, a spatial law on
/// all that it has.
class LawRendering {
 public:
  /// Says nothing of what the law stores: that costs time, and only a passivity controller asks for it.
  static constexpr double tells_no_energy = std::numeric_limits<double>::quiet_NaN();

  /// `axes`: the device's axis for each axis of the law, or the one axis of a scalar law. `lever`: of that
  /// axis, if the command is to say by how much the law's store has grown.
  LawRendering(models::Law law, const models::Contact& contact, const std::vector<std::size_t>& axes,
               double lever = tells_no_energy)
      : law_(std::move(law)),
        state_(law_.initial_state()),
        contact_(contact),
        spatial_(law_.is_spatial()),
        energy_scale_(spatial_ && std::isfinite(lever) ? 1.0 : lever) {
    for (const std::size_t axis : axes) axis_.at(count_++) = axis;
  }

  /// At a drivers::Sample of the device, or at a models::SpatialMotion of its axes.
  template <typename Sample>
  [[nodiscard]] Command operator()(const Sample& sample, double period_s) noexcept {
    Command command = spatial_ ? in_space(sample.position, sample.velocity, period_s)
                               : along_axis(sample.position, sample.velocity, period_s);
    if (std::isfinite(energy_scale_)) {
      const double stored_j = energy_scale_ * law_.stored_energy(state_);
      command.stored_change_j = stored_j - std::exchange(stored_j_, stored_j);
    }
    return command;
  }

 private:
  [[nodiscard]] Command along_axis(const drivers::Axes& position, const drivers::Axes& velocity,
                                   double period_s) noexcept {
    const std::size_t axis = axis_[0];
    const models::Motion motion = contact_.motion(position[axis], velocity[axis]);
    const models::Response response = law_.step(state_, motion, period_s);
    Command command;
    command.force[axis] = contact_.force_on_axis(response.force);
    if (response.fault) command.flags |= schema::flag_law_fault;
    return command;
  }
  [[nodiscard]] Command in_space(const drivers::Axes& position, const drivers::Axes& velocity,
                                 double period_s) noexcept {
    models::SpatialMotion motion;
    for (std::size_t i = 0; i < count_; ++i) {
      motion.position[i] = position[axis_[i]];
      motion.velocity[i] = velocity[axis_[i]];
    }
    const models::SpatialResponse response = law_.step(state_, motion, period_s);
    Command command;
    for (std::size_t i = 0; i < count_; ++i) command.force[axis_[i]] = response.force[i];
    if (response.fault) command.flags |= schema::flag_law_fault;
    return command;
  }

  models::Law law_;
  models::Law::State state_;
  models::Contact contact_;
  bool spatial_;
  double energy_scale_;
  double stored_j_ = 0.0;
  std::array<std::size_t, models::max_law_axes> axis_{};
  std::size_t count_ = 0;
};

}  // namespace kerf::bench

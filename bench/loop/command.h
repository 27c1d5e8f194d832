#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

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

}  // namespace kerf::bench

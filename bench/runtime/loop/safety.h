#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"
#include "loop/passivity.h"
#include "loop/plausibility.h"

namespace kerf::bench {

/// Flags of a tick whose force is zero, whatever was computed.
inline constexpr std::uint32_t zero_force_flags = schema::flag_law_fault | schema::flag_device_fault |
                                                  schema::flag_position_jump | schema::flag_watchdog |
                                                  schema::flag_zero_held;

struct SafetyOptions {
  double period_s = 1e-3;
  double soft_start_s = 0.25;      ///< ramp of the force at the start and after every zero force
  bool passivity_control = false;  ///< add damping where the rendering has given energy
  /// Mass and friction of axes as they were measured, in place of what the driver knows.
  std::array<std::optional<drivers::Mechanics>, drivers::max_axes> measured{};
};

/// Zero force that is held after the position has jumped for good, until somebody says that the tool is where
/// it seems to be. Between the loop and any thread.
class ZeroHold {
 public:
  /// Says so: the force comes back along the soft start. Does nothing where no zero is held.
  void confirm() noexcept { confirmed_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool is_held() const noexcept { return held_.load(std::memory_order_relaxed); }
  /// Whether it was, up to the end of the loop.
  [[nodiscard]] bool was_held() const noexcept { return was_held_.load(std::memory_order_relaxed); }

  /// The loop's, once a tick: tells whether zero is held, and takes a confirmation.
  [[nodiscard]] bool exchange(bool held) noexcept {
    held_.store(held, std::memory_order_relaxed);
    if (held) was_held_.store(true, std::memory_order_relaxed);
    // A confirmation from before the jump confirms nothing.
    const bool confirmed = confirmed_.load(std::memory_order_relaxed);
    if (confirmed) confirmed_.store(false, std::memory_order_relaxed);
    return held && confirmed;
  }

 private:
  std::atomic<bool> held_{false};
  std::atomic<bool> was_held_{false};
  std::atomic<bool> confirmed_{false};
};

/// Stands between a rendering and the hand: believes no reading that cannot be true, and lets no force
/// through that nobody vouches for.
///
/// A position or velocity that is not finite, or a position to which hand and mechanism cannot have brought
/// the tool (Plausibility), makes the force zero, and so does a law that fails, a number that is not finite,
/// or a loop that had stalled; and so does who asks for it. Zero comes at once (the slew limit is there to
/// spare the hand a jump, not to hold on to a bad force), and the force then comes back along the ramp of a
/// soft start, which counts the ticks that were executed: no stall shortens it. After a jump from which the
/// position does not come back zero is held until somebody confirms, by the device's own button or by
/// confirm(). Every other command is kept within each axis' force and slew limit. A measured force that is
/// not finite is a gap in a measurement, not a fault: no law renders from it, and a sensor that pauses must
/// not take the force from the hand.
class Safety {
 public:
  Safety(const drivers::DeviceInfo& device, const SafetyOptions& options) noexcept
      : options_(options),
        count_(device.axes.size()),
        button_(device.button_channel),
        plausibility_(device),
        observer_(device.axes),
        controller_(device.axes, options.period_s) {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      limit_[axis] = device.axes[axis].force_limit;
      step_limit_[axis] = device.axes[axis].slew_limit * options.period_s;
      if (options.measured[axis]) controller_.know(axis, *options.measured[axis]);
    }
  }

  /// What is wrong with a reading, `elapsed_s` after the last one: flags, 0 if it may be rendered. `stalled`:
  /// the loop was silent for so long that nobody knows what the hand has felt since.
  [[nodiscard]] std::uint32_t judge(drivers::Status status, const drivers::Sample& sample, double elapsed_s,
                                    bool stalled = false) noexcept {
    since_reading_s_ += elapsed_s;
    std::uint32_t wrong = stalled ? schema::flag_watchdog : 0U;
    if (status != drivers::Status::ok || !is_finite(sample)) {
      plausibility_.pass(elapsed_s);
      wrong |= schema::flag_device_fault;
    } else {
      // When a reading that was late has ended is known to a period.
      const double within_s = elapsed_s > 1.5 * options_.period_s ? options_.period_s : 0.0;
      wrong |= flag_of(plausibility_.judge(sample, elapsed_s, within_s));
      note_button(sample);
    }
    if (wrong != 0) {
      let_go();
      return wrong;
    }
    observer_.observe(held_, sample.position);
    position_ = sample.position;
    return 0;
  }

  /// Makes of a command what the device is given.
  void apply(Command& command) noexcept {
    for (std::size_t axis = 0; axis < count_; ++axis) {
      if (!std::isfinite(command.force[axis])) command.flags |= schema::flag_law_fault;
    }
    if ((command.flags & zero_force_flags) != 0 || command.is_released) return release(command);
    const drivers::Axes rendered = command.force;
    const double ramp = options_.soft_start_s > 0.0 ? std::min(1.0, ramp_s_ / options_.soft_start_s) : 1.0;
    ramp_s_ += options_.period_s;
    if (ramp < 1.0) {
      command.flags |= schema::flag_soft_start;
      for (double& force : command.force) force *= ramp;
    }
    drivers::Axes undamped = command.force;
    if (options_.passivity_control) {
      controller_.observe(position_, since_reading_s_, command.stored_change_j);
      if (controller_.brake(command.force)) {
        command.flags |= schema::flag_passivity_control;
      }
    }
    since_reading_s_ = 0.0;
    for (std::size_t axis = 0; axis < count_; ++axis) {
      const double wanted = command.force[axis];
      const double limited = std::clamp(wanted, -limit_[axis], limit_[axis]);
      const double slewed =
          std::clamp(limited, held_[axis] - step_limit_[axis], held_[axis] + step_limit_[axis]);
      if (limited != wanted) command.flags |= schema::flag_force_limited;
      if (slewed != limited) command.flags |= schema::flag_slew_limited;
      undamped[axis] += slewed - wanted;
      command.force[axis] = held_[axis] = slewed;
    }
    controller_.hold(rendered, undamped, held_);
  }

  /// Zero force now; what comes after it starts softly from there.
  void release(Command& command) noexcept {
    command.force = {};
    let_go();
  }

  /// Zero is held after a jump, until confirm().
  [[nodiscard]] bool holds_zero() const noexcept { return holds_zero_; }
  /// Somebody says that the tool is where it seems to be: the force comes back along the ramp.
  void confirm() noexcept {
    if (!holds_zero_) return;
    holds_zero_ = false;
    plausibility_.confirm();
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

  [[nodiscard]] std::uint32_t flag_of(Trust trust) noexcept {
    if (trust == Trust::believed) return 0;
    holds_zero_ = trust == Trust::slipped;
    return trust == Trust::jumped ? schema::flag_position_jump : schema::flag_zero_held;
  }

  /// Pressed while zero is held, and not before it, the device's button confirms.
  void note_button(const drivers::Sample& sample) noexcept {
    const bool pressed = button_ && sample.channels[*button_] != 0.0;
    if (pressed && !was_pressed_) confirm();
    was_pressed_ = pressed;
  }

  /// What the hand has felt up to the next reading is no work of ours, and the force comes back from zero.
  void let_go() noexcept {
    held_ = {};
    ramp_s_ = options_.period_s;
    since_reading_s_ = 0.0;
    observer_.restart();
    controller_.restart();
  }

  SafetyOptions options_;
  std::size_t count_;
  std::optional<std::size_t> button_;
  Plausibility plausibility_;
  PassivityObserver observer_;
  PassivityController controller_;
  drivers::Axes limit_{};
  drivers::Axes step_limit_{};
  drivers::Axes position_{};
  drivers::Axes held_{};
  double since_reading_s_ = 0.0;
  double ramp_s_ = 0.0;  ///< how far along the ramp, in executed ticks
  bool holds_zero_ = false;
  bool was_pressed_ = false;
};

}  // namespace kerf::bench

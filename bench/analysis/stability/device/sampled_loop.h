#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "stability/device/free_motion.h"
#include "stability/device/sampled_device.h"

namespace kerf::bench {

/// What the encoder and its driver say of an axis at a tick.
struct AxisReading {
  double position_m = 0.0;
  double speed_m_s = 0.0;
};

/// Encoder and velocity filter of a SampledDevice.
class AxisSensor {
 public:
  explicit AxisSensor(const SampledDevice& device) noexcept
      : step_m_(device.encoder_step_m), per_period_(1.0 / device.period_s), gain_(device.velocity_gain()) {}

  [[nodiscard]] AxisReading read(double position_m) noexcept {
    const double read_m = step_m_ > 0.0 ? step_m_ * std::nearbyint(position_m / step_m_) : position_m;
    if (!started_) {
      last_m_ = read_m;
      started_ = true;
    }
    speed_m_s_ += gain_ * ((read_m - last_m_) * per_period_ - speed_m_s_);
    last_m_ = read_m;
    return {.position_m = read_m, .speed_m_s = speed_m_s_};
  }

 private:
  double step_m_;
  double per_period_;
  double gain_;
  double last_m_ = 0.0;
  double speed_m_s_ = 0.0;
  bool started_ = false;
};

/// Commands on their way to the motor: what was computed so many whole periods ago. However many: a delay
/// that is short at a device's own rate is long at the highest that is tried.
class CommandDelay {
 public:
  explicit CommandDelay(std::size_t ticks) : line_(ticks) {}

  /// Takes the command of this tick and returns the one that has arrived.
  [[nodiscard]] double pass(double force_n) noexcept {
    if (line_.empty()) return force_n;
    return std::exchange(line_[next_++ % line_.size()], force_n);
  }

 private:
  std::size_t next_ = 0;
  std::vector<double> line_;
};

/// A delay in whole periods and the share of one that is left.
struct SplitDelay {
  std::size_t ticks = 0;
  double share = 0.0;

  explicit SplitDelay(const SampledDevice& device) noexcept {
    const double periods = device.delay_s / device.period_s;
    ticks = static_cast<std::size_t>(periods + 1e-9);
    share = periods - static_cast<double>(ticks);
    if (share < 1e-9) share = 0.0;
  }
};

/// How a device in its hand moves within a period, until and after a late command arrives; made once a
/// device.
struct DeviceMotion {
  explicit DeviceMotion(const SampledDevice& device)
      : delay(device),
        before(device, delay.share * device.period_s),
        after(device, (1.0 - delay.share) * device.period_s) {}

  SplitDelay delay;
  FreeMotion before;
  FreeMotion after;
};

/// A device in a hand, closed over a rendering, in virtual time; exact between the ticks (FreeMotion).
///
/// `Force`: double(const AxisReading&) noexcept, the force on the device in a tick. A step allocates nothing.
/// The hand moves by `step(push, hand_place)`: a further force on the device, and where its spring rests.
template <typename Force>
class SampledLoop {
 public:
  SampledLoop(const SampledDevice& device, Force force, AxisMotion start)
      : SampledLoop(device, std::make_shared<const DeviceMotion>(device), std::move(force), start) {}
  SampledLoop(const SampledDevice& device, std::shared_ptr<const DeviceMotion> moves, Force force,
              AxisMotion start)
      : force_(std::move(force)),
        motion_(start),
        moves_(std::move(moves)),
        sensor_(device),
        line_(moves_->delay.ticks) {}

  /// One period: read, compute, hold.
  void step(double push_n = 0.0, double hand_position_m = 0.0) noexcept {
    const double arrived = line_.pass(force_(sensor_.read(motion_.position_m)));
    AxisMotion at{.position_m = motion_.position_m - hand_position_m, .speed_m_s = motion_.speed_m_s};
    if (moves_->delay.share > 0.0) at = moves_->before.after(at, held_n_ + push_n);
    held_n_ = arrived;
    at = moves_->after.after(at, held_n_ + push_n);
    motion_ = {.position_m = at.position_m + hand_position_m, .speed_m_s = at.speed_m_s};
  }

  [[nodiscard]] const AxisMotion& motion() const noexcept { return motion_; }
  /// What the motor holds at the end of the period.
  [[nodiscard]] double held_n() const noexcept { return held_n_; }
  [[nodiscard]] Force& force() noexcept { return force_; }

 private:
  Force force_;
  AxisMotion motion_;
  std::shared_ptr<const DeviceMotion> moves_;
  AxisSensor sensor_;
  CommandDelay line_;
  double held_n_ = 0.0;
};

}  // namespace kerf::bench

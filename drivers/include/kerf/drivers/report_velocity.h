#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <kerf/drivers/device.h>
#include <kerf/drivers/velocity_filter.h>

namespace kerf::drivers {

/// Velocity from the reports of a device, over the times at which they arrived and not over those of the
/// ticks that read them.
///
/// A position that the motion so far cannot have reached, because a bit of its report was turned, is left
/// out: with x and v the last position and the last difference, dt the time between the reports, a and j the
/// acceleration and the jitter that the device tells and r the step of its encoder, one with
///
///     |x' - (x + v dt)| > a dt^2 + |v| j + 4 r
///
/// on some axis that tells its acceleration. Two in a row that agree with each other are where it is; then
/// the difference goes on from there.
class ReportVelocity {
 public:
  explicit ReportVelocity(std::size_t axes) noexcept : axes_(axes) {}

  /// Takes the report that arrived at `at_ns`, once.
  void update(const Axes& position, std::int64_t at_ns, const DeviceInfo& info) noexcept {
    if (at_ns <= last_ns_) return;
    const double elapsed_s = 1e-9 * static_cast<double>(at_ns - last_ns_);
    const bool first = last_ns_ == 0;
    if (!first && !follows(position, position_, elapsed_s, info)) {
      const bool agrees =
          doubted_ && follows(position, doubt_, 1e-9 * static_cast<double>(at_ns - doubt_ns_), info);
      doubted_ = true;
      doubt_ = position;
      doubt_ns_ = at_ns;
      if (!agrees) return;
      for (std::size_t axis = 0; axis < axes_; ++axis) filter_.restart(axis, position[axis]);
      difference_ = {};
      filter_.advance(seconds_at(at_ns));
    } else {
      if (first) first_ns_ = at_ns;
      for (std::size_t axis = 0; axis < axes_; ++axis) {
        if (!first) difference_[axis] = (position[axis] - position_[axis]) / elapsed_s;
        (void)filter_.update(axis, position[axis], seconds_at(at_ns));
      }
      filter_.advance(seconds_at(at_ns));
    }
    doubted_ = false;
    position_ = position;
    last_ns_ = at_ns;
  }
  [[nodiscard]] double velocity(std::size_t axis) const noexcept { return filter_.velocity(axis); }

 private:
  [[nodiscard]] bool follows(const Axes& position, const Axes& from, double elapsed_s,
                             const DeviceInfo& info) const noexcept {
    for (std::size_t axis = 0; axis < axes_; ++axis) {
      const AxisInfo& known = info.axes[axis];
      if (known.acceleration_limit <= 0.0) continue;
      const double v = difference_[axis];
      const double most = known.acceleration_limit * elapsed_s * elapsed_s +
                          std::abs(v) * info.report_jitter_s + 4.0 * known.resolution;
      if (!(std::abs(position[axis] - from[axis] - v * elapsed_s) <= most)) return false;
    }
    return true;
  }
  [[nodiscard]] double seconds_at(std::int64_t at_ns) const noexcept {
    return 1e-9 * static_cast<double>(at_ns - first_ns_);
  }

  std::size_t axes_;
  VelocityFilter filter_;
  Axes position_{};
  Axes difference_{};
  Axes doubt_{};
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t doubt_ns_ = 0;
  bool doubted_ = false;
};

}  // namespace kerf::drivers

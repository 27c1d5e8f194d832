#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <kerf/schema/recorded_rows.h>
#include <kerf/schema/recording.h>

#include "signal/blocked_values.h"
#include "signal/smoothed_values.h"

namespace kerf::bench {

/// One axis of a recording, low-passed with zero phase, as cycles are found and averaged in it; the position
/// counts positive in the direction of closing. Goes through the rows block by block.
class AxisMotion {
 public:
  /// The corner is at most a fifth of the rate. The rows stay where they are.
  /// @throws std::invalid_argument for a value that is not finite or a time that goes back, saying which.
  AxisMotion(const schema::RecordedRows& rows, std::size_t axis, double corner_hz);
  AxisMotion(const AxisMotion&) = delete;
  AxisMotion& operator=(const AxisMotion&) = delete;
  ~AxisMotion() = default;

  void close_along(double direction) noexcept { direction_ = direction; }
  [[nodiscard]] double corner_hz() const noexcept { return corner_hz_; }
  [[nodiscard]] std::uint64_t rows() const noexcept { return smooth_position_.size(); }
  [[nodiscard]] double position(std::uint64_t row) const { return direction_ * smooth_position_[row]; }
  [[nodiscard]] double recorded_position(std::uint64_t row) const { return direction_ * position_[row]; }
  /// Of a sensor as it resists, else the commanded one along the axis.
  [[nodiscard]] double force(std::uint64_t row) const { return smooth_force_[row]; }
  [[nodiscard]] bool has_measured_force() const noexcept { return is_measured_; }

 private:
  BlockedValues time_s_;
  BlockedValues position_;
  BlockedValues force_;
  UniformTimes grid_;
  double corner_hz_;
  bool is_measured_;
  SmoothedValues smooth_position_;
  SmoothedValues smooth_force_;
  double direction_ = 1.0;
};

/// Makes the branches of cycles anew from their phases: forces of each closing and each opening on the grid,
/// and their means. The motion closes along the direction of the cycles.
void average_branches(schema::Cycles& cycles, const AxisMotion& motion);

}  // namespace kerf::bench

#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/force_health.h>
#include <kerf/drivers/scan_clock.h>
#include <kerf/drivers/streamed_force.h>

namespace kerf::drivers {

/// One reading of a force sensor as it came off the wire.
struct ForceFrame {
  std::int64_t arrived_ns = 0;  ///< on the host's clock
  /// From the last frame's count to this one's: 1 is the next, 3 that two are missing, 0 that it is the same
  /// again, less that it comes too late. Of the first frame, and of one that begins a count anew, it says
  /// nothing.
  std::int64_t step = 1;
  bool begins_anew = false;  ///< its count does not go on from the last one's
  Axes wrench{};             ///< N, N·m
  std::array<double, StreamedForce::max_extras - 1> extras{};
  ForceHealth health = ForceHealth::sound;
  bool stands = false;  ///< it is the last measurement once more, under a new count
};

/// Puts the frames of a force sensor in order on the host's clock, counts what is wrong with them, and hands
/// them to the tick. One thread takes; figures() is for any.
///
/// Numbers grow with every frame and jump where frames were lost. Where a count begins anew, as after a
/// restart, they go on by as many as the clock says were missed. A frame that comes twice or too late is
/// dropped. A wrench that the sensor doubts, or a measurement that stands, is none.
class ForceIntake {
 public:
  /// @param extras how many a frame has; before them the tick is told how many frames have been lost so far.
  explicit ForceIntake(std::size_t extras) noexcept : force_(1 + extras) {}

  /// From now on frames go to the tick; before, they are counted alone.
  void begin(double rate_hz) noexcept;
  void take(const ForceFrame& frame) noexcept;
  /// Something arrived that is no frame: another size, a wrong sum.
  void take_wrong() noexcept;

  [[nodiscard]] StreamedForce& force() noexcept { return force_; }
  /// Nothing will come any more.
  [[nodiscard]] bool ended() const noexcept { return force_.lost(); }
  [[nodiscard]] std::uint64_t frames() const noexcept { return frames_; }
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }
  [[nodiscard]] std::uint64_t wrong_in_a_row() const noexcept { return wrong_in_a_row_; }
  [[nodiscard]] std::int64_t last_ns() const noexcept { return last_ns_; }
  [[nodiscard]] ForceHealth last_health() const noexcept { return last_health_; }

  /// frame_rate, frames, frames_lost, duplicates, out_of_order, wrong_frames, overloads, sensor_errors,
  /// standing_frames, restarts, and once there are four blocks of ScanClock clock_drift, clock_drift_error.
  [[nodiscard]] std::vector<Figure> figures() const;

 private:
  using Count = std::atomic<std::uint64_t>;
  [[nodiscard]] bool number(const ForceFrame& frame) noexcept;

  std::optional<ScanClock> clock_;  ///< once the rate is known
  double rate_hz_ = 0.0;
  std::uint64_t number_ = 0;  ///< of the last frame
  std::uint64_t wrong_in_a_row_ = 0;
  ForceHealth last_health_ = ForceHealth::sound;

  StreamedForce force_;
  Count frames_{0};
  Count lost_{0};
  Count duplicates_{0};
  Count out_of_order_{0};
  Count wrong_{0};
  Count overloads_{0};
  Count errors_{0};
  Count standing_{0};
  Count restarts_{0};
  std::atomic<std::int64_t> first_ns_{0};
  std::atomic<std::int64_t> last_ns_{0};
  std::atomic<double> drift_ppm_{0.0};
  std::atomic<double> drift_error_ppm_{std::numeric_limits<double>::infinity()};
};

}  // namespace kerf::drivers

#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/drivers/triple_buffer.h>

namespace kerf::drivers {

/// What the tick sees of a force sensor that streams by a clock of its own. One thread puts readings, another
/// reads them once a tick; neither waits for the other.
///
/// The wrench of a tick at t, whose readings w_i were taken at t_i:
///
///     latest         w_n, the newest
///     interpolated   w_i + (w_i+1 - w_i) (t - d - t_i) / (t_i+1 - t_i),   t_i <= t - d < t_i+1
///
/// d is the delay that buys the second; where the newest was taken before t - d it is the newest, and its age
/// says so. `force_age` is t less the moment that the wrench belongs to.
class StreamedForce {
 public:
  static constexpr std::size_t max_extras = 9;
  enum class Rule : std::uint8_t { latest, interpolated };

  struct Reading {
    Axes wrench{};
    std::array<double, max_extras> extras{};  ///< further channels of the sensor
    std::uint64_t number = 0;                 ///< jumps where readings were lost
    std::int64_t taken_ns = 0;                ///< on the host's clock
    bool sound = true;                        ///< false: the sensor itself says that the wrench is none
  };

  /// By the rule `latest`. @param extras how many of them are channels
  explicit StreamedForce(std::size_t extras = 0) noexcept;
  /// Before anybody reads. @param delay_s d, of the rule `interpolated`
  void resample(Rule rule, double delay_s) noexcept;

  // Of the thread that has the stream.
  void put(const Reading& reading) noexcept;
  /// Nothing will come any more: every read from now on is Status::lost.
  void lose() noexcept { lost_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

  /// The tick's. Fills in force_measured, the channels `force_age` [s], `force_scan`, and the extras. Without
  /// a sound reading of the last 20 ms the force is NaN and the answer Status::fault; after a second without
  /// any it is Status::lost.
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept;
  /// Of a sensor, which has no motors: any finite force is taken, and none is exerted.
  [[nodiscard]] Status write(const Axes& force) const noexcept;

 private:
  static constexpr std::size_t kept = 16;
  struct Window {
    std::array<Reading, kept> last{};  ///< a ring
    std::size_t count = 0;             ///< put so far
    [[nodiscard]] const Reading& before(std::size_t newest) const noexcept {
      return last[(count - 1 - newest) % kept];
    }
  };
  [[nodiscard]] Reading at(std::int64_t wanted_ns) const noexcept;

  std::size_t extras_;
  Rule rule_ = Rule::latest;
  std::int64_t delay_ns_ = 0;

  Window window_;  ///< of the thread that puts
  TripleBuffer<Window> shared_;
  std::atomic<bool> lost_{false};

  // Of the tick.
  Window seen_;
  std::int64_t opened_ns_;
  std::int64_t loop_start_ns_ = std::numeric_limits<std::int64_t>::max();
};

/// The axes of a six-axis force/torque sensor, x to rz, which do not move.
[[nodiscard]] std::vector<AxisInfo> sensor_axes();

}  // namespace kerf::drivers

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace kerf::drivers {

/// When on the host's clock a device took a scan, by a clock of its own:
///
///     t_host(n) = a + b n,   arrival(n) = t_host(n) + delay,   delay >= 0
///
/// n: number of the scan; b: the device's period on the host's clock [s]. A delay only ever adds, so the line
/// lies below all arrivals, as high as it can. Of each block of a quarter of a second the scan that came
/// least late is kept, for 256 blocks (64 s); of all lines below them the one with the least sum of distances
/// is an edge of their lower convex hull, the one above their mean number. A packet that came late, or a
/// whole second of them, does not move it. Source of the criterion: [Moon1999].
///
/// For the first second the period is taken for the nominal one, or that from before a restart.
///
/// The least delay of all cannot be told from a clock that stands earlier: times are late by it. Constant
/// size, no allocation; one thread adds and asks.
class ScanClock {
 public:
  /// No crystal is off by more.
  static constexpr double crystal = 500e-6;

  /// @param nominal_period_s b as the device was told
  /// @param most_drift by which share of it b may be off, either way
  explicit ScanClock(double nominal_period_s, double most_drift = crystal) noexcept;

  /// A scan has arrived. Numbers must grow.
  void add(std::uint64_t scan, std::int64_t arrived_ns) noexcept;
  /// The device's scans begin anew, at another phase; its clock is still the same.
  void restart() noexcept;

  /// On the host's clock, in its nanoseconds. Not later than any arrival so far says.
  [[nodiscard]] std::int64_t time_ns(std::uint64_t scan) const noexcept;
  /// By how much the device's millisecond is longer than the host's: (b / nominal - 1) 1e6 [ppm]; at most
  /// `most_drift` either way.
  [[nodiscard]] double drift_ppm() const noexcept { return 1e6 * slope_; }
  /// What the drift may be off by: the slope by which the line would turn if each end rose or fell by the
  /// median distance of the kept scans above it. Infinite before there are four blocks.
  [[nodiscard]] double drift_error_ppm() const noexcept { return 1e6 * slope_error_; }

 private:
  static constexpr std::size_t max_blocks = 256;
  /// On the host's clock from the first scan, with the nominal period taken out.
  struct Point {
    double nominal_s = 0.0;
    double late_s = 0.0;
  };
  [[nodiscard]] Point point_of(std::uint64_t scan, std::int64_t arrived_ns) const noexcept;
  [[nodiscard]] double above_line(const Point& point) const noexcept {
    return point.late_s - offset_s_ - slope_ * point.nominal_s;
  }
  [[nodiscard]] const Point& kept(std::size_t at) const noexcept {
    return blocks_[(first_block_ + at) % max_blocks];
  }
  void end_block() noexcept;
  void fit_line() noexcept;

  double period_s_;
  double most_drift_;
  std::uint64_t block_scans_;
  std::uint64_t first_scan_ = 0;
  std::int64_t first_ns_ = 0;
  bool started_ = false;
  double offset_s_ = 0.0;
  double slope_ = 0.0;
  double slope_error_ = std::numeric_limits<double>::infinity();
  std::uint64_t block_ = 0;  ///< number of the block that is being filled
  Point least_;              ///< of that block
  bool has_least_ = false;
  std::array<Point, max_blocks> blocks_{};
  std::size_t first_block_ = 0;
  std::size_t block_count_ = 0;
};

}  // namespace kerf::drivers

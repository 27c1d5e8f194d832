#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "laws/sampled_motion.h"
#include "loop/clock.h"
#include "loop/command.h"

namespace kerf::bench {

/// A law as the loop renders it, and the motion that it is shown, which must outlive the measurement.
struct TimedLaw {
  LawRendering rendering;
  const SampledMotion* path = nullptr;
};

/// A time stamp in units of its own, before which all is done and after which nothing has begun.
[[nodiscard]] std::uint64_t stamp() noexcept;

/// Length of a stamp's unit [ns], from two moments of both clocks.
class StampRate {
 public:
  [[nodiscard]] double unit_ns() const;

 private:
  std::int64_t first_ns_ = WallClock::now_ns();
  std::uint64_t first_stamp_ = stamp();
};

/// The smallest step that the stamps make: some processors count in units and tick in tens of them.
[[nodiscard]] std::uint64_t smallest_step();

/// The median, finer than the step of the stamps. A duration between two steps is measured as one or the
/// other as often as it is nearer to it, so that the mean of those around the median is right.
[[nodiscard]] double fine_median(const std::vector<double>& durations, std::uint64_t step);

/// How long before and after a tick with a force ticks without one belong to it.
inline constexpr double about_a_push_s = 0.01;

/// Which ticks are counted, in order: those on which the law pushes, and those within about_a_push_s of one.
/// Without a force are also the ticks on which something ruptures, breaks or is split, and these may be the
/// dearest of all; the tool in free air is none of them. All, if the law never pushes.
[[nodiscard]] std::vector<std::size_t> counted_ticks(std::span<const std::uint8_t> pushes,
                                                     std::span<const double> period_s);

/// A law on its way along its path, tick by tick from a fresh state, with all the memory that this takes.
class TimedTicks {
 public:
  /// @throws std::invalid_argument for an empty path or a period that is not positive.
  explicit TimedTicks(const TimedLaw& timed);

  [[nodiscard]] std::size_t ticks() const noexcept { return path_->ticks(); }
  /// The ticks that are counted (counted_ticks()), by a passage along the path.
  [[nodiscard]] const std::vector<std::size_t>& counted() const noexcept { return counted_; }

  void restart() noexcept { rendering_ = *fresh_; }
  void step(std::size_t i) noexcept { (void)rendering_(path_->sample[i], path_->period_s[i]); }
  /// Steps between two stamps; how long it took, in their unit.
  [[nodiscard]] std::uint64_t time(std::size_t i) noexcept;

 private:
  LawRendering rendering_;
  const LawRendering* fresh_;
  const SampledMotion* path_;
  std::vector<std::size_t> counted_;
  volatile double kept_ = 0.0;  ///< so that no step is left out
};

}  // namespace kerf::bench

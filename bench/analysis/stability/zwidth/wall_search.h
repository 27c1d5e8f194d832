#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/fitting/jnd.h>

#include "loop/command.h"
#include "stability/controllers/wall_controller.h"
#include "stability/zwidth/cycle_detector.h"

namespace kerf::bench {

/// How the stiffest wall is looked for at each damping of a ladder.
///
/// A trial: the wall F = -K x - B v stands beside where the axis is, on both sides of it, so that it begins
/// with a push of `strike_n`; after `shortest_s` the last window of the rendered force is judged. The wall
/// held if no oscillation is significant there (CycleDetector) or it is below what is felt. Otherwise the
/// trial goes on, twice as long each time, and is judged again: it failed if the oscillation grew by a
/// quarter since, or the force passed `stop_n`; at the longest it held only if it fell to `lasts` since it
/// was judged before. Between trials a wall of the softest stiffness without damping brings the axis back to
/// where it began.
///
/// A stiffness holds if all of its `repeats` did, struck hard and softly, from both
/// sides, by turns, the wall each time at another place within a step of the encoder. From the softest (or a
/// quarter of what the damping before came to) it is doubled until one fails, then the ratio is halved until
/// it is within `resolution`. The stiffness that failed is then struck softly alone: where that holds, the
/// boundary has a hysteresis, and what is told is its lower edge.
struct WallSearchOptions {
  std::vector<double> damping_n_s_per_m{0.0};  ///< the ladder, upwards
  double softest_n_per_m = 50.0;
  double stiffest_n_per_m = 20'000.0;
  double resolution = 0.02;  ///< as a share
  std::size_t repeats = 4;
  double felt_n = fitting::force_jnd.threshold;  ///< rms; a limit cycle below it counts as none
  double false_alarms = 1e-3;                    ///< of a trial in which nothing oscillates
  double strike_n = 1.0;
  double soft_strike = 0.2;  ///< as a share
  double stop_n = 0.0;       ///< 0: 0.8 of the axis' force limit
  double rest_s = 0.5;
  double window_s = 1.0;
  double shortest_s = 3.0;
  int extensions = 2;
  double grows = 1.25;
  double lasts = 0.9;
  double lowest_hz = 5.0;       ///< slower is what a hand does
  ControllerDesign controller;  ///< that renders the walls; its device is of no account for `none`
};

/// @throws std::invalid_argument naming what is out of range.
void check(const WallSearchOptions& options, double period_s);

enum class SearchEnd : std::uint8_t { found, holds_throughout, holds_nowhere, not_finished };
/// "found", "holds throughout", ...
[[nodiscard]] std::string_view name_of(SearchEnd end) noexcept;

/// What one damping came to.
struct WallRung {
  double damping_n_s_per_m = 0.0;
  SearchEnd end = SearchEnd::not_finished;
  double held_n_per_m = 0.0;    ///< the stiffest that held; 0: none
  double failed_n_per_m = 0.0;  ///< the softest that failed; 0: none
  std::size_t trials = 0;
  std::size_t disturbed = 0;  ///< trials that were made anew: deadlines were missed in them
  bool hysteresis = false;    ///< what failed holds if it is struck softly
  double cycle_n = 0.0;       ///< rms of the force that failed; 0 where it passed the stop
  double cycle_hz = 0.0;      ///< likewise
  /// Between what held and what failed; the end of the search where it was not found.
  [[nodiscard]] double boundary() const noexcept;
};

/// The search as what a loop renders: a step a tick. It allocates nothing but at its construction.
class WallSearch {
 public:
  /// @throws std::invalid_argument as check().
  WallSearch(const drivers::AxisInfo& axis, std::size_t number, double period_s,
             const WallSearchOptions& options);

  [[nodiscard]] Command step(const drivers::Sample& sample, double elapsed_s) noexcept;
  [[nodiscard]] bool finished() const noexcept { return rung_ == rungs_.size(); }
  /// With what was left to the axis.
  [[nodiscard]] const WallSearchOptions& options() const noexcept { return options_; }
  [[nodiscard]] const std::vector<WallRung>& rungs() const noexcept { return rungs_; }
  /// After which it has finished at the latest.
  [[nodiscard]] std::uint64_t max_ticks() const noexcept;

 private:
  enum class Outcome : std::uint8_t { undecided, held, failed };

  void begin_rung() noexcept;
  void begin_trial(double position_m) noexcept;
  void end_trial(bool held) noexcept;
  void conclude(bool held) noexcept;
  void end_rung(SearchEnd end) noexcept;
  [[nodiscard]] Outcome judge() noexcept;
  [[nodiscard]] double strike() const noexcept;
  [[nodiscard]] double within_a_step() const noexcept;
  [[nodiscard]] std::size_t ticks_of(double seconds) const noexcept;

  WallSearchOptions options_;
  std::size_t axis_;
  double lever_;
  double encoder_step_m_;
  double period_s_;
  ControlledWall wall_;
  CycleDetector before_, last_;  ///< the window that was judged before, and the last
  std::vector<WallRung> rungs_;
  std::size_t rung_ = 0;
  bool started_ = false;
  bool resting_ = true;
  bool confirming_ = false;  ///< what failed is struck softly
  bool is_disturbed_ = false;
  double origin_m_ = 0.0;
  double place_m_ = 0.0;  ///< of the wall
  double stiffness_ = 0.0;
  std::size_t repeat_ = 0;
  std::size_t tick_ = 0;
  std::size_t look_tick_ = 0;  ///< when the trial is judged next
  int extended_ = 0;
  FoundCycle found_;
};

}  // namespace kerf::bench

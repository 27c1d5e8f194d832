#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"

namespace kerf::bench {

/// One stretch of an experiment: the axis is brought to a place, and an excitation is played there.
struct PlannedStretch {
  double centre_m = 0.0;           ///< where, in travel
  std::size_t settle_ticks = 600;  ///< to bring it there
  std::size_t periods = 3;
  std::size_t place = 0;
  bool validates = false;
  std::vector<double> force_n;  ///< of one period
};

/// What is played on one axis, and when it ends early.
struct ExcitationPlan {
  std::size_t axis = 0;
  double lever = 1.0;
  std::vector<PlannedStretch> stretches;
  double centring_n_per_m = 0.0;  ///< of the spring that keeps it there, which no friction of its own has
  double bias_n = 0.0;            ///< that holds it at first, as far as that is known
  double force_limit_n = 0.0;     ///< of excitation, spring and bias together
  double travel_m = 0.02;         ///< farther from its place than that ends everything
  double lower_m = -1.0;          ///< nearer to its stops than a hundredth of the range, too
  double upper_m = 1.0;
  double enough_travel_m = 0.0;  ///< a motion as wide as that in a period is enough; 0: never
};

/// Why an experiment ended before its time.
enum class ExperimentEnd : std::uint8_t { complete, enough, too_far, at_stop, fault, stopped };
[[nodiscard]] std::string in_words(ExperimentEnd end);

/// Plays a plan: brings the axis to a place by a spring whose force creeps up to what holds it there, keeps
/// that force, plays the periods, and goes on with the next. The first tick whose force Safety took ends it,
/// with zero force; so do a stop, and a motion that goes too far, as where a hand pushes. After the
/// constructor nothing allocates, locks or throws.
class ExcitationRendering {
 public:
  ExcitationRendering(ExcitationPlan plan, double period_s);

  [[nodiscard]] Command step(const drivers::Sample& sample, double elapsed_s) noexcept;
  /// What became of the tick.
  void see(const schema::Row& row) noexcept;
  [[nodiscard]] bool finished() const noexcept { return finished_; }
  [[nodiscard]] ExperimentEnd end() const noexcept { return end_; }
  [[nodiscard]] std::uint32_t fault_flags() const noexcept { return fault_flags_; }
  [[nodiscard]] std::size_t longest_ticks() const noexcept;

  /// Of every tick so far, in the order of the ticks; without a row, the last value stands and the position
  /// is NaN.
  struct Ticks {
    std::vector<double> position_m, speed_m_s, commanded_n, excitation_n, sensor_n;
  };
  [[nodiscard]] const Ticks& ticks() const noexcept { return ticks_; }
  /// The tick at which the first period of each stretch began; of those that were begun.
  [[nodiscard]] const std::vector<std::size_t>& begins() const noexcept { return begins_; }

 private:
  void finish(ExperimentEnd end) noexcept;
  [[nodiscard]] double playing(double offset_m) noexcept;

  ExcitationPlan plan_;
  double period_s_;
  std::size_t stretch_ = 0;
  std::size_t tick_ = 0;  ///< of the stretch
  double from_m_ = 0.0;   ///< where it was when it was begun
  double bias_n_ = 0.0;
  double lowest_m_ = 0.0;
  double highest_m_ = 0.0;
  double excitation_now_n_ = 0.0;
  bool begun_ = false;
  bool begins_now_ = false;
  bool finished_ = false;
  ExperimentEnd end_ = ExperimentEnd::complete;
  std::uint32_t fault_flags_ = 0;
  Ticks ticks_;
  std::vector<std::size_t> begins_;
};

}  // namespace kerf::bench

#include "identify/excitation_rendering.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "loop/safety.h"

namespace kerf::bench {
namespace {

constexpr double creeps_per_s = 1.5;  // of the spring's force that a second adds to the bias
constexpr double stop_share = 0.01;   // of the range that is kept clear at its ends

}  // namespace

std::string in_words(ExperimentEnd end) {
  switch (end) {
    case ExperimentEnd::complete:
      return "it is complete";
    case ExperimentEnd::enough:
      return "it has moved enough";
    case ExperimentEnd::too_far:
      return "it went farther than --travel: something pushes it, or its motor pulls the other way";
    case ExperimentEnd::at_stop:
      return "it came to its stop; hold it nearer to the middle, or give less --travel";
    case ExperimentEnd::fault:
      return "a fault took the force";
    case ExperimentEnd::stopped:
      break;
  }
  return "it was stopped";
}

ExcitationRendering::ExcitationRendering(ExcitationPlan plan, double period_s)
    : plan_(std::move(plan)),
      period_s_(period_s),
      bias_n_(std::clamp(plan_.bias_n, -plan_.force_limit_n, plan_.force_limit_n)) {
  const std::size_t longest = longest_ticks() + 1024;
  for (auto* const column :
       {&ticks_.position_m, &ticks_.speed_m_s, &ticks_.commanded_n, &ticks_.excitation_n, &ticks_.sensor_n}) {
    column->reserve(longest);
  }
  begins_.reserve(plan_.stretches.size());
  finished_ = plan_.stretches.empty();
}

std::size_t ExcitationRendering::longest_ticks() const noexcept {
  std::size_t sum = 0;
  for (const PlannedStretch& stretch : plan_.stretches) {
    sum += stretch.settle_ticks + stretch.periods * stretch.force_n.size();
  }
  return sum;
}

void ExcitationRendering::finish(ExperimentEnd end) noexcept {
  finished_ = true;
  end_ = end;
}

/// The force of the excitation, after the axis was brought to its place.
double ExcitationRendering::playing(double offset_m) noexcept {
  const PlannedStretch& stretch = plan_.stretches[stretch_];
  const std::size_t played = tick_ - stretch.settle_ticks;
  if (played == 0) {
    begins_now_ = true;
    lowest_m_ = highest_m_ = offset_m;
  }
  lowest_m_ = std::min(lowest_m_, offset_m);
  highest_m_ = std::max(highest_m_, offset_m);
  // A part of a period says less of the axis than all of it: it goes on as long as the motion allows it.
  const double travel_m = highest_m_ - lowest_m_;
  const bool is_whole = played + 1 == stretch.periods * stretch.force_n.size();
  if (plan_.enough_travel_m > 0.0 && travel_m > plan_.enough_travel_m &&
      (is_whole || (travel_m > 2.0 * plan_.enough_travel_m && played > stretch.force_n.size() / 4))) {
    finish(ExperimentEnd::enough);
  }
  return stretch.force_n[played % stretch.force_n.size()];
}

Command ExcitationRendering::step(const drivers::Sample& sample, double /*elapsed_s*/) noexcept {
  excitation_now_n_ = 0.0;
  Command command;
  if (finished_) return command;
  const PlannedStretch& stretch = plan_.stretches[stretch_];
  const double position_m = plan_.lever * sample.position[plan_.axis];
  if (!begun_) {
    begun_ = true;
    from_m_ = position_m;
  }
  const double clear_m = stop_share * (plan_.upper_m - plan_.lower_m);
  if (position_m < plan_.lower_m + clear_m || position_m > plan_.upper_m - clear_m) {
    finish(ExperimentEnd::at_stop);
    return command;
  }
  const double settled =
      std::min(1.0, 2.0 * static_cast<double>(tick_) / static_cast<double>(stretch.settle_ticks));
  const double smooth = settled * settled * (3.0 - 2.0 * settled);
  const double offset_m = position_m - (from_m_ + smooth * (stretch.centre_m - from_m_));
  const double spring_n = -plan_.centring_n_per_m * offset_m;
  if (tick_ < stretch.settle_ticks) {
    bias_n_ =
        std::clamp(bias_n_ + creeps_per_s * period_s_ * spring_n, -plan_.force_limit_n, plan_.force_limit_n);
  } else {
    if (std::abs(offset_m) > plan_.travel_m) {
      finish(ExperimentEnd::too_far);
      return command;
    }
    excitation_now_n_ = playing(offset_m);
    if (finished_) return command;
  }
  command.force[plan_.axis] =
      std::clamp(bias_n_ + spring_n + excitation_now_n_, -plan_.force_limit_n, plan_.force_limit_n);
  if (++tick_ == stretch.settle_ticks + stretch.periods * stretch.force_n.size()) {
    tick_ = 0;
    from_m_ = stretch.centre_m;
    if (++stretch_ == plan_.stretches.size()) finish(ExperimentEnd::complete);
  }
  return command;
}

void ExcitationRendering::see(const schema::Row& row) noexcept {
  if (ticks_.position_m.size() >= ticks_.position_m.capacity()) return;
  // Ticks that were missed held their force, and nobody read.
  while (ticks_.position_m.size() < row.tick && ticks_.position_m.size() + 1 < ticks_.position_m.capacity()) {
    ticks_.position_m.push_back(std::numeric_limits<double>::quiet_NaN());
    ticks_.speed_m_s.push_back(std::numeric_limits<double>::quiet_NaN());
    ticks_.commanded_n.push_back(ticks_.commanded_n.empty() ? 0.0 : ticks_.commanded_n.back());
    ticks_.excitation_n.push_back(0.0);
    ticks_.sensor_n.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  if (begins_now_ && begins_.size() < begins_.capacity()) begins_.push_back(ticks_.position_m.size());
  begins_now_ = false;
  ticks_.position_m.push_back(plan_.lever * row.position[plan_.axis]);
  ticks_.speed_m_s.push_back(plan_.lever * row.velocity[plan_.axis]);
  ticks_.commanded_n.push_back(row.force_commanded[plan_.axis]);
  ticks_.excitation_n.push_back(excitation_now_n_);
  ticks_.sensor_n.push_back(row.force_measured[plan_.axis]);
  if ((row.flags & zero_force_flags) != 0 && !finished_) {
    fault_flags_ = row.flags & zero_force_flags;
    finish(ExperimentEnd::fault);
  }
}

}  // namespace kerf::bench

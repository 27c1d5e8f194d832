#include "sealed/trials/trial_quality.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <kerf/fitting/jnd.h>

#include "sealed/trials/adherence.h"

namespace kerf::bench {
namespace {

constexpr std::uint32_t flags_of_faults =
    schema::flag_law_fault | schema::flag_device_fault | schema::flag_position_jump | schema::flag_watchdog |
    schema::flag_zero_held | schema::flag_rows_lost | schema::flag_soft_start;
constexpr double speed_over_s = 0.02;  ///< an encoder's step of 36 um in it is 2 mm/s
constexpr std::uint32_t flags_of_limits = schema::flag_force_limited | schema::flag_slew_limited;

}  // namespace

TrialMeter::TrialMeter(const std::vector<schema::Axis>& axes, std::size_t slots,
                       std::optional<std::size_t> led_axis)
    : axes_(&axes),
      led_axis_(led_axis),
      squares_(slots, 0.0),
      off_target_(slots, 0.0),
      guide_squares_(slots, 0.0) {
  quality_.slots.resize(slots);
  for (const schema::Axis& axis : axes) newtons_.push_back(1.0 / fitting::felt_lever(axis.force_unit));
  stroking_.resize(slots, std::vector<Stroking>(axes.size()));
}

void TrialMeter::Stroking::go(double way_m) noexcept {
  at_m += way_m;
  if (direction >= 0) most_m = std::max(most_m, at_m);
  if (direction <= 0) least_m = std::min(least_m, at_m);
  const bool forth = direction <= 0 && at_m - least_m >= least_stroke_m;
  const bool back = direction >= 0 && most_m - at_m >= least_stroke_m;
  if (!forth && !back) return;
  direction = forth ? 1 : -1;
  (forth ? most_m : least_m) = at_m;
  ++strokes;
}

void TrialMeter::take_guide(const schema::Row& row, double elapsed_s, SlotFelt& slot) {
  const auto at = static_cast<std::size_t>(&slot - quality_.slots.data());
  const double off = row.position[*led_axis_] - row.channels[1];
  const double pull_n = newtons_[*led_axis_] * row.channels[2];
  if (std::isfinite(off)) off_target_[at] += off * off * elapsed_s;
  guide_squares_[at] += pull_n * pull_n * elapsed_s;
  slot.guide_peak_n = std::fmax(slot.guide_peak_n, std::abs(pull_n));
}

/// Over stretches that are long beside an encoder's step, one after the other while a slot plays.
void TrialMeter::take_speed(const TraceRow& tick, SlotFelt& slot) {
  if (!speed_since_ || speed_since_->slot != tick.slot) speed_since_ = tick;
  const double elapsed_s = tick.row.time_s - speed_since_->row.time_s;
  if (elapsed_s < speed_over_s - 1e-9) return;
  double squared = 0.0;
  for (std::size_t axis = 0; axis < axes_->size(); ++axis)
    squared +=
        std::pow((*axes_)[axis].lever * (tick.row.position[axis] - speed_since_->row.position[axis]), 2);
  if (std::isfinite(squared))
    slot.peak_speed_m_s = std::max(slot.peak_speed_m_s, std::sqrt(squared) / elapsed_s);
  speed_since_ = tick;
}

void TrialMeter::take(const TraceRow& tick) {
  const std::optional<TraceRow> before = std::exchange(before_, tick);
  const schema::Row& row = tick.row;
  if (tick.slot >= quality_.slots.size()) return;
  if ((row.flags & flags_of_faults) != 0) ++quality_.faulty_ticks;
  if ((row.flags & schema::flag_soft_start) != 0) ++quality_.soft_start_ticks;
  if ((row.flags & flags_of_faults & ~schema::flag_soft_start) != 0) ++quality_.fault_ticks;
  if ((row.flags & schema::flag_missed_deadline) != 0) ++quality_.missed_deadlines;
  SlotFelt& slot = quality_.slots[tick.slot];
  if ((row.flags & flags_of_limits) != 0) ++slot.limited_ticks;
  take_speed(tick, slot);
  if (!before || before->slot != tick.slot) return;
  const double elapsed_s = row.time_s - before->row.time_s;
  double squared = 0.0;
  double travelled = 0.0;
  for (std::size_t axis = 0; axis < axes_->size(); ++axis) {
    const double moved_m = (*axes_)[axis].lever * (row.position[axis] - before->row.position[axis]);
    const double way_m = std::isfinite(moved_m) ? moved_m : 0.0;  // a position that was no number is a fault
    const double force = row.force_commanded[axis] - (led_axis_ == axis ? row.channels[2] : 0.0);
    squared += std::pow(newtons_[axis] * force, 2);
    travelled += way_m * way_m;
    slot.work_j -= force * way_m;
    stroking_[tick.slot][axis].go(way_m);
    slot.strokes = std::max(slot.strokes, stroking_[tick.slot][axis].strokes);
  }
  if (led_axis_) take_guide(row, elapsed_s, slot);
  slot.playing_s += elapsed_s;
  slot.travel_m += std::sqrt(travelled);
  slot.peak_n = std::max(slot.peak_n, std::sqrt(squared));
  if (squared < least_felt_force_n * least_felt_force_n) return;
  slot.contact_s += elapsed_s;
  squares_[tick.slot] += squared * elapsed_s;
}

TrialQuality TrialMeter::quality() const {
  TrialQuality quality = quality_;
  for (std::size_t i = 0; i < quality.slots.size(); ++i) {
    SlotFelt& slot = quality.slots[i];
    if (slot.contact_s > 0.0) slot.rms_n = std::sqrt(squares_[i] / slot.contact_s);
    if (slot.playing_s == 0.0) continue;
    slot.speed_m_s = slot.travel_m / slot.playing_s;
    if (!led_axis_) continue;
    slot.off_target = std::sqrt(off_target_[i] / slot.playing_s);
    slot.guide_rms_n = std::sqrt(guide_squares_[i] / slot.playing_s);
  }
  return quality;
}

bool is_explored(const TrialQuality& quality, const Exploration& asked) noexcept {
  return std::ranges::all_of(quality.slots, [&](const SlotFelt& slot) {
    return slot.contact_s >= asked.contact_s && slot.travel_m >= asked.travel_m &&
           slot.peak_n >= asked.force_n && slot.strokes >= asked.strokes;
  });
}

std::vector<VoidReason> void_reasons_of(const TrialQuality& quality, const TrialRules& rules) {
  std::uint64_t limited = 0;
  for (const SlotFelt& slot : quality.slots) limited += slot.limited_ticks;
  std::vector<VoidReason> reasons;
  const auto add = [&](bool is_void, VoidReason reason) {
    if (is_void) reasons.push_back(reason);
  };
  add(rules.fault && quality.fault_ticks > 0, VoidReason::fault);
  add(rules.soft_start && quality.soft_start_ticks > 0, VoidReason::soft_start);
  add(rules.limited_ticks && limited > *rules.limited_ticks, VoidReason::limited_ticks);
  add(rules.missed_deadlines && quality.missed_deadlines > *rules.missed_deadlines,
      VoidReason::missed_deadline);
  add(!is_explored(quality, rules.explore), VoidReason::unexplored);
  add(rules.off_target &&
          std::ranges::any_of(quality.slots,
                              [&](const SlotFelt& slot) { return slot.off_target > *rules.off_target; }),
      VoidReason::off_target);
  return reasons;
}

bool TrialQuality::is_felt() const noexcept {
  return std::ranges::all_of(slots, [](const SlotFelt& slot) { return slot.contact_s > 0.0; });
}

std::optional<TrialQuality> quality_of(const RecordedTrial& trial, std::size_t slots) {
  if (trial.trace.empty()) return std::nullopt;
  TrialMeter meter(trial.axes, slots, led_axis_of(trial));
  for (const TraceRow& tick : trial.trace) meter.take(tick);
  return meter.quality();
}

std::optional<TrialQuality> quality_of(const RecordedTrial& trial, const Protocol& protocol) {
  std::optional<TrialQuality> quality = quality_of(trial, slots_of(protocol));
  if (!quality || !protocol.guide) return quality;
  const std::vector<double> lags_s = guide_lags_s(trial, *protocol.guide, quality->slots.size());
  for (std::size_t slot = 0; slot < lags_s.size(); ++slot) quality->slots[slot].lag_s = lags_s[slot];
  return quality;
}

}  // namespace kerf::bench

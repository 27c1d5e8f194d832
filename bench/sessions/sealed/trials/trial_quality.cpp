#include "sealed/trials/trial_quality.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <kerf/fitting/jnd.h>

namespace kerf::bench {
namespace {

constexpr std::uint32_t flags_of_faults =
    schema::flag_law_fault | schema::flag_device_fault | schema::flag_position_jump | schema::flag_watchdog |
    schema::flag_zero_held | schema::flag_rows_lost | schema::flag_soft_start;
constexpr std::uint32_t flags_of_limits = schema::flag_force_limited | schema::flag_slew_limited;

class Felt {
 public:
  Felt(const std::vector<schema::Axis>& axes, std::size_t slots) : axes_(axes), squares_(slots, 0.0) {
    quality_.slots.resize(slots);
    for (const schema::Axis& axis : axes) newtons_.push_back(1.0 / fitting::felt_lever(axis.force_unit));
  }

  void take(const TraceRow& tick, const TraceRow* before) {
    const schema::Row& row = tick.row;
    if (tick.slot >= quality_.slots.size()) return;
    if ((row.flags & flags_of_faults) != 0) ++quality_.faulty_ticks;
    if ((row.flags & schema::flag_missed_deadline) != 0) ++quality_.missed_deadlines;
    SlotFelt& slot = quality_.slots[tick.slot];
    if ((row.flags & flags_of_limits) != 0) ++slot.limited_ticks;
    if (before == nullptr || before->slot != tick.slot) return;
    const double elapsed_s = row.time_s - before->row.time_s;
    double squared = 0.0;
    double travelled = 0.0;
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      const double way_m = axes_[axis].lever * (row.position[axis] - before->row.position[axis]);
      squared += std::pow(newtons_[axis] * row.force_commanded[axis], 2);
      travelled += way_m * way_m;
      slot.work_j -= row.force_commanded[axis] * way_m;
    }
    slot.playing_s += elapsed_s;
    slot.travel_m += std::sqrt(travelled);
    slot.peak_n = std::max(slot.peak_n, std::sqrt(squared));
    if (squared < least_felt_force_n * least_felt_force_n) return;
    slot.contact_s += elapsed_s;
    squares_[tick.slot] += squared * elapsed_s;
  }

  [[nodiscard]] TrialQuality quality() {
    for (std::size_t i = 0; i < quality_.slots.size(); ++i) {
      SlotFelt& slot = quality_.slots[i];
      if (slot.contact_s > 0.0) slot.rms_n = std::sqrt(squares_[i] / slot.contact_s);
      if (slot.playing_s > 0.0) slot.speed_m_s = slot.travel_m / slot.playing_s;
    }
    return std::move(quality_);
  }

 private:
  const std::vector<schema::Axis>& axes_;
  std::vector<double> newtons_;
  std::vector<double> squares_;
  TrialQuality quality_;
};

}  // namespace

bool TrialQuality::is_felt() const noexcept {
  return std::ranges::all_of(slots, [](const SlotFelt& slot) { return slot.contact_s > 0.0; });
}

std::optional<TrialQuality> quality_of(const RecordedTrial& trial, std::size_t slots) {
  if (trial.trace.empty()) return std::nullopt;
  Felt felt(trial.axes, slots);
  const TraceRow* before = nullptr;
  for (const TraceRow& tick : trial.trace) {
    felt.take(tick, before);
    before = &tick;
  }
  return felt.quality();
}

}  // namespace kerf::bench

#include "sealed/trials/slot_levels.h"

#include <optional>

#include <kerf/fitting/jnd.h>

#include "felt/vibration.h"
#include "sealed/trials/adherence.h"
#include "sealed/trials/trial_quality.h"

namespace kerf::bench {
namespace {

/// Takes the ticks of a trial in turn and gives each stretch to the meter of its slot.
class SlotVibration {
 public:
  SlotVibration(const RecordedTrial& trial, const Protocol& protocol)
      : ramp_s_(protocol.ramp_s),
        led_axis_(led_axis_of(trial)),
        meters_(slots_of(protocol), VibrationMeter(trial.axes.size(), protocol.rate_hz)) {
    for (const schema::Axis& axis : trial.axes)
      newtons_.push_back(1.0 / fitting::felt_lever(axis.force_unit));
  }

  void take(const TraceRow& tick) {
    const bool goes_on = last_ != nullptr && last_->slot == tick.slot && last_->row.tick + 1 == tick.row.tick;
    if (!goes_on) end();
    if (last_ == nullptr || last_->slot != tick.slot) since_s_ = tick.row.time_s;
    last_ = &tick;
    if (tick.slot >= meters_.size() || tick.row.time_s - since_s_ < ramp_s_) return;
    for (std::size_t axis = 0; axis < newtons_.size(); ++axis)
      stretch_.push_back(newtons_[axis] *
                         (tick.row.force_commanded[axis] - (led_axis_ == axis ? tick.row.channels[2] : 0.0)));
  }

  void end() {
    if (last_ != nullptr && last_->slot < meters_.size()) meters_[last_->slot].add(stretch_);
    stretch_.clear();
  }

  [[nodiscard]] const std::vector<VibrationMeter>& meters() const noexcept { return meters_; }

 private:
  double ramp_s_;
  std::optional<std::size_t> led_axis_;
  std::vector<double> newtons_;
  std::vector<VibrationMeter> meters_;
  std::vector<double> stretch_;
  const TraceRow* last_ = nullptr;
  double since_s_ = 0.0;  ///< when the slot of the stretch was switched to
};

}  // namespace

std::vector<FeltLevel> slot_levels(const RecordedTrial& trial, const Protocol& protocol) {
  std::vector<FeltLevel> levels(slots_of(protocol));
  const std::optional<TrialQuality> quality = quality_of(trial, levels.size());
  if (!quality || trial.axes.empty()) return levels;
  SlotVibration vibration(trial, protocol);
  std::vector<double> ticks(levels.size(), 0.0);
  for (const TraceRow& tick : trial.trace) {
    vibration.take(tick);
    if (tick.slot < ticks.size()) ticks[tick.slot] += 1.0;
  }
  vibration.end();
  for (std::size_t slot = 0; slot < levels.size(); ++slot) {
    const SlotFelt& felt = quality->slots[slot];
    if (felt.contact_s == 0.0) continue;
    levels[slot] = {.rms_n = felt.rms_n,
                    .peak_n = felt.peak_n,
                    .limited_share = static_cast<double>(felt.limited_ticks) / ticks[slot]};
    vibration.meters()[slot].put_into(levels[slot]);
  }
  return levels;
}

}  // namespace kerf::bench

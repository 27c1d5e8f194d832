#include "session/blind_rendering.h"

#include <algorithm>
#include <cmath>

namespace kerf::bench {

void BlindRendering::begin(TrialRendering& trial) noexcept {
  wanted_.store(nothing, std::memory_order_relaxed);
  ends_.store(false, std::memory_order_relaxed);
  leads_.store(false, std::memory_order_relaxed);
  trial_.store(&trial, std::memory_order_release);
}

void BlindRendering::play(std::optional<std::size_t> slot) noexcept {
  wanted_.store(slot ? static_cast<std::uint8_t>(*slot) : nothing, std::memory_order_relaxed);
  if (slot) leads_.store(true, std::memory_order_relaxed);
}

void BlindRendering::end() noexcept {
  play(std::nullopt);
  let_go();
  ends_.store(true, std::memory_order_release);
}

/// In the middle of a switch through zero force, for every slot alike.
void BlindRendering::begin_anew(TrialRendering& trial, const drivers::Axes& position) noexcept {
  if (trial.fresh.empty() || is_anew_ || share_ < 0.5) return;
  share_ = 0.5;
  weights_ = {};
  for (std::size_t law = 0; law < trial.laws.size(); ++law) trial.laws[law] = trial.fresh[law];
  is_anew_ = towards_ == nothing ||
             std::ranges::none_of(trial.touched, [&](const TouchedAt& law) { return law.by(position); });
}

void BlindRendering::move(double period_s) noexcept {
  const std::uint8_t wanted = wanted_.load(std::memory_order_relaxed);
  if (wanted != towards_) {
    towards_ = wanted;
    from_ = weights_;
    share_ = 0.0;
    is_anew_ = false;
  }
  // The last step may leave the end by rounding; a tick more or less would tell nothing, but look untidy.
  share_ = ramp_s_ > 0.0 ? share_ + period_s / ramp_s_ : 1.0;
  if (share_ > 1.0 - 1e-9) share_ = 1.0;
  const bool through_zero = switching_ == SwitchKind::through_zero;
  const double old_share = through_zero ? std::max(0.0, 1.0 - 2.0 * share_) : 1.0 - share_;
  const double new_share = through_zero ? std::max(0.0, 2.0 * share_ - 1.0) : share_;
  for (std::size_t slot = 0; slot < max_slots; ++slot) {
    weights_[slot] = old_share * from_[slot] + (slot == towards_ ? new_share : 0.0);
  }
}

/// Adds the guide's force, the same whatever plays.
void BlindRendering::lead(const TrialRendering& trial, const drivers::Sample& sample, double period_s,
                          Command& command) noexcept {
  if (!guide_ || !trial.led_axis) return;
  const double step = ramp_s_ > 0.0 ? period_s / ramp_s_ : 1.0;
  const bool leads = leads_.load(std::memory_order_relaxed);
  led_share_ = std::clamp(led_share_ + (leads ? step : -step), 0.0, 1.0);
  if (led_share_ < 1e-9) led_share_ = 0.0;  // left by rounding
  const std::size_t axis = *trial.led_axis;
  const GuideTarget target = guide_->at(led_[0]);
  const double force = led_share_ * guide_->pull(target, sample.position[axis], sample.velocity[axis]);
  led_[1] = target.position;
  led_[2] = force;
  command.force[axis] += force;
}

Command BlindRendering::operator()(const drivers::Sample& sample, double period_s) noexcept {
  led_ = {guide_s_, 0.0, 0.0};
  shown_guide_s_.store(guide_s_, std::memory_order_relaxed);
  guide_s_ += period_s;
  TrialRendering* const trial = trial_.load(std::memory_order_acquire);
  if (trial == nullptr) return {};
  move(period_s);
  begin_anew(*trial, sample.position);
  std::array<Command, 2> computed;
  Command command;
  for (std::size_t law = 0; law < trial->laws.size(); ++law) {
    computed[law] = trial->laws[law](sample, period_s);
    for (double& force : computed[law].force) force *= trial->gains[law];
    command.flags |= computed[law].flags;
  }
  for (std::size_t slot = 0; slot < trial->slots; ++slot) {
    const drivers::Axes& force = computed[trial->law_of[slot]].force;
    for (std::size_t axis = 0; axis < force.size(); ++axis)
      command.force[axis] += weights_[slot] * force[axis];
  }
  if (share_ < 1.0) command.flags |= schema::flag_soft_switch;
  lead(*trial, sample, period_s, command);
  return command;
}

void BlindRendering::record(const schema::Row& row) noexcept {
  TrialRendering* const trial = trial_.load(std::memory_order_acquire);
  if (trial == nullptr) return;
  if (trial->rows < trial->trace.size()) {
    TraceRow& kept = trial->trace[trial->rows];
    kept = {.row = row, .slot = towards_};
    if (guide_ && trial->led_axis) {
      std::ranges::copy(led_, kept.row.channels.begin());
      // A tick that Safety kept from the rendering has no force of the guide either.
      led_[2] = 0.0;
    }
    std::atomic_ref(trial->rows).store(trial->rows + 1, std::memory_order_release);
  }
  if (share_ < 1.0 || led_share_ > 0.0 || towards_ != nothing || !ends_.load(std::memory_order_acquire))
    return;
  weights_ = from_ = {};
  trial_.store(nullptr, std::memory_order_release);
}

}  // namespace kerf::bench

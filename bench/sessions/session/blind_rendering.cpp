#include "session/blind_rendering.h"

#include <algorithm>
#include <cmath>

namespace kerf::bench {

void BlindRendering::begin(TrialRendering& trial) noexcept {
  wanted_.store(nothing, std::memory_order_relaxed);
  ends_.store(false, std::memory_order_relaxed);
  trial_.store(&trial, std::memory_order_release);
}

void BlindRendering::play(std::optional<std::size_t> slot) noexcept {
  wanted_.store(slot ? static_cast<std::uint8_t>(*slot) : nothing, std::memory_order_relaxed);
}

void BlindRendering::end() noexcept {
  play(std::nullopt);
  ends_.store(true, std::memory_order_release);
}

void BlindRendering::move(double period_s) noexcept {
  const std::uint8_t wanted = wanted_.load(std::memory_order_relaxed);
  if (wanted != towards_) {
    towards_ = wanted;
    from_ = weights_;
    share_ = 0.0;
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

Command BlindRendering::operator()(const drivers::Sample& sample, double period_s) noexcept {
  TrialRendering* const trial = trial_.load(std::memory_order_acquire);
  if (trial == nullptr) return {};
  move(period_s);
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
  return command;
}

void BlindRendering::record(const schema::Row& row) noexcept {
  TrialRendering* const trial = trial_.load(std::memory_order_acquire);
  if (trial == nullptr) return;
  if (trial->rows < trial->trace.size()) trial->trace[trial->rows++] = {.row = row, .slot = towards_};
  if (share_ < 1.0 || towards_ != nothing || !ends_.load(std::memory_order_acquire)) return;
  weights_ = from_ = {};
  trial_.store(nullptr, std::memory_order_release);
}

}  // namespace kerf::bench

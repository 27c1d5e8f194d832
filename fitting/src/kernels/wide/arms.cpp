#include "kernels/wide/arms.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

/// What is less is none, and would soon be denormal and slow to reckon with.
constexpr double negligible = 1e-100;

double kept(double value) { return value < negligible && value > -negligible ? 0.0 : value; }

/// c - a = ((1 - a) - q a) / q; by its series where the difference would lose its digits.
double gain_slope_of(double q, double loss) {
  if (q > 0.05) return loss / q - (1.0 - loss);
  double term = q;
  double sum = 0.0;
  for (int k = 1; k <= 10; ++k) {  // sum of (-1)^(k+1) k q^k / (k+1)!
    sum += term * k / (k + 1.0);
    term *= -q / (k + 1.0);
  }
  return sum;
}

ArmTick tick_over(double period_s, double time_s) {
  const double q = period_s / time_s;
  ArmTick tick{.period_s = period_s};
  for (std::size_t k = 0; k < 4; ++k) tick.loss[k] = -std::expm1(-q * static_cast<double>(k + 1));
  tick.once = kept(std::exp(-q));
  tick.twice = kept(tick.once * tick.once);
  tick.gain = tick.loss[0] / q;
  tick.fading = kept(q * tick.once);
  tick.gain_slope = gain_slope_of(q, tick.loss[0]);
  return tick;
}

/// Kept by multiplicative hashing: periods differ in their last bits too.
const ArmTick& tick_of(Arm& arm, double period_s) noexcept {
  constexpr int bits = 5;
  static_assert(std::tuple_size_v<decltype(Arm::ticks)> == std::size_t{1} << bits);
  const auto hash = std::bit_cast<std::uint64_t>(period_s) * 0x9E3779B97F4A7C15U;
  ArmTick& tick = arm.ticks[static_cast<std::size_t>(hash >> (64 - bits))];
  if (tick.period_s != period_s) tick = tick_over(period_s, arm.time_s);
  return tick;
}

/// y[n] = a y[n-1] + u[n] over four rows from rest, and what is left there of what was before.
[[gnu::always_inline]] inline Pack recurred(const Pack& input, const Pack& held, const Pack& once,
                                            const Pack& twice, const Pack& loss) {
  const Pack zero{};
  const Pack two = input + once * one_later(zero, input);
  const Pack four = two + twice * two_later(zero, two);
  return four + (held - loss * held);
}

KERF_WIDE_PACKETS void run_evenly(Arm& arm, const ArmTick& tick, const double* travel, std::size_t rows,
                                  double* g, double* h) {
  const Pack loss = load(tick.loss.data());
  const Pack once = all(tick.once);
  const Pack twice = all(tick.twice);
  Pack held_g = all(arm.g);
  Pack held_h = all(arm.h);
  for (std::size_t i = 0; i < rows; i += lanes) {
    const Pack moved = load(travel + i);
    const Pack now_g = recurred(tick.gain * moved, held_g, once, twice, loss);
    const Pack input = tick.fading * one_later(held_g, now_g) + tick.gain_slope * moved;
    const Pack now_h = recurred(input, held_h, once, twice, loss);
    store(g + i, now_g);
    store(h + i, now_h);
    held_g = last_of(now_g);
    held_h = last_of(now_h);
    held_g = where((held_g >= negligible) | (held_g <= -negligible), held_g);
    held_h = where((held_h >= negligible) | (held_h <= -negligible), held_h);
  }
}

void run_unevenly(Arm& arm, const Block& block, const double* travel, double* g, double* h) {
  const ArmTick* tick = &tick_of(arm, block.period_s[0]);
  double now_g = arm.g;
  double now_h = arm.h;
  for (std::size_t i = 0; i < block.padded; ++i) {
    if (block.period_s[i] != tick->period_s) tick = &tick_of(arm, block.period_s[i]);
    const double before = now_g;
    now_g = kept(before + (tick->gain * travel[i] - tick->loss[0] * before));
    now_h = kept(now_h + (tick->fading * before + tick->gain_slope * travel[i] - tick->loss[0] * now_h));
    g[i] = now_g;
    h[i] = now_h;
  }
}

KERF_WIDE_PACKETS void travel_of(Block& block, double before, bool bilateral, double* travel) {
  double* const x = block.column[0].data();
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack moved = load(&block.penetration[i]);
    store(x + i, bilateral ? moved : where(moved > 0.0, moved));
  }
  Pack last = all(before);
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack here = load(x + i);
    store(travel + i, here - one_later(last, here));
    last = here;
  }
}

KERF_WIDE_PACKETS void add_force(Block& block, double stiffness, std::size_t column, bool first) {
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack part = stiffness * load(&block.column[column][i]);
    store(&block.force[i], first ? part : load(&block.force[i]) + part);
  }
}

/// No force where the element pulls, and nothing that moves it.
KERF_WIDE_PACKETS void push_only(Block& block, std::size_t columns) {
  Bits pulls{};
  for (std::size_t i = 0; i < block.padded; i += lanes) pulls |= load(&block.force[i]) < 0.0;
  if (!any(pulls)) return;
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack force = load(&block.force[i]);
    const Bits pushes = force >= 0.0;
    store(&block.force[i], where(pushes, force));
    for (std::size_t k = 0; k < columns; ++k)
      store(&block.column[k][i], where(pushes, load(&block.column[k][i])));
  }
}

}  // namespace

Arms::Arms(double spring, std::span<const double> stiffness, std::span<const double> time_s, bool bilateral)
    : count_(stiffness.size()), spring_(spring), bilateral_(bilateral) {
  for (std::size_t k = 0; k < count_; ++k) {
    arms_[k].stiffness = stiffness[k];
    arms_[k].time_s = time_s[k];
  }
}

void Arms::fill(Block& block) noexcept {
  alignas(64) Block::Column travel;
  if (!started_) before_ = bilateral_ || block.penetration[0] > 0.0 ? block.penetration[0] : 0.0;
  started_ = true;
  travel_of(block, before_, bilateral_, travel.data());
  before_ = block.column[0][block.count - 1];
  add_force(block, spring_, 0, true);
  for (std::size_t k = 0; k < count_; ++k) {
    double* const g = block.column[1 + 2 * k].data();
    double* const h = block.column[2 + 2 * k].data();
    if (block.one_period) {
      run_evenly(arms_[k], tick_of(arms_[k], block.period_s[0]), travel.data(), block.padded, g, h);
    } else {
      run_unevenly(arms_[k], block, travel.data(), g, h);
    }
    arms_[k].g = kept(g[block.count - 1]);
    arms_[k].h = kept(h[block.count - 1]);
    add_force(block, arms_[k].stiffness, 1 + 2 * k, false);
  }
  if (!bilateral_) push_only(block, columns());
}

}  // namespace kerf::fitting::wide

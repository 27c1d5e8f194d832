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
[[gnu::always_inline]] inline Pack kept(const Pack& value) {
  return where((value >= negligible) | (value <= -negligible), value);
}

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

FourRows four_rows_of(double period_s, double time_s) {
  const double q = period_s / time_s;
  FourRows rows{.period_s = period_s};
  for (std::size_t k = 0; k < 4; ++k) rows.loss[k] = -std::expm1(-q * static_cast<double>(k + 1));
  rows.once = kept(std::exp(-q));
  rows.twice = kept(rows.once * rows.once);
  rows.gain = rows.loss[0] / q;
  rows.fading = kept(q * rows.once);
  rows.gain_slope = gain_slope_of(q, rows.loss[0]);
  return rows;
}

/// y[n] = a y[n-1] + u[n] over four rows from rest.
[[gnu::always_inline]] inline Pack recurred(const Pack& input, const Pack& once, const Pack& twice) {
  const Pack zero{};
  const Pack two = input + once * one_later(zero, input);
  return two + twice * two_later(zero, two);
}

/// Within how many time constants what is not negligible stays clear of the denormal numbers.
constexpr double clear_of_denormals = 400.0;

/// A packet waits for the one before by three operations alone: what is left of what the arm held there is
/// reckoned with a second time, for all of the next. `Fades`: where rows may come near the denormal numbers.
template <bool Fades>
[[gnu::always_inline]] inline void run_rows(Arm& arm, const FourRows& tick, const double* travel,
                                            std::size_t rows, double* g, double* h) {
  const Pack loss = load(tick.loss.data());
  const Pack whole_loss = all(tick.loss[3]);
  const Pack once = all(tick.once);
  const Pack twice = all(tick.twice);
  Pack held_g = all(arm.g);
  Pack held_h = all(arm.h);
  for (std::size_t i = 0; i < rows; i += lanes) {
    const Pack moved = load(travel + i);
    const Pack new_g = recurred(tick.gain * moved, once, twice);
    const Pack now_g = new_g + (held_g - loss * held_g);
    const Pack input = tick.fading * one_later(held_g, now_g) + tick.gain_slope * moved;
    const Pack new_h = recurred(input, once, twice);
    store(g + i, now_g);
    store(h + i, new_h + (held_h - loss * held_h));
    held_g = last_of(new_g) + (held_g - whole_loss * held_g);
    held_h = last_of(new_h) + (held_h - whole_loss * held_h);
    if constexpr (Fades) {
      held_g = kept(held_g);
      held_h = kept(held_h);
    }
  }
}

KERF_WIDE_PACKETS void run_fading(Arm& arm, const FourRows& tick, const double* travel, std::size_t rows,
                                  double* g, double* h) {
  run_rows<true>(arm, tick, travel, rows, g, h);
}
KERF_WIDE_PACKETS void run_evenly(Arm& arm, const FourRows& tick, const double* travel, std::size_t rows,
                                  double* g, double* h) {
  run_rows<false>(arm, tick, travel, rows, g, h);
}

/// `Packets` of arms, row by row.
template <std::size_t Packets>
[[gnu::always_inline]] inline void run_together(Arms& arms, std::span<Arm> all, Block& block,
                                                const double* travel) {
  const std::size_t count = all.size();
  std::array<double, Arms::places> g{}, h{};
  for (std::size_t k = 0; k < count; ++k) {
    g[k] = all[k].g;
    h[k] = all[k].h;
  }
  std::array<Pack, Packets> now_g{}, now_h{};
  for (std::size_t p = 0; p < Packets; ++p) {
    now_g[p] = load(&g[p * lanes]);
    now_h[p] = load(&h[p * lanes]);
  }
  const Arms::Tick* tick = &arms.tick_of(block.period_s[0]);
  for (std::size_t i = 0; i < block.padded; ++i) {
    if (block.period_s[i] != tick->period_s) tick = &arms.tick_of(block.period_s[i]);
    for (std::size_t p = 0; p < Packets; ++p) {
      const Pack loss = load(&tick->loss[p * lanes]);
      const Pack before = now_g[p];
      now_g[p] = kept(before + (load(&tick->gain[p * lanes]) * travel[i] - loss * before));
      now_h[p] = kept(now_h[p] + (load(&tick->fading[p * lanes]) * before +
                                  load(&tick->gain_slope[p * lanes]) * travel[i] - loss * now_h[p]));
      store(&g[p * lanes], now_g[p]);
      store(&h[p * lanes], now_h[p]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      block.column[1 + 2 * k][i] = g[k];
      block.column[2 + 2 * k][i] = h[k];
    }
  }
}

KERF_WIDE_PACKETS void run_four(Arms& arms, std::span<Arm> all, Block& block, const double* travel) {
  run_together<1>(arms, all, block, travel);
}
KERF_WIDE_PACKETS void run_eight(Arms& arms, std::span<Arm> all, Block& block, const double* travel) {
  run_together<2>(arms, all, block, travel);
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

/// Kept by multiplicative hashing with places beside: periods differ in their last bits too.
const Arms::Tick& Arms::tick_of(double period_s) noexcept {
  constexpr int bits = 7;
  constexpr std::size_t beside = 4;
  static_assert(std::tuple_size_v<decltype(ticks_)> == std::size_t{1} << bits);
  const auto hash = std::bit_cast<std::uint64_t>(period_s) * 0x9E3779B97F4A7C15U;
  const auto first = static_cast<std::size_t>(hash >> (64 - bits));
  Tick* free = &ticks_[first];
  for (std::size_t k = 0; k < beside; ++k) {
    Tick& tick = ticks_[(first + k) % ticks_.size()];
    if (tick.period_s == period_s) return tick;
    if (tick.period_s == 0.0) {
      free = &tick;
      break;
    }
  }
  free->period_s = period_s;
  for (std::size_t k = 0; k < count_; ++k) {
    const double q = period_s / arms_[k].time_s;
    const double loss = -std::expm1(-q);
    free->loss[k] = loss;
    free->gain[k] = loss / q;
    free->fading[k] = kept(q * kept(std::exp(-q)));
    free->gain_slope[k] = gain_slope_of(q, loss);
  }
  return *free;
}

void Arms::fill(Block& block) noexcept {
  alignas(64) Block::Column travel;
  if (!started_) before_ = bilateral_ || block.penetration[0] > 0.0 ? block.penetration[0] : 0.0;
  started_ = true;
  travel_of(block, before_, bilateral_, travel.data());
  before_ = block.column[0][block.count - 1];
  const std::span<Arm> all = std::span(arms_).first(count_);
  if (!block.one_period) {
    (count_ <= lanes ? run_four : run_eight)(*this, all, block, travel.data());
  }
  add_force(block, spring_, 0, true);
  for (std::size_t k = 0; k < count_; ++k) {
    Arm& arm = arms_[k];
    double* const g = block.column[1 + 2 * k].data();
    double* const h = block.column[2 + 2 * k].data();
    if (block.one_period) {
      if (arm.rows.period_s != block.period_s[0]) arm.rows = four_rows_of(block.period_s[0], arm.time_s);
      const bool fades =
          block.period_s[0] * static_cast<double>(Block::most_rows) > clear_of_denormals * arm.time_s;
      (fades ? run_fading : run_evenly)(arm, arm.rows, travel.data(), block.padded, g, h);
    }
    arm.g = kept(g[block.count - 1]);
    arm.h = kept(h[block.count - 1]);
    add_force(block, arm.stiffness, 1 + 2 * k, false);
  }
  if (!bilateral_) push_only(block, columns());
}

}  // namespace kerf::fitting::wide

#include "kernels/wide/springpot.h"

#include <algorithm>
#include <cmath>

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

constexpr double negligible =
    1e-100;  ///< of a displacement: less would soon be denormal, and slow to reckon with
constexpr std::size_t most_ticks = 32;

/// Ticks of one period of all decays: their force, and its slope by alpha.
KERF_WIDE_PACKETS void run(const double* travel, std::size_t count, double* displacement, const double* share,
                           const double* gain, const double* weight, const double* slope, double* force,
                           double* by_order) {
  constexpr std::size_t packs = models::Springpot<double>::decays / lanes;
  static_assert(packs * lanes == models::Springpot<double>::decays);
  std::array<Pack, packs> at;
  for (std::size_t j = 0; j < packs; ++j) at[j] = load(displacement + j * lanes);
  for (std::size_t i = 0; i < count; ++i) {
    Pack sum_of_forces{};
    Pack sum_of_slopes{};
    for (std::size_t j = 0; j < packs; ++j) {
      const Pack next = load(share + j * lanes) * at[j] + load(gain + j * lanes) * travel[i];
      at[j] = where((next >= negligible) | (next <= -negligible), next);
      sum_of_forces += load(weight + j * lanes) * at[j];
      sum_of_slopes += load(slope + j * lanes) * at[j];
    }
    force[i] = sum(sum_of_forces);
    by_order[i] = sum(sum_of_slopes);
  }
  for (std::size_t j = 0; j < packs; ++j) store(displacement + j * lanes, at[j]);
}

}  // namespace

Springpot::Springpot(const models::Springpot<Dual>& law)
    : stiffness_(law.stiffness.a),
      fractional_stiffness_(law.fractional_stiffness.a),
      slow_(law.slow.a),
      slow_slope_(law.slow.v[0]),
      fast_(law.fast.a),
      fast_slope_(law.fast.v[0]),
      bilateral_(law.bilateral) {
  for (std::size_t j = 0; j < decays; ++j) {
    weight_[j] = law.weight[j].a;
    slope_[j] = law.weight[j].v[0];
  }
}

const Springpot::Tick& Springpot::tick_of(double period_s) {
  const auto found = std::ranges::find(ticks_, period_s, &Tick::period_s);
  if (found != ticks_.end()) return *found;
  if (ticks_.size() == most_ticks) ticks_.clear();
  Tick& tick = ticks_.emplace_back();
  tick.period_s = period_s;
  for (std::size_t j = 0; j < decays; ++j) {
    using Law = models::Springpot<double>;
    const double rate = std::exp(std::log(Law::fastest_rate) - Law::log_spacing * static_cast<double>(j));
    const double relaxation = rate * period_s;
    tick.share[j] = relaxation < 200.0 ? std::exp(-relaxation) : 0.0;
    tick.gain[j] = -std::expm1(-relaxation) / relaxation;
  }
  return tick;
}

void Springpot::fill(Block& block) noexcept {
  alignas(64) Block::Column travel, decaying, by_order;
  const auto displaced = [&](std::size_t i) {
    return bilateral_ || block.penetration[i] > 0.0 ? block.penetration[i] : 0.0;
  };
  if (!started_) beginning_ = before_ = displaced(0);
  started_ = true;
  for (std::size_t i = 0; i < block.count; ++i) {
    const double x = displaced(i);
    travel[i] = x - before_;
    before_ = x;
  }
  for (std::size_t begin = 0, end = 0; begin < block.count; begin = end) {
    const double period_s = block.period_s[begin];
    while (end < block.count && block.period_s[end] == period_s) ++end;
    const Tick& tick = tick_of(period_s);
    run(&travel[begin], end - begin, displacement_.data(), tick.share.data(), tick.gain.data(),
        weight_.data(), slope_.data(), &decaying[begin], &by_order[begin]);
  }
  for (std::size_t i = 0; i < block.count; ++i) {
    const double x = displaced(i);
    const double since = x - beginning_;
    const double speed = travel[i] / block.period_s[i];
    const double fractional = slow_ * since + fast_ * speed + decaying[i];
    const double force = stiffness_ * x + fractional;
    const bool felt = bilateral_ || !(force < 0.0);
    block.force[i] = felt ? force : 0.0;
    block.column[0][i] = felt ? x : 0.0;
    block.column[1][i] = felt ? fractional / fractional_stiffness_ : 0.0;
    block.column[2][i] = felt ? slow_slope_ * since + fast_slope_ * speed + by_order[i] : 0.0;
  }
  for (std::size_t i = block.count; i < block.padded; ++i) {
    block.force[i] = 0.0;
    for (std::size_t k = 0; k < columns(); ++k) block.column[k][i] = 0.0;
  }
}

}  // namespace kerf::fitting::wide

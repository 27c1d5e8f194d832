#include "choose/step_cost.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>

namespace kerf::bench {

double step_cost_us(const models::Law& law, std::span<const models::Motion> motion, double period_s) {
  if (motion.empty()) throw std::invalid_argument("there is no motion to time a law along");
  constexpr std::size_t ticks = 512;
  std::array<double, 9> batch_us{};
  models::Law::State state = law.initial_state();
  std::size_t at = 0;
  double sum = 0.0;
  for (double& cost_us : batch_us) {
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < ticks; ++i) {
      sum += law.step(state, motion[at], period_s).force;
      at = at + 1 < motion.size() ? at + 1 : 0;
    }
    const std::chrono::duration<double, std::micro> spent = std::chrono::steady_clock::now() - begin;
    cost_us = spent.count() / static_cast<double>(ticks);
  }
  [[maybe_unused]] const volatile double used = sum;
  std::ranges::nth_element(batch_us, batch_us.begin() + batch_us.size() / 2);
  return batch_us[batch_us.size() / 2];
}

}  // namespace kerf::bench

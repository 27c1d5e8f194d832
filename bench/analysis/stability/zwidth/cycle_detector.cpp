#include "stability/zwidth/cycle_detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr std::size_t lobe = 3;  // bins to each side that hold all of an oscillation under Hann's window

}  // namespace

CycleDetector::CycleDetector(const Options& options) : options_(options) {
  const std::size_t reach = options.neighbours + 1;  // of the furthest neighbour
  if (options.ticks < 100 || options.neighbours < 4 || options.neighbours % 2 != 0 ||
      options.lowest_bin < 1 || options.highest_bin < options.lowest_bin + 2 * reach ||
      options.highest_bin >= options.ticks / 2) {
    throw std::invalid_argument(fmt::format(
        "a window of {} ticks cannot be searched from bin {} to {}: expected 100 ticks or more, and "
        "{} bins or more below half of them",
        options.ticks, options.lowest_bin, options.highest_bin, 2 * reach));
  }
  first_bin_ = options.lowest_bin;  // below lies what a hand does
  const std::size_t last = std::min(options.highest_bin + lobe, options.ticks / 2);
  const double per_bin = 2.0 * std::numbers::pi / static_cast<double>(options.ticks);
  for (std::size_t bin = first_bin_; bin <= last; ++bin)
    turn_.push_back(2.0 * std::cos(per_bin * static_cast<double>(bin)));
  for (std::size_t tick = 0; tick < options.ticks; ++tick)
    window_.push_back(0.5 - 0.5 * std::cos(per_bin * static_cast<double>(tick)));
  now_.resize(turn_.size());
  before_.resize(turn_.size());
  const auto l = static_cast<double>(options.neighbours);
  const auto bins = static_cast<double>(options.highest_bin - options.lowest_bin + 1);
  threshold_ = l * (std::pow(bins / options.false_alarms, 1.0 / l) - 1.0);
}

void CycleDetector::restart() noexcept {
  std::ranges::fill(now_, 0.0);
  std::ranges::fill(before_, 0.0);
  tick_ = 0;
}

void CycleDetector::add(double value) noexcept {
  if (is_full()) return;
  if (tick_ == 0) offset_ = value;
  const double weighted = window_[tick_++] * (value - offset_);
  for (std::size_t i = 0; i < turn_.size(); ++i) {
    const double next = weighted + turn_[i] * now_[i] - before_[i];
    before_[i] = now_[i];
    now_[i] = next;
  }
}

double CycleDetector::power(std::size_t bin) const noexcept {
  const std::size_t i = bin - first_bin_;
  return std::max(0.0, now_[i] * now_[i] + before_[i] * before_[i] - turn_[i] * now_[i] * before_[i]);
}

double CycleDetector::rms_at(std::size_t bin) const noexcept {
  constexpr double of_hann = 1.5;  // sum of the squares of its lobe
  double sum = 0.0;
  const std::size_t last = first_bin_ + turn_.size() - 1;
  for (std::size_t k = std::max(first_bin_, bin - std::min(bin, lobe)); k <= std::min(bin + lobe, last); ++k)
    sum += power(k);
  return 4.0 / static_cast<double>(options_.ticks) * std::sqrt(0.5 * sum / of_hann);
}

FoundCycle CycleDetector::judge() const noexcept {
  FoundCycle found;
  if (!is_full()) return found;
  const std::size_t low = options_.lowest_bin;
  const std::size_t high = options_.highest_bin;
  double largest_power = 0.0;
  for (std::size_t bin = low; bin <= high; ++bin) {
    const double here = power(bin);
    if (here == 0.0) continue;
    // As many neighbours on each side; what is missing at an end of the band is taken from the other side.
    double sum = 0.0;
    std::size_t taken = 0;
    for (std::size_t away = lobe; taken < options_.neighbours; away += 2) {
      if (bin >= low + away) {
        sum += power(bin - away);
        ++taken;
      }
      if (bin + away <= high && taken < options_.neighbours) {
        sum += power(bin + away);
        ++taken;
      }
    }
    const double floor = sum / static_cast<double>(options_.neighbours);
    const double over = floor > 0.0 ? here / floor : std::numeric_limits<double>::infinity();
    if (over <= threshold_ || here <= largest_power) continue;
    largest_power = here;
    found = {.is_significant = true, .bin = bin, .rms = rms_at(bin), .over_floor = over};
  }
  return found;
}

}  // namespace kerf::bench

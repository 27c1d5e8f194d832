#include "chart/cost/timed_ticks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

void check_timed(const TimedLaw& law) {
  if (law.path->ticks() == 0)
    throw std::invalid_argument("the path that a law is timed along has no samples");
  if (!std::ranges::all_of(law.path->period_s, [](double s) { return s > 0.0 && std::isfinite(s); }))
    throw std::invalid_argument("the period of the ticks that are timed must be positive");
}

}  // namespace

std::uint64_t stamp() noexcept {
#if defined(__x86_64__)
  _mm_lfence();
  const std::uint64_t now = __rdtsc();
  _mm_lfence();
  return now;
#else
  return static_cast<std::uint64_t>(WallClock::now_ns());
#endif
}

double StampRate::unit_ns() const {
  const std::uint64_t stamps = stamp() - first_stamp_;
  return stamps > 0 ? static_cast<double>(WallClock::now_ns() - first_ns_) / static_cast<double>(stamps)
                    : 1.0;
}

std::uint64_t smallest_step() {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t before = stamp();
  for (int i = 0; i < 2000; ++i) {
    const std::uint64_t now = stamp();
    if (now > before) least = std::min(least, now - before);
    before = now;
  }
  for (int i = 0; i < 2000; ++i) {
    const std::uint64_t now = stamp();
    // Differences of differences are multiples of the step, too.
    const std::uint64_t rest = (now - before) % least;
    if (rest > 0) least = rest;
    before = now;
  }
  return least;
}

double fine_median(const std::vector<double>& durations, std::uint64_t step) {
  const double coarse = quantile(durations, 0.5);
  const double reach = 1.5 * static_cast<double>(step);
  double sum = 0.0;
  double count = 0.0;
  for (const double duration : durations) {
    if (std::abs(duration - coarse) > reach) continue;
    sum += duration;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : coarse;
}

std::vector<std::size_t> counted_ticks(std::span<const std::uint8_t> pushes,
                                       std::span<const double> period_s) {
  std::vector<std::uint8_t> counts(pushes.size(), 0);
  constexpr double far = std::numeric_limits<double>::infinity();
  double since_s = far;
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    since_s = pushes[i] != 0 ? 0.0 : since_s + period_s[i];
    if (since_s <= about_a_push_s) counts[i] = 1;
  }
  double until_s = far;
  for (std::size_t i = pushes.size(); i-- > 0;) {
    until_s = pushes[i] != 0 ? 0.0 : until_s + (i + 1 < pushes.size() ? period_s[i + 1] : 0.0);
    if (until_s <= about_a_push_s) counts[i] = 1;
  }
  const bool never = std::ranges::find(counts, 1) == counts.end();
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (never || counts[i] != 0) places.push_back(i);
  }
  return places;
}

TimedTicks::TimedTicks(const TimedLaw& timed)
    : rendering_(timed.rendering), fresh_(&timed.rendering), path_(timed.path) {
  check_timed(timed);
  std::vector<std::uint8_t> pushes;
  pushes.reserve(path_->ticks());
  for (std::size_t i = 0; i < path_->ticks(); ++i) {
    const Command command = rendering_(path_->sample[i], path_->period_s[i]);
    pushes.push_back(std::ranges::any_of(command.force, [](double f) { return f != 0.0; }) ? 1 : 0);
  }
  counted_ = counted_ticks(pushes, path_->period_s);
  restart();
}

std::uint64_t TimedTicks::time(std::size_t i) noexcept {
  const models::SpatialMotion sample = path_->sample[i];  // near at hand, as what a device has just told
  const double period_s = path_->period_s[i];
  const std::uint64_t begin = stamp();
  const Command command = rendering_(sample, period_s);
  const std::uint64_t spent = stamp() - begin;
  kept_ = command.force[0];
  return spent;
}

}  // namespace kerf::bench

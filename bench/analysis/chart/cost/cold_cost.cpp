#include "chart/cost/cold_cost.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <unistd.h>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_in_a_passage = 1000;
constexpr std::size_t settling_ticks = 4;      // of a passage: another law's instructions were there before
constexpr double golden = 0.6180339887498949;  // shares of it fall between all that went before
constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

/// What is read to drive everything else out of the caches of this core.
class CacheFlush {
 public:
  CacheFlush() : words_(bytes() / sizeof(std::uint64_t), 1) {}
  void operator()() noexcept {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < words_.size(); i += 64 / sizeof(std::uint64_t)) sum += words_[i];
    words_[0] = sum | 1;
  }

 private:
  static std::size_t bytes() {
    const long second_level = sysconf(_SC_LEVEL2_CACHE_SIZE);
    return 2 * static_cast<std::size_t>(std::max(second_level, 1L << 20));
  }
  std::vector<std::uint64_t> words_;
};

/// A law on its way through the passages.
class ColdSubject {
 public:
  explicit ColdSubject(const TimedLaw& law, std::size_t most) : ticks_(law) { durations_.reserve(most); }

  [[nodiscard]] const std::vector<double>& durations() const noexcept { return durations_; }

  void passage(std::size_t most, CacheFlush& flush) {
    const std::vector<std::size_t>& counted = ticks_.counted();
    const std::size_t count = std::min({most - durations_.size(), counted.size(), most_in_a_passage});
    const double stride = static_cast<double>(counted.size()) / static_cast<double>(count);
    const double offset = std::fmod(golden * static_cast<double>(passages_++), 1.0);
    settle(flush);
    ticks_.restart();
    std::size_t tick = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto place = static_cast<std::size_t>((static_cast<double>(k) + offset) * stride);
      for (; tick < counted[place]; ++tick) ticks_.step(tick);
      flush();
      durations_.push_back(static_cast<double>(ticks_.time(tick++)));
    }
  }

 private:
  /// Has the law's instructions for ticks that count where those of other laws were; as cold as what follows.
  void settle(CacheFlush& flush) {
    ticks_.restart();
    std::size_t tick = 0;
    for (std::size_t k = 0; k < std::min(settling_ticks, ticks_.counted().size()); ++k) {
      const std::size_t place = ticks_.counted()[k * ticks_.counted().size() / settling_ticks];
      if (place < tick) continue;
      for (; tick < place; ++tick) ticks_.step(tick);
      flush();
      (void)ticks_.time(tick++);
    }
  }

  TimedTicks ticks_;
  std::vector<double> durations_;
  std::size_t passages_ = 0;
};

/// An empty body, measured as a law is.
void empty_passage(std::size_t count, CacheFlush& flush, std::vector<double>& durations) {
  const drivers::Sample sample;
  for (std::size_t i = 0; i < count; ++i) {
    flush();
    const std::uint64_t begin = stamp();
    (void)NoForce{}(sample, 1e-3);
    durations.push_back(static_cast<double>(stamp() - begin));
  }
}

ColdCost cold_cost_of(const std::vector<double>& durations, double overhead, std::uint64_t step,
                      double unit_ns) {
  const auto beyond = [&](double value) { return unit_ns * std::max(0.0, value - overhead); };
  const auto percentile = [&](double share, std::size_t fewest) {
    return durations.size() < fewest ? not_measured : beyond(quantile(durations, share));
  };
  return {.ticks = durations.size(),
          .p50_ns = durations.empty() ? not_measured : beyond(fine_median(durations, step)),
          .p99_ns = percentile(0.99, ticks_for_p99),
          .p999_ns = percentile(0.999, ticks_for_p999)};
}

}  // namespace

ColdCosts cold_costs(std::span<const TimedLaw> laws, const ColdCostOptions& options) {
  ColdCosts costs;
  CacheFlush flush;
  const StampRate rate;
  const std::int64_t begin_ns = WallClock::now_ns();
  const std::uint64_t step = smallest_step();
  std::vector<ColdSubject> subjects;
  for (const TimedLaw& law : laws) subjects.emplace_back(law, options.ticks);
  std::vector<double> empty;
  std::size_t done = 0;
  const std::size_t wanted = options.ticks * subjects.size();
  const auto in_time = [&] {
    return 1e-9 * static_cast<double>(WallClock::now_ns() - begin_ns) < options.max_seconds;
  };
  for (bool first = true; done < wanted && (first || in_time()); first = false) {
    if (empty.size() < options.ticks)
      empty_passage(std::min(most_in_a_passage, options.ticks - empty.size()), flush, empty);
    for (ColdSubject& subject : subjects) {
      if (options.stop != nullptr && options.stop->load()) return {};
      const std::size_t before = subject.durations().size();
      if (before < options.ticks) subject.passage(options.ticks, flush);
      done += subject.durations().size() - before;
      if (options.told) options.told(static_cast<double>(done) / static_cast<double>(wanted));
    }
  }
  const double overhead = empty.empty() ? 0.0 : fine_median(empty, step);
  costs.empty = cold_cost_of(empty, 0.0, step, rate.unit_ns());
  for (const ColdSubject& subject : subjects)
    costs.laws.push_back(cold_cost_of(subject.durations(), overhead, step, rate.unit_ns()));
  return costs;
}

}  // namespace kerf::bench

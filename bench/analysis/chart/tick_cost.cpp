#include "chart/tick_cost.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include <unistd.h>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

#include "loop/clock.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr std::size_t warm_up_ticks = 32;
constexpr std::size_t fewest_rounds = 2;
constexpr double quiet_share = 0.1;  // of the rounds: a busy neighbour slows whole rounds, by half or more

/// A time stamp in units of its own, before which all is done and after which nothing has begun.
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

/// Length of a stamp's unit [ns], from two moments of both clocks.
class StampRate {
 public:
  [[nodiscard]] double unit_ns() const {
    const std::uint64_t stamps = stamp() - first_stamp_;
    return stamps > 0 ? static_cast<double>(WallClock::now_ns() - first_ns_) / static_cast<double>(stamps)
                      : 1.0;
  }

 private:
  std::int64_t first_ns_ = WallClock::now_ns();
  std::uint64_t first_stamp_ = stamp();
};

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

/// The smallest step that the stamps make: some processors count in units and tick in tens of them.
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

/// The median, finer than the step of the stamps. A duration between two steps is measured as one or the
/// other as often as it is nearer to it, so that the mean of those around the median is right.
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

/// Percentiles in units of the stamp, one of each a round.
struct Rounds {
  std::vector<double> p50, p999;
  void add(const std::vector<double>& durations, std::uint64_t step, double overhead) {
    p50.push_back(std::max(0.0, fine_median(durations, step) - overhead));
    p999.push_back(std::max(0.0, quantile(durations, 0.999) - overhead));
  }
};

/// A law on its way through the rounds, with all the memory that these take.
class Subject {
 public:
  explicit Subject(const TimedLaw& timed)
      : rendering_(timed.rendering),
        fresh_(timed.rendering),
        path_(*timed.path),
        duration_(path_.ticks()),
        pushes_(path_.ticks()) {
    chosen_.reserve(path_.ticks());
  }

  void warm_round(std::uint64_t step_of_stamps, double overhead) {
    const std::int64_t begin_ns = WallClock::now_ns();
    rendering_ = fresh_;
    for (std::size_t i = 0; i < std::min(warm_up_ticks, path_.ticks()); ++i) step(i);
    rendering_ = fresh_;
    for (std::size_t i = 0; i < path_.ticks(); ++i) time(i);
    rendering_ = fresh_;
    const std::uint64_t begin = stamp();
    for (std::size_t i = 0; i < path_.ticks(); ++i) step(i);
    passages_.push_back(static_cast<double>(stamp() - begin) / static_cast<double>(path_.ticks()));
    chosen_.clear();
    const bool ever = std::any_of(pushes_.begin(), pushes_.end(), [](auto pushes) { return pushes != 0; });
    for (std::size_t i = 0; i < duration_.size(); ++i) {
      if (!ever || pushes_[i] != 0) chosen_.push_back(static_cast<double>(duration_[i]));
    }
    warm_.add(chosen_, step_of_stamps, overhead);
    longest_s_ = std::max(longest_s_, 1e-9 * static_cast<double>(WallClock::now_ns() - begin_ns));
  }

  void cold_round(std::size_t most, std::uint64_t step_of_stamps, double overhead, CacheFlush& flush) {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < pushes_.size(); ++i) {
      if (pushes_[i] != 0) places.push_back(i);
    }
    if (places.empty()) {
      for (std::size_t i = 0; i < pushes_.size(); ++i) places.push_back(i);
    }
    const std::size_t count = std::min(most, places.size());
    chosen_.clear();
    rendering_ = fresh_;
    std::size_t tick = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t place = places[k * places.size() / count];
      for (; tick < place; ++tick) step(tick);
      flush();
      time(tick++);
      chosen_.push_back(static_cast<double>(duration_[place]));
    }
    cold_.add(chosen_, step_of_stamps, overhead);
  }

  [[nodiscard]] bool wants_round(const TickCostOptions& options) const {
    const std::size_t done = warm_.p50.size();
    return done < std::min(fewest_rounds, options.rounds) ||
           (done < options.rounds && static_cast<double>(done + 1) * longest_s_ <= options.max_seconds);
  }
  [[nodiscard]] TickCost cost(double unit_ns, double calibration_round) const {
    return {.p50_ns = unit_ns * quantile(warm_.p50, quiet_share),
            .p999_ns = unit_ns * quantile(warm_.p999, 0.5),
            .cold_p50_ns = unit_ns * quantile(cold_.p50, 0.5),
            .cold_p999_ns = unit_ns * quantile(cold_.p999, 0.5),
            .mean_rounds = quantile(passages_, quiet_share) / calibration_round};
  }

 private:
  void step(std::size_t i) noexcept { (void)rendering_(path_.sample[i], path_.period_s[i]); }
  void time(std::size_t i) noexcept {
    const models::SpatialMotion& sample = path_.sample[i];
    const double period_s = path_.period_s[i];
    const std::uint64_t begin = stamp();
    const Command command = rendering_(sample, period_s);
    duration_[i] = stamp() - begin;
    pushes_[i] = std::any_of(command.force.begin(), command.force.end(), [](double f) { return f != 0.0; });
  }

  LawRendering rendering_;
  const LawRendering& fresh_;
  const SampledMotion& path_;
  std::vector<std::uint64_t> duration_;
  std::vector<std::uint8_t> pushes_;
  std::vector<double> chosen_;
  std::vector<double> passages_;  ///< mean tick of each
  Rounds warm_, cold_;
  double longest_s_ = 0.0;
};

/// One round of the calibration loop, in units of the stamp.
double calibration() {
  constexpr int rounds = 20000;
  volatile double seed = 1.5;
  double x = seed;
  const std::uint64_t begin = stamp();
  for (int i = 0; i < rounds; ++i) x = std::sqrt(1.25 + x * 0.75) + 1.0 / (1.0 + x);
  const std::uint64_t spent = stamp() - begin;
  seed = x;
  return static_cast<double>(spent) / rounds;
}

/// What two stamps cost with an empty body between them.
double overhead_of_stamps(std::size_t times, std::uint64_t step_of_stamps, CacheFlush* flush) {
  std::vector<double> durations(times);
  const drivers::Sample sample;
  for (double& duration : durations) {
    if (flush != nullptr) (*flush)();
    const std::uint64_t begin = stamp();
    (void)NoForce{}(sample, 1e-3);
    duration = static_cast<double>(stamp() - begin);
  }
  return fine_median(durations, step_of_stamps);
}

void check(const TimedLaw& law) {
  if (law.path->ticks() == 0)
    throw std::invalid_argument("the path that a law is timed along has no samples");
  if (!std::ranges::all_of(law.path->period_s, [](double s) { return s > 0.0 && std::isfinite(s); }))
    throw std::invalid_argument("the period of the ticks that are timed must be positive");
}

}  // namespace

std::size_t tick_cost_steps(std::size_t laws, const TickCostOptions& options) {
  return laws * (std::max<std::size_t>(options.rounds, 1) + (options.cold_ticks > 0 ? 1 : 0));
}

std::vector<TickCost> tick_costs(std::span<const TimedLaw> laws, const TickCostOptions& given) {
  TickCostOptions options = given;
  options.rounds = std::max<std::size_t>(given.rounds, 1);
  for (const TimedLaw& law : laws) check(law);
  std::vector<Subject> subjects(laws.begin(), laws.end());
  CacheFlush flush;
  const StampRate rate;
  const std::uint64_t step = smallest_step();
  const auto stopped = [&] { return options.stop != nullptr && options.stop->load(); };
  const auto count_one = [&] {
    if (options.done != nullptr) ++*options.done;
  };
  std::vector<double> calibrations;
  for (std::size_t round = 0; round < options.rounds; ++round) {
    calibrations.push_back(calibration());
    const double overhead = overhead_of_stamps(4000, step, nullptr);
    for (std::size_t k = 0; k < subjects.size(); ++k) {
      if (stopped()) return {};
      Subject& subject = subjects[(k + round) % subjects.size()];
      if (subject.wants_round(options)) subject.warm_round(step, overhead);
      count_one();
    }
  }
  if (options.cold_ticks > 0) {
    const double overhead = overhead_of_stamps(options.cold_ticks, step, &flush);
    for (Subject& subject : subjects) {
      if (stopped()) return {};
      subject.cold_round(options.cold_ticks, step, overhead, flush);
      count_one();
    }
  }
  const double calibration_round = quantile(calibrations, quiet_share);
  std::vector<TickCost> costs;
  for (const Subject& subject : subjects) costs.push_back(subject.cost(rate.unit_ns(), calibration_round));
  return costs;
}

}  // namespace kerf::bench

#include "chart/cost/tick_cost.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

constexpr std::size_t warm_up_ticks = 32;
constexpr std::size_t fewest_rounds = 2;
constexpr double quiet_share = 0.1;  // of the rounds: a busy neighbour slows whole rounds, by half or more
constexpr double warm_share = 0.5;   // of the progress, where there are cold ticks too

/// A law on its way through the rounds, with all the memory that these take.
class Subject {
 public:
  explicit Subject(const TimedLaw& timed)
      : ticks_(timed), duration_(ticks_.ticks()), chosen_(ticks_.counted().size()) {}

  void round(std::uint64_t step_of_stamps, double overhead) {
    const std::int64_t begin_ns = WallClock::now_ns();
    ticks_.restart();
    for (std::size_t i = 0; i < std::min(warm_up_ticks, ticks_.ticks()); ++i) ticks_.step(i);
    ticks_.restart();
    for (std::size_t i = 0; i < ticks_.ticks(); ++i) duration_[i] = ticks_.time(i);
    ticks_.restart();
    const std::uint64_t begin = stamp();
    for (std::size_t i = 0; i < ticks_.ticks(); ++i) ticks_.step(i);
    passages_.push_back(static_cast<double>(stamp() - begin) / static_cast<double>(ticks_.ticks()));
    std::ranges::transform(ticks_.counted(), chosen_.begin(),
                           [&](std::size_t place) { return static_cast<double>(duration_[place]); });
    p50_.push_back(std::max(0.0, fine_median(chosen_, step_of_stamps) - overhead));
    p999_.push_back(std::max(0.0, quantile(chosen_, 0.999) - overhead));
    longest_s_ = std::max(longest_s_, 1e-9 * static_cast<double>(WallClock::now_ns() - begin_ns));
  }

  [[nodiscard]] bool wants_round(const TickCostOptions& options) const {
    const std::size_t done = p50_.size();
    return done < std::min(fewest_rounds, options.rounds) ||
           (done < options.rounds && static_cast<double>(done + 1) * longest_s_ <= options.max_seconds);
  }
  [[nodiscard]] TickCost cost(double unit_ns, double calibration_round) const {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    return {.p50_ns = unit_ns * quantile(p50_, quiet_share),
            .p999_ns = unit_ns * quantile(p999_, 0.5),
            .cold = {.p50_ns = unknown, .p99_ns = unknown, .p999_ns = unknown},
            .mean_rounds = quantile(passages_, quiet_share) / calibration_round};
  }

 private:
  TimedTicks ticks_;
  std::vector<std::uint64_t> duration_;
  std::vector<double> chosen_;
  std::vector<double> passages_;    ///< mean tick of each
  std::vector<double> p50_, p999_;  ///< in units of the stamp, one of each a round
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
double overhead_of_stamps(std::size_t times, std::uint64_t step_of_stamps) {
  std::vector<double> durations(times);
  const drivers::Sample sample;
  for (double& duration : durations) {
    const std::uint64_t begin = stamp();
    (void)NoForce{}(sample, 1e-3);
    duration = static_cast<double>(stamp() - begin);
  }
  return fine_median(durations, step_of_stamps);
}

}  // namespace

std::vector<TickCost> tick_costs(std::span<const TimedLaw> laws, const TickCostOptions& given) {
  TickCostOptions options = given;
  options.rounds = std::max<std::size_t>(given.rounds, 1);
  std::vector<Subject> subjects(laws.begin(), laws.end());
  const StampRate rate;
  const std::uint64_t step = smallest_step();
  const double share = options.cold_ticks > 0 ? warm_share : 1.0;
  std::vector<double> calibrations;
  for (std::size_t round = 0; round < options.rounds; ++round) {
    calibrations.push_back(calibration());
    const double overhead = overhead_of_stamps(4000, step);
    for (std::size_t k = 0; k < subjects.size(); ++k) {
      if (options.stop != nullptr && options.stop->load()) return {};
      Subject& subject = subjects[(k + round) % subjects.size()];
      if (subject.wants_round(options)) subject.round(step, overhead);
    }
    if (options.told)
      options.told(share * static_cast<double>(round + 1) / static_cast<double>(options.rounds));
  }
  const double calibration_round = quantile(calibrations, quiet_share);
  std::vector<TickCost> costs;
  for (const Subject& subject : subjects) costs.push_back(subject.cost(rate.unit_ns(), calibration_round));
  if (options.cold_ticks == 0) return costs;
  ColdCostOptions cold{.ticks = options.cold_ticks, .stop = options.stop, .told = {}};
  if (options.told) cold.told = [&](double part) { options.told(share + (1.0 - share) * part); };
  const std::vector<ColdCost> in_the_cold = cold_costs(laws, cold).laws;
  if (in_the_cold.size() != costs.size()) return {};
  for (std::size_t i = 0; i < costs.size(); ++i) costs[i].cold = in_the_cold[i];
  return costs;
}

}  // namespace kerf::bench

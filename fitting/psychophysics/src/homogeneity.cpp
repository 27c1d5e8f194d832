#include <algorithm>
#include <cmath>
#include <vector>

#include <kerf/psychophysics/homogeneity.h>
#include <kerf/psychophysics/random.h>

#include "checks.h"

namespace kerf::psychophysics {
namespace {

constexpr double max_tables = 200'000.0;
constexpr double as_likely_log = 1e-7;  ///< of log probabilities

double log_choose(int n, int k) {
  return std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0);
}

/// The logarithms of C(n, k) of each group, and what the tables that are no more probable add up to.
class Tables {
 public:
  Tables(const std::vector<Count>& groups, Count all) : all_(all) {
    for (const Count& group : groups) {
      trials_.push_back(group.trials);
      std::vector<double>& row = log_ways_.emplace_back();
      for (int k = 0; k <= group.trials; ++k) row.push_back(log_choose(group.trials, k));
      seen_ += row[static_cast<std::size_t>(group.successes)];
    }
    room_.assign(groups.size() + 1, 0);
    for (std::size_t i = groups.size(); i-- > 0;) room_[i] = room_[i + 1] + trials_[i];
  }

  [[nodiscard]] double count() const {
    double tables = 1.0;
    for (std::size_t i = 0; i + 1 < trials_.size(); ++i) tables *= trials_[i] + 1.0;
    return tables;
  }

  [[nodiscard]] double exact() const {
    return std::min(1.0, sum(0, all_.successes, -log_choose(all_.trials, all_.successes), 0.0));
  }

  [[nodiscard]] double drawn(const HomogeneityOptions& options) const {
    Random random(options.seed);
    int as_extreme = 1;
    for (int sample = 0; sample < options.samples; ++sample) {
      int successes = all_.successes;
      int trials = all_.trials;
      double log_ways = 0.0;
      for (std::size_t i = 0; i < trials_.size(); ++i) {
        std::size_t here = 0;
        for (int trial = 0; trial < trials_[i]; ++trial, --trials) {
          if (random.uniform() * trials >= successes) continue;
          --successes;
          ++here;
        }
        log_ways += log_ways_[i][here];
      }
      as_extreme += log_ways <= seen_ + as_likely_log ? 1 : 0;
    }
    return as_extreme / (1.0 + options.samples);
  }

 private:
  [[nodiscard]] double sum(std::size_t group, int left, double log_p, double log_ways) const {
    if (group == trials_.size()) return log_ways <= seen_ + as_likely_log ? std::exp(log_p) : 0.0;
    double total = 0.0;
    for (int k = std::max(0, left - room_[group + 1]); k <= std::min(left, trials_[group]); ++k) {
      const double ways = log_ways_[group][static_cast<std::size_t>(k)];
      total += sum(group + 1, left - k, log_p + ways, log_ways + ways);
    }
    return total;
  }

  Count all_;
  std::vector<int> trials_;
  std::vector<int> room_;  ///< trials from a group on
  std::vector<std::vector<double>> log_ways_;
  double seen_ = 0.0;
};

}  // namespace

Homogeneity equal_proportions(std::span<const Count> groups, const HomogeneityOptions& options) {
  require(options.samples >= 99, "a test by drawn tables needs 99 of them at least");
  std::vector<Count> filled;
  Count all;
  for (const Count& group : groups) {
    require(group);
    if (group.trials == 0) continue;
    filled.push_back(group);
    all.successes += group.successes;
    all.trials += group.trials;
  }
  Homogeneity result{.degrees_of_freedom = std::max(0, static_cast<int>(filled.size()) - 1)};
  if (filled.size() < 2 || all.successes == 0 || all.successes == all.trials) return result;
  const double p = static_cast<double>(all.successes) / all.trials;
  for (const Count& group : filled) {
    const double apart = group.successes - group.trials * p;
    result.statistic += apart * apart / (group.trials * p * (1.0 - p));
  }
  const Tables tables(filled, all);
  result.is_exact = tables.count() <= max_tables;
  result.p = result.is_exact ? tables.exact() : tables.drawn(options);
  return result;
}

}  // namespace kerf::psychophysics

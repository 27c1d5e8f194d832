#include "samples.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "infinite.h"
#include "kernels/wide/range.h"
#include "uncertainty/statistics.h"

namespace kerf::fitting {
namespace {

[[noreturn]] void refuse(const std::string& reason) { throw std::invalid_argument("cannot fit: " + reason); }

wide::Range check_finite(std::span<const double> values, const char* name) {
  const wide::Range range = wide::range_of(values);
  if (range.is_finite) return range;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    std::ostringstream reason;
    reason << "the " << name << " of sample " << i << " is not finite; leave such samples out";
    refuse(reason.str());
  }
  return range;
}

double largest_of(const wide::Range& range) { return std::max(-range.least, range.most); }

/// What a sensor that is stuck gives, and one that failed once: no law is told by them.
void check_force(std::span<const double> force, double largest) {
  constexpr std::size_t enough = 20;  // samples, of which one has no business to be more than all others
  if (std::ranges::all_of(force, [&](double one) { return one == force.front(); })) {
    if (force.front() == 0.0) refuse("the force is zero throughout");
    std::ostringstream reason;
    reason << "the force is " << force.front() << " throughout: a sensor that is stuck reads like that";
    refuse(reason.str());
  }
  const double squares = numbers_of(force).square().sum();
  if (force.size() < enough || 2.0 * largest * largest <= squares) return;
  const auto first = std::ranges::find(force, largest, [](double one) { return std::abs(one); });
  std::ostringstream reason;
  reason << "the force of sample " << first - force.begin() << ", " << *first
         << ", has more squares than all others together: leave it out";
  refuse(reason.str());
}

struct Ranges {
  wide::Range penetration, velocity, force;
};
Ranges check_columns(const Series& series) {
  const std::size_t count = series.force.size();
  if (series.time_s.size() != count || series.penetration.size() != count ||
      series.velocity.size() != count || (!series.cycle.empty() && series.cycle.size() != count) ||
      (!series.counts.empty() && series.counts.size() != count)) {
    refuse("time, penetration, velocity, force, cycle and counts differ in length");
  }
  if (count < 4) refuse("there are only " + std::to_string(count) + " samples");
  check_finite(series.time_s, "time");
  const Ranges ranges{.penetration = check_finite(series.penetration, "penetration"),
                      .velocity = check_finite(series.velocity, "velocity"),
                      .force = check_finite(series.force, "force")};
  check_force(series.force, largest_of(ranges.force));
  if (!(series.noise_n >= 0.0) || !std::isfinite(series.noise_n)) {
    refuse("the noise of a recording must be a positive number, or 0 where it is not known");
  }
  if (!(series.contact_error >= 0.0) || !std::isfinite(series.contact_error)) {
    refuse("the error of a contact must be a positive number, or 0 where it is taken for exact");
  }
  return ranges;
}

/// Since the sample before; the first has that of the second.
struct Periods {
  std::vector<double> all;
  double median_s;
  bool are_even;  ///< but for rounding, which is taken out
};
Periods periods_of(std::span<const double> time_s) {
  const auto between = static_cast<Eigen::Index>(time_s.size() - 1);
  const auto each = numbers_of(time_s).tail(between) - numbers_of(time_s).head(between);
  const double shortest = each.minCoeff();
  if (!(shortest > 0.0)) {
    const auto first = std::ranges::adjacent_find(time_s, std::ranges::greater_equal());
    refuse("the time does not increase at sample " + std::to_string(first - time_s.begin() + 1));
  }
  if (each.maxCoeff() - shortest < 1e-6 * shortest) {
    const double period_s = (time_s.back() - time_s.front()) / static_cast<double>(between);
    return {.all = std::vector<double>(time_s.size(), period_s), .median_s = period_s, .are_even = true};
  }
  Periods periods{.all = std::vector<double>(time_s.size()), .median_s = 0.0, .are_even = false};
  std::vector<double>& all = periods.all;
  Eigen::Map<Eigen::ArrayXd>(all.data() + 1, between) = each;
  all[0] = all[1];
  periods.median_s = median_of({all.begin() + 1, all.end()});
  // Uniform sampling up to rounding is uniform: laws keep what they derive from the period.
  for (double& period : all) {
    if (std::abs(period - periods.median_s) < 1e-6 * periods.median_s) period = periods.median_s;
  }
  return periods;
}

/// Where there are no cycles, each fold takes blocks of time from all over the recording: what happens once,
/// a ramp before a hold, would be in one fold, and no fit without it could foretell it.
constexpr std::size_t most_blocks = 10;      ///< a fold
constexpr std::size_t fewest_in_block = 20;  ///< samples

std::size_t blocks_of(std::size_t samples, std::size_t folds) {
  if (folds < 2) return 0;
  return folds * std::clamp<std::size_t>(samples / (folds * fewest_in_block), 1, most_blocks);
}

/// Folds by cycle where there are at least two; else blocks of time. The test share comes last.
void assign_folds(Samples& samples, const Run& run, std::span<const std::uint32_t> cycle,
                  const FoldOptions& options) {
  const std::size_t count = run.end - run.begin;
  const std::uint32_t cycles = cycle.empty() ? 0 : *std::max_element(cycle.begin(), cycle.end());
  const bool by_cycle = cycles >= 2;
  const double total = static_cast<double>(by_cycle ? cycles : count);
  constexpr double rounding = 1e-9;  // 10 * (1 - 0.7) is more than 3
  const auto kept = static_cast<std::size_t>(std::ceil(total * (1.0 - options.test_share) - rounding));
  const std::size_t folds = by_cycle ? std::min(options.folds, kept) : options.folds;
  samples.folds = std::max(samples.folds, folds);
  const auto fold = samples.fold.begin() + static_cast<std::ptrdiff_t>(run.begin);
  const auto at = [&](std::size_t row) { return fold + static_cast<std::ptrdiff_t>(row); };
  if (!by_cycle) {
    const std::size_t blocks = blocks_of(kept, folds);
    for (std::size_t k = 0; k < blocks; ++k)
      std::fill(at(k * kept / blocks), at((k + 1) * kept / blocks), static_cast<std::uint32_t>(k % folds));
    std::fill(at(kept), at(count), Samples::test);
    return;
  }
  bool over = false;  // the test share runs to the end, with what lies between its cycles
  for (std::size_t i = 0; i < count; ++i) {
    over = over || cycle[i] > kept;
    if (over) {
      *at(i) = Samples::test;
    } else if (cycle[i] > 0 && folds >= 2) {
      *at(i) = (cycle[i] - 1) % static_cast<std::uint32_t>(folds);
    }
  }
}

}  // namespace

Samples check_series(std::span<const Series> recordings, const FoldOptions& options) {
  if (recordings.empty()) refuse("there is no recording");
  if (!(options.test_share >= 0.0 && options.test_share <= 0.9)) {
    refuse("the share that is held back for a test must be from 0 to 0.9");
  }
  Samples samples{.least = infinite, .most = -infinite};
  samples.all_seen = options.test_share == 0.0;
  for (const Series& series : recordings) {
    const Ranges ranges = check_columns(series);
    samples.largest_force = std::max(samples.largest_force, largest_of(ranges.force));
    samples.fastest = std::max(samples.fastest, largest_of(ranges.velocity));
    samples.least = std::min(samples.least, ranges.penetration.least);
    samples.most = std::max(samples.most, ranges.penetration.most);
    samples.all_seen = samples.all_seen && std::ranges::none_of(series.counts, [](auto c) { return c == 0; });
    const Run run{.begin = samples.size(),
                  .end = samples.size() + series.force.size(),
                  .noise_n = series.noise_n,
                  .contact_error = series.contact_error};
    Periods periods = periods_of(series.time_s);
    if (samples.runs.empty()) {
      samples.median_period_s = periods.median_s;
      samples.period_s = std::move(periods.all);
    } else {
      samples.period_s.insert(samples.period_s.end(), periods.all.begin(), periods.all.end());
    }
    samples.is_even = samples.is_even && periods.are_even && periods.median_s == samples.median_period_s;
    samples.force.insert(samples.force.end(), series.force.begin(), series.force.end());
    samples.counts.insert(samples.counts.end(), series.counts.begin(), series.counts.end());
    samples.counts.resize(samples.size(), 1);
    samples.cycle.insert(samples.cycle.end(), series.cycle.begin(), series.cycle.end());
    samples.cycle.resize(samples.size(), 0);
    samples.motion.resize(samples.size());
    for (std::size_t i = 0; i < series.force.size(); ++i)
      samples.motion[run.begin + i] = {.penetration = series.penetration[i], .velocity = series.velocity[i]};
    samples.duration_s = std::max(samples.duration_s, series.time_s.back() - series.time_s.front());
    samples.fold.resize(samples.size(), Samples::no_fold);
    samples.has_cycles = samples.has_cycles ||
                         std::any_of(series.cycle.begin(), series.cycle.end(), [](auto c) { return c > 0; });
    assign_folds(samples, run, series.cycle, options);
    samples.runs.push_back(run);
  }
  if (!(samples.most > samples.least))
    refuse("the position is constant, so no law over it can be told from another");
  return samples;
}

Samples thinned(const Samples& samples, std::size_t count) {
  const std::size_t step = std::max<std::size_t>(1, samples.size() / count);
  if (step == 1) return samples;
  Samples few{.folds = samples.folds,
              .least = samples.least,
              .most = samples.most,
              .fastest = samples.fastest,
              .largest_force = samples.largest_force,
              .median_period_s = samples.median_period_s,
              .duration_s = samples.duration_s,
              .has_cycles = samples.has_cycles,
              .is_even = samples.is_even,
              .all_seen = samples.all_seen};
  // Equal but for rounding is equal: laws keep what they derive from the period.
  const double usual_s = static_cast<double>(step) * samples.median_period_s;
  const auto since = [&](std::size_t before, std::size_t i) {
    if (samples.is_even) return usual_s;
    double period_s = 0.0;
    for (std::size_t k = before + 1; k <= i; ++k) period_s += samples.period_s[k];
    return std::abs(period_s - usual_s) < 1e-9 * usual_s ? usual_s : period_s;
  };
  for (const Run& run : samples.runs) {
    Run short_run(run);
    short_run.begin = few.size();
    for (std::size_t i = run.begin; i < run.end; i += step) {
      few.motion.push_back(samples.motion[i]);
      few.period_s.push_back(i == run.begin ? samples.period_s[i] : since(i - step, i));
      few.force.push_back(samples.force[i]);
      few.counts.push_back(samples.counts[i]);
      few.cycle.push_back(samples.cycle[i]);
      few.fold.push_back(samples.fold[i]);
    }
    short_run.end = few.size();
    few.runs.push_back(short_run);
  }
  few.median_period_s *= static_cast<double>(step);
  return few;
}

Numbers seen_of(const Samples& samples, std::span<const double> column, std::vector<double>& kept) {
  if (samples.all_seen) return numbers_of(column);
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (samples.is_seen(i)) kept.push_back(column[i]);
  }
  return numbers_of(kept);
}

Weights all_of(const Samples& samples) {
  Weights weights(samples.size(), 1.0);
  if (samples.all_seen && samples.runs.size() == 1) return weights;
  const bool known =
      std::all_of(samples.runs.begin(), samples.runs.end(), [](const Run& run) { return run.noise_n > 0.0; });
  for (const Run& run : samples.runs) {
    const double share = known ? samples.runs.front().noise_n / run.noise_n : 1.0;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      weights[i] = samples.is_seen(i) ? share * share : 0.0;
    }
  }
  return weights;
}

Weights thinned_weights(const Samples& samples, const Weights& weights, const Samples& few) {
  if (few.size() == samples.size()) return weights;
  const auto step = static_cast<std::size_t>(std::lround(few.median_period_s / samples.median_period_s));
  Weights light(few.size());
  for (std::size_t run = 0; run < few.runs.size(); ++run) {
    for (std::size_t i = few.runs[run].begin; i < few.runs[run].end; ++i) {
      light[i] = weights[samples.runs[run].begin + (i - few.runs[run].begin) * step];
    }
  }
  return light;
}

Weights without_fold(const Samples& samples, const Weights& weights, std::size_t fold) {
  Weights rest(weights);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples.fold[i] == fold) rest[i] = 0.0;
  }
  return rest;
}

double noise_of_rows(const Samples& samples, const Weights& weights) {
  std::vector<double> sizes;
  const auto counts = [&](std::size_t i) { return weights.empty() || weights[i] > 0.0; };
  for (const Run& run : samples.runs) {
    for (std::size_t i = run.begin + 1; i + 1 < run.end; ++i) {
      if (counts(i - 1) && counts(i) && counts(i + 1))
        sizes.push_back(std::abs(samples.force[i - 1] - 2.0 * samples.force[i] + samples.force[i + 1]));
    }
  }
  return robust_deviation(std::move(sizes)) / std::sqrt(6.0);
}

}  // namespace kerf::fitting

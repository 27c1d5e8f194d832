#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <kerf/population/compare.h>
#include <kerf/psychophysics/random.h>

namespace kerf::population {

/// A drawer whose truth is known: tissues x 2 speeds x specimens, logarithms of a parameter. Every specimen
/// is cut at both speeds.
struct Drawer {
  std::vector<double> tissues{0.0, 0.0, 0.0};  ///< means at the first speed
  double speed = 0.0;                          ///< what the second speed adds
  std::vector<double> between{0.1, 0.1, 0.1};  ///< between specimens, of each tissue
  double interaction = 0.0;                    ///< between specimens, of what speed does
  double within = 0.1;                         ///< between recordings
  double error = 0.05;  ///< of an estimate, known: half to one and a half of this, by recording
  std::vector<int> specimens{5, 5, 5};
  std::vector<int> recordings{2, 3, 4};  ///< of a specimen at a speed, by turns
};

using Group = std::vector<Estimate>;

/// groups[tissue][speed]
inline std::vector<std::vector<Group>> filled(const Drawer& drawer, psychophysics::Random& random) {
  std::vector<std::vector<Group>> groups;
  for (std::size_t tissue = 0; tissue < drawer.tissues.size(); ++tissue) {
    std::vector<Group> speeds(2);
    for (int i = 0; i < drawer.specimens[tissue]; ++i) {
      const double own = drawer.between[tissue] * random.normal();
      for (std::size_t speed = 0; speed < 2; ++speed) {
        const double changed = speed == 0 ? 0.0 : drawer.speed + drawer.interaction * random.normal();
        const int recordings =
            drawer.recordings[(static_cast<std::size_t>(i) + speed) % drawer.recordings.size()];
        for (int j = 0; j < recordings; ++j) {
          const double error = drawer.error * (0.5 + random.uniform());
          speeds[speed].push_back({.value = drawer.tissues[tissue] + own + changed +
                                            drawer.within * random.normal() + error * random.normal(),
                                   .standard_error = error,
                                   .specimen = std::to_string(tissue) + "." + std::to_string(i)});
        }
      }
    }
    groups.push_back(std::move(speeds));
  }
  return groups;
}

/// All questions of a study: each two tissues at each speed, then the speeds in each tissue.
inline std::vector<Pair> questions(const std::vector<std::vector<Group>>& groups) {
  std::vector<Pair> pairs;
  for (std::size_t speed = 0; speed < 2; ++speed) {
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (std::size_t j = i + 1; j < groups.size(); ++j)
        pairs.push_back({.first = groups[i][speed], .second = groups[j][speed]});
    }
  }
  for (const std::vector<Group>& speeds : groups) pairs.push_back({.first = speeds[1], .second = speeds[0]});
  return pairs;
}

inline bool holds(const Interval& interval, double value) {
  return interval.lower <= value && value <= interval.upper;
}

/// How often intervals of one study held the truth.
struct Held {
  int studies = 0;
  int mean = 0;
  int between = 0;
  int within = 0;
  int next = 0;     ///< the true mean of a specimen that was not recorded
  int tissues = 0;  ///< difference of the first two tissues, nested
  int speeds = 0;   ///< difference of the speeds in the first tissue, crossed
};

inline Held coverage(const Drawer& drawer, int studies, std::uint64_t seed) {
  psychophysics::Random random(seed);
  Held held{.studies = studies};
  for (int i = 0; i < studies; ++i) {
    const std::vector<std::vector<Group>> groups = filled(drawer, random);
    const GroupEstimate group = estimate_group(groups[0][0]);
    const double next = drawer.tissues[0] + drawer.between[0] * random.normal();
    held.mean += holds(*group.interval, drawer.tissues[0]) ? 1 : 0;
    if (group.between_recordings) {
      held.between += holds(*group.between_specimens->interval, drawer.between[0]) ? 1 : 0;
      held.within += holds(*group.between_recordings->interval, drawer.within) ? 1 : 0;
    } else {
      held.between += holds(*group.together->interval, std::hypot(drawer.between[0], drawer.within)) ? 1 : 0;
    }
    held.next += holds(*group.of_the_next, next) ? 1 : 0;
    const std::vector<Pair> pairs{{.first = groups[0][0], .second = groups[1][0]},
                                  {.first = groups[0][1], .second = groups[0][0]}};
    CompareOptions options;
    options.draws = 99;  // the tests are not looked at
    options.most_exact = 1;
    const std::vector<Comparison> compared = compare(pairs, options);
    held.tissues += holds(*compared[0].interval, drawer.tissues[0] - drawer.tissues[1]) ? 1 : 0;
    held.speeds += holds(*compared[1].interval, drawer.speed) ? 1 : 0;
  }
  return held;
}

/// What the tests of whole studies found.
struct Found {
  int studies = 0;
  int any = 0;             ///< studies with at least one "differ"
  int tissues = 0;         ///< tests of one pair of tissues with p <= 0.05, not corrected
  int speeds = 0;          ///< the same of one pair of speeds
  int told_tissues = 0;    ///< "differ" of that pair of tissues
  int told_speeds = 0;     ///< "differ" of that pair of speeds
  int cannot_be_told = 0;  ///< verdicts on that pair of tissues
};

inline Found found(const Drawer& drawer, int studies, std::uint64_t seed, CompareOptions options = {}) {
  psychophysics::Random random(seed);
  Found result{.studies = studies};
  for (int i = 0; i < studies; ++i) {
    options.seed = seed + 1000 * static_cast<std::uint64_t>(i);
    const std::vector<Pair> pairs = questions(filled(drawer, random));
    const std::vector<Comparison> compared = compare(pairs, options);
    bool any = false;
    for (const Comparison& one : compared) any = any || one.verdict == Verdict::differ;
    const Comparison& tissues = compared.front();
    const Comparison& speeds = compared[pairs.size() - drawer.tissues.size()];
    result.any += any ? 1 : 0;
    result.tissues += tissues.test->p <= options.level ? 1 : 0;
    result.speeds += speeds.test->p <= options.level ? 1 : 0;
    result.told_tissues += tissues.verdict == Verdict::differ ? 1 : 0;
    result.told_speeds += speeds.verdict == Verdict::differ ? 1 : 0;
    result.cannot_be_told += tissues.verdict == Verdict::cannot_be_told ? 1 : 0;
  }
  return result;
}

}  // namespace kerf::population

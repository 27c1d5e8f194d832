#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include <kerf/psychophysics/random.h>

#include "protocol/judgement.h"

// Studies that tests make by hand.

namespace kerf::test {

inline psychophysics::Task abx_task() { return {.decision = psychophysics::Decision::abx_independent}; }

inline bench::Study study_with(bench::Design design, psychophysics::Task task = {}) {
  bench::Study study{.name = "made up", .design = design, .samples = {"standard", "comparison"}};
  if (design != bench::Design::preference) study.task = task;
  return study;
}

/// Adds right answers, then wrong ones; the right slot goes from one to the other.
inline void add_answers(bench::Study& study, const std::string& subject, const std::string& tissue, int right,
                        int wrong) {
  for (int i = 0; i < right + wrong; ++i) {
    const std::size_t slot = static_cast<std::size_t>(i) % 2;
    study.judgements.push_back({.subject = subject,
                                .tissue = tissue,
                                .pair = {0, 1},
                                .right = slot,
                                .answer = i < right ? slot : 1 - slot});
  }
}

/// Adds wins of the first of two samples over the second, and losses.
inline void add_wins(bench::Study& study, std::size_t first, std::size_t second, int wins, int losses) {
  for (int i = 0; i < wins + losses; ++i) {
    const std::size_t slot = static_cast<std::size_t>(i) % 2;
    study.judgements.push_back(
        {.subject = "P1", .pair = {first, second}, .right = slot, .answer = i < wins ? 1 - slot : slot});
  }
}

/// Answers of an observer at fixed levels.
inline void add_observer(bench::Study& study, const std::string& subject,
                         const psychophysics::Psychometric& truth, int trials,
                         psychophysics::Random& random) {
  for (const double level : study.scale.levels) {
    for (int i = 0; i < trials; ++i) {
      const std::size_t slot = static_cast<std::size_t>(i) % 2;
      const bool is_right = random.chance(truth.probability(level));
      study.judgements.push_back({.subject = subject,
                                  .pair = {0, 0},
                                  .level = level,
                                  .right = slot,
                                  .answer = is_right ? slot : 1 - slot});
    }
  }
}

}  // namespace kerf::test

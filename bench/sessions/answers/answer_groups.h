#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/dprime.h>
#include <kerf/psychophysics/equivalence.h>
#include <kerf/psychophysics/homogeneity.h>
#include <kerf/psychophysics/sign_flips.h>

#include "protocol/judgement.h"

// Answers that are counted: right or wrong, or for one sample or the other.

namespace kerf::bench {

struct AnalysisOptions;

/// How likely the exact test of a group was to find a truth that is the same for all its subjects, and how
/// many trials it takes.
struct TestPower {
  double truth = 0.75;  ///< share of right answers, or of preferences
  double power = 0.0;   ///< at the trials there are
  int trials_needed =
      0;  ///< for a power of 0.8; 0: not looked for (of the group of all alone), or over 100,000
};

/// Whether the difference lies within a margin that was set before: d' below a bound, a preference near 50 %.
///
/// Of one subject exact. Of two: exact of each, and shown if it is of both. Of more, for their mean:
/// Student's of the subjects' shares, with an error no less than that of as many independent answers; shown
/// if the interval lies within the margin, the subjects do not differ (equal_proportions) and none of them
/// alone, after Holm, is beyond chance. A mean of people who hear and people who do not is no equivalence for
/// anybody.
struct GroupEquivalence {
  double p = 1.0;
  psychophysics::Interval interval;  ///< of the share, of confidence 1 - 2 level; of two: what holds both
  bool is_shown = false;
  std::size_t subjects_shown = 0;  ///< for how many of the subjects, each alone and exactly
  bool subjects_differ = false;    ///< why it is not shown, although the mean lies within
};

/// What the answers of a group say: of all, of a subject, a tissue or a pair.
struct AnswerGroup {
  std::string name;
  std::string counted;         ///< "right", "recording preferred"
  psychophysics::Count count;  ///< of a preference those for the first sample of the pair
  double chance = 0.5;
  bool one_sided = true;  ///< the main test: of a discrimination; of a preference it is two-sided
  /// Of the main test: over subjects where `tests_subjects`, else exact over answers; NaN where the trials
  /// followed the answers.
  double p_value = 1.0;
  double p_greater = 1.0;  ///< P(X >= k), exact over answers, as if they were independent
  double p_two_sided = 1.0;
  std::size_t subjects = 0;
  /// Of the subjects' shares less chance, each counting once; none of one subject, nor where the trials
  /// followed the answers.
  std::optional<psychophysics::SignFlips> over_subjects;
  bool tests_subjects = false;  ///< there are enough of them for over_subjects to reach the level
  double p_adjusted = 1.0;      ///< the main one, within its family (all subjects, all tissues, all pairs)
  psychophysics::Interval interval;  ///< Clopper-Pearson
  psychophysics::Interval wilson;
  std::vector<TestPower> power;  ///< none of answers at levels, whose share right has no one truth
  std::optional<psychophysics::DPrime> d_prime;  ///< none of a preference, nor over several levels
  double excluded_d_prime = 0.0;  ///< with d_prime, of its mean over subjects; infinite where all are right
  double excluded_margin = 0.0;   ///< of a preference, about 50 %, likewise
  std::optional<GroupEquivalence> equivalence;  ///< where a margin was set
  std::string note;                             ///< why something is missing
};

/// A response bias: answers that prefer a slot.
struct SlotBias {
  std::vector<int> answers;                    ///< by slot
  std::vector<psychophysics::Count> right_in;  ///< right answers of the trials in which each slot was right
  psychophysics::Homogeneity test;  ///< are they as often right whichever slot is? Then there is no bias
  std::optional<psychophysics::Detection> detection;  ///< of two intervals: d' and criterion
  std::string note;                                   ///< why there is no test
};

/// How subjects differ, and what holds for those that they stand for.
struct SubjectSpread {
  std::size_t subjects = 0;
  psychophysics::Homogeneity equal;  ///< do all share one probability?
  /// Mean of the subjects' proportions with Student's interval and p against chance, one- or two-sided as the
  /// main test; none below three subjects, or where all are equal.
  struct Population {
    double mean = 0.0;
    psychophysics::Interval interval;
    double p_value = 1.0;                            ///< Student's
    std::optional<psychophysics::Interval> d_prime;  ///< what the interval is in d'
    double d_prime_of_mean = 0.0;
  };
  std::optional<Population> population;
  std::string note;
};

/// A judgement that counts: right, or for the first sample of its pair.
[[nodiscard]] bool is_success(const Study& study, const Judgement& judgement) noexcept;

/// The level's distance from the standard and back to a rightness: of a scale on both sides, whether the
/// stronger one was named.
[[nodiscard]] AnswerGroup answer_group(const Study& study, const std::vector<const Judgement*>& judgements,
                                       std::string name, const AnalysisOptions& options);
/// Of all answers also the trials that it takes.
void add_trials_needed(AnswerGroup& group, const AnalysisOptions& options);

[[nodiscard]] SlotBias slot_bias(const Study& study, const std::vector<const Judgement*>& judgements,
                                 const AnalysisOptions& options);
[[nodiscard]] SubjectSpread subject_spread(const Study& study, const std::vector<AnswerGroup>& subjects,
                                           const AnalysisOptions& options);

/// Adjusts the p values of a family.
void correct(std::vector<AnswerGroup>& family, const AnalysisOptions& options);

}  // namespace kerf::bench

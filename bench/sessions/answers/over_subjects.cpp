#include "answers/over_subjects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <kerf/psychophysics/comparisons.h>

#include "answers/analysis.h"

namespace kerf::bench {
namespace {

using psychophysics::Alternative;
using psychophysics::Count;
using psychophysics::Interval;

constexpr double infinite = std::numeric_limits<double>::infinity();

double share_of(Count count) { return static_cast<double>(count.successes) / count.trials; }

/// Of one kind of group: within which shares it counts as equal, and the exact test of one subject.
class Margin {
 public:
  Margin(const Study& study, const AnswerGroup& group, const AnalysisOptions& options)
      : study_(study), group_(group), options_(options) {}

  [[nodiscard]] bool is_of_d_prime() const { return group_.d_prime.has_value(); }
  [[nodiscard]] bool is_set() const {
    return is_of_d_prime() ? options_.d_prime_bound.has_value() : options_.margin.has_value();
  }

  /// is_set().
  [[nodiscard]] Interval shares() const {
    if (is_of_d_prime())
      return {.lower = -infinite,
              .upper = psychophysics::proportion_correct(*study_.task, *options_.d_prime_bound)};
    return {.lower = group_.chance - *options_.margin, .upper = group_.chance + *options_.margin};
  }

  /// is_set().
  [[nodiscard]] psychophysics::Equivalence of_one(Count count) const {
    return is_of_d_prime()
               ? psychophysics::below_d_prime(*study_.task, count, *options_.d_prime_bound, options_.level)
               : psychophysics::equivalent_proportion(count, group_.chance, *options_.margin, options_.level);
  }

  void exclude_from(Count count, AnswerGroup& group) const {
    if (is_of_d_prime()) {
      group.excluded_d_prime = std::max(group.excluded_d_prime,
                                        psychophysics::excluded_d_prime(*study_.task, count, options_.level));
    } else {
      group.excluded_margin = std::max(group.excluded_margin,
                                       psychophysics::excluded_margin(count, group_.chance, options_.level));
    }
  }

  void exclude_beyond(Interval shares, AnswerGroup& group) const {
    if (is_of_d_prime()) {
      group.excluded_d_prime = psychophysics::d_prime(*study_.task, std::min(1.0, shares.upper));
    } else {
      group.excluded_margin =
          std::min(group_.chance, std::max(shares.upper - group_.chance, group_.chance - shares.lower));
    }
  }

 private:
  const Study& study_;
  const AnswerGroup& group_;
  const AnalysisOptions& options_;
};

/// Their mean with an error no less than that of as many independent answers, which few subjects may fall
/// short of by chance, down to none where all have the same share.
psychophysics::Estimate mean_over(const SubjectCounts& subjects, Count all) {
  const auto n = static_cast<double>(subjects.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const Count& subject : subjects) {
    sum += share_of(subject);
    squares += share_of(subject) * share_of(subject);
  }
  const double mean = sum / n;
  const double between = std::max(0.0, squares - n * mean * mean) / (n - 1.0) / n;
  const double share = (all.successes + 0.5) / (all.trials + 1.0);  // never 0 or 1 by itself
  return {.value = mean,
          .standard_error = std::sqrt(std::max(between, share * (1.0 - share) / all.trials)),
          .degrees_of_freedom = n - 1.0};
}

bool is_one_beyond_chance(const AnswerGroup& group, const SubjectCounts& subjects, double level) {
  std::vector<double> p;
  for (const Count& subject : subjects)
    p.push_back(psychophysics::binomial_test(
        subject, group.chance, group.one_sided ? Alternative::greater : Alternative::two_sided));
  const std::vector<double> adjusted = psychophysics::holm(p);
  return *std::min_element(adjusted.begin(), adjusted.end()) <= level;
}

GroupEquivalence equivalence_of_each(const Margin& margin, const SubjectCounts& subjects) {
  GroupEquivalence result{.p = 0.0, .interval = {.lower = 1.0, .upper = 0.0}};
  for (const Count& subject : subjects) {
    const psychophysics::Equivalence one = margin.of_one(subject);
    result.p = std::max(result.p, one.p);
    result.interval.lower = std::min(result.interval.lower, one.interval.lower);
    result.interval.upper = std::max(result.interval.upper, one.interval.upper);
    result.subjects_shown += one.is_shown ? 1 : 0;
  }
  result.is_shown = result.subjects_shown == subjects.size();
  return result;
}

}  // namespace

SubjectCounts counts_by_subject(const Study& study, const std::vector<const Judgement*>& judgements) {
  std::map<std::string, std::size_t> places;
  SubjectCounts counts;
  for (const Judgement* judgement : judgements) {
    if (study.scale.two_sided() && judgement->level == 0.0) continue;  // neither is stronger
    const auto [place, is_new] = places.try_emplace(judgement->subject, counts.size());
    if (is_new) counts.emplace_back();
    Count& own = counts[place->second];
    ++own.trials;
    own.successes += is_success(study, *judgement) ? 1 : 0;
  }
  return counts;
}

void add_main_test(const Study& study, AnswerGroup& group, const SubjectCounts& subjects,
                   const AnalysisOptions& options) {
  group.p_value = group.one_sided ? group.p_greater : group.p_two_sided;
  group.subjects = subjects.size();
  if (subjects.size() < 2 || is_adaptive(study.design)) return;
  std::vector<double> beyond;
  for (const Count& subject : subjects) beyond.push_back(share_of(subject) - group.chance);
  group.over_subjects = psychophysics::flip_signs(beyond, {.seed = options.seed});
  // Of as many subjects as there are, not of those that by chance are at chance exactly.
  const double least = std::exp2((group.one_sided ? 0.0 : 1.0) - static_cast<double>(subjects.size()));
  group.tests_subjects = least <= options.whole_level();
  if (!group.tests_subjects) return;
  group.p_value = group.one_sided ? group.over_subjects->p_greater : group.over_subjects->p_two_sided;
}

void add_equivalence(const Study& study, AnswerGroup& group, const SubjectCounts& subjects,
                     const AnalysisOptions& options) {
  const Margin margin(study, group, options);
  if (subjects.size() < 3) {
    for (const Count& subject : subjects) margin.exclude_from(subject, group);
    if (margin.is_set()) group.equivalence = equivalence_of_each(margin, subjects);
    return;
  }
  const psychophysics::Estimate mean = mean_over(subjects, group.count);
  const Interval whole =
      psychophysics::equivalent_estimate(mean, {.lower = -1.0, .upper = 2.0}, options.level).interval;
  margin.exclude_beyond(whole, group);
  if (!margin.is_set()) return;
  const psychophysics::Equivalence of_mean =
      psychophysics::equivalent_estimate(mean, margin.shares(), options.level);
  GroupEquivalence result = equivalence_of_each(margin, subjects);
  result.p = of_mean.p;
  result.interval = of_mean.interval;
  result.subjects_differ =
      psychophysics::equal_proportions(subjects, {.seed = options.seed}).p <= options.whole_level() ||
      is_one_beyond_chance(group, subjects, options.whole_level());
  result.is_shown = of_mean.is_shown && !result.subjects_differ;
  group.equivalence = result;
}

}  // namespace kerf::bench

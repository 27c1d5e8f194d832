#include "answers/answer_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/psychophysics/comparisons.h>

#include "answers/analysis.h"
#include "answers/over_subjects.h"
#include "answers/two_rates.h"

namespace kerf::bench {
namespace {

using psychophysics::Alternative;
using psychophysics::Count;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double power_wanted = 0.8;

bool is_preference(const Study& study) { return study.design == Design::preference; }

double chance_of(const Study& study) { return study.task ? psychophysics::chance_of(*study.task) : 0.5; }

/// A d' belongs to one difference: not to answers at several levels.
bool is_one_level(const std::vector<const Judgement*>& judgements) {
  return std::all_of(judgements.begin(), judgements.end(), [&](const Judgement* judgement) {
    const double first = judgements.front()->level;
    return judgement->level == first || (std::isnan(judgement->level) && std::isnan(first));
  });
}

std::string counted_in(const Study& study, const std::vector<const Judgement*>& judgements) {
  if (!is_preference(study)) return "right";
  const std::size_t first = judgements.front()->pair[0];
  const bool is_same = std::all_of(judgements.begin(), judgements.end(), [&](const Judgement* judgement) {
    return judgement->pair == judgements.front()->pair;
  });
  if (is_same && first < study.samples.size()) return fmt::format("{} preferred", study.samples[first]);
  return "first of the pair preferred";
}

void add_sensitivity(const Study& study, const std::vector<const Judgement*>& judgements, AnswerGroup& group,
                     const SubjectCounts& subjects, const AnalysisOptions& options) {
  if (study.scale.two_sided() || !is_one_level(judgements)) {
    group.note = "no d' over several levels: the psychometric function has the sensitivity";
  } else if (!study.task) {
    group.note = "no d': the study does not say what its task is";
  } else if (has_two_rates(study.design)) {
    // A share of right answers would make a tendency to one of the words look like a smaller d'.
    group.excluded_d_prime = std::numeric_limits<double>::infinity();
    if (const auto found = detection_of(study, judgements, options)) {
      group.d_prime = psychophysics::DPrime{
          .value = found->d_prime, .standard_error = found->standard_error, .interval = found->interval};
    } else {
      group.note = "no d': it takes trials of both kinds";
    }
  } else {
    group.d_prime = psychophysics::estimate_d_prime(*study.task, group.count, options.confidence);
    add_equivalence(study, group, subjects, options);
  }
}

psychophysics::BinomialDesign design_of(const AnswerGroup& group, double truth,
                                        const AnalysisOptions& options) {
  return {.chance = group.chance,
          .truth = truth,
          .alternative = group.one_sided ? Alternative::greater : Alternative::two_sided,
          .level = options.level};
}

/// Of yes and no the d' of each subject, freed of its leaning, may be negative: their mean has no floor.
void add_mean_d_prime(const std::vector<AnswerGroup>& subjects, const AnalysisOptions& options,
                      SubjectSpread::Population& population) {
  double sum = 0.0;
  double squares = 0.0;
  for (const AnswerGroup& subject : subjects) {
    if (!subject.d_prime) return;
    sum += subject.d_prime->value;
    squares += subject.d_prime->value * subject.d_prime->value;
  }
  const auto n = static_cast<double>(subjects.size());
  const double mean = sum / n;
  const double variance = std::max(0.0, squares - n * mean * mean) / (n - 1.0);
  if (variance <= 1e-12) return;
  population.d_prime_of_mean = mean;
  population.d_prime =
      psychophysics::equivalent_estimate(
          {.value = mean, .standard_error = std::sqrt(variance / n), .degrees_of_freedom = n - 1.0},
          {.lower = -1.0, .upper = 1.0}, 0.5 * (1.0 - options.confidence))
          .interval;
}

/// Mean of proportions, which unlike a d' has no floor at chance that would lift it.
SubjectSpread::Population population_of(const Study& study, const std::vector<AnswerGroup>& subjects,
                                        double mean, double error, const AnalysisOptions& options) {
  const psychophysics::Estimate estimate{.value = mean,
                                         .standard_error = error,
                                         .degrees_of_freedom = static_cast<double>(subjects.size()) - 1.0};
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const double chance = subjects.front().chance;
  const auto tested = [&](double lower, double upper, double level) {
    return psychophysics::equivalent_estimate(estimate, {.lower = lower, .upper = upper}, level);
  };
  SubjectSpread::Population result{.mean = mean};
  const auto whole = tested(0.0, 1.0, 0.5 * (1.0 - options.confidence)).interval;
  result.interval = {.lower = std::max(0.0, whole.lower), .upper = std::min(1.0, whole.upper)};
  const double above = tested(chance, infinite, options.level).p;
  const double below = tested(-infinite, chance, options.level).p;
  result.p_value = subjects.front().one_sided ? above : std::min(1.0, 2.0 * std::min(above, below));
  if (study.task && subjects.front().d_prime && !has_two_rates(study.design)) {
    result.d_prime_of_mean = psychophysics::d_prime(*study.task, mean);
    result.d_prime = {.lower = psychophysics::d_prime(*study.task, result.interval.lower),
                      .upper = psychophysics::d_prime(*study.task, result.interval.upper)};
  }
  if (study.design == Design::yes_no) add_mean_d_prime(subjects, options, result);
  return result;
}

}  // namespace

bool is_success(const Study& study, const Judgement& judgement) noexcept {
  if (is_preference(study)) return !judgement.is_right();  // right is the slot of the second sample
  if (study.scale.two_sided()) return judgement.is_right() == (judgement.level > 0.0);
  return judgement.is_right();
}

AnswerGroup answer_group(const Study& study, const std::vector<const Judgement*>& judgements,
                         std::string name, const AnalysisOptions& options) {
  AnswerGroup group{.name = std::move(name),
                    .counted = counted_in(study, judgements),
                    .chance = chance_of(study),
                    .one_sided = !is_preference(study)};
  for (const Judgement* judgement : judgements) {
    if (study.scale.two_sided() && judgement->level == 0.0) continue;  // neither is stronger
    ++group.count.trials;
    group.count.successes += is_success(study, *judgement) ? 1 : 0;
  }
  if (group.count.trials == 0) throw std::invalid_argument("there are no answers that are right or wrong");
  group.p_greater = psychophysics::binomial_test(group.count, group.chance, Alternative::greater);
  group.p_two_sided = psychophysics::binomial_test(group.count, group.chance, Alternative::two_sided);
  const SubjectCounts subjects = counts_by_subject(study, judgements);
  add_main_test(study, group, subjects, options);
  group.interval = psychophysics::clopper_pearson(group.count, options.confidence);
  group.wilson = psychophysics::wilson(group.count, options.confidence);
  for (const double truth : has_levels(study.design) ? std::vector<double>() : options.truths) {
    group.power.push_back(
        {.truth = truth,
         .power = psychophysics::binomial_power(design_of(group, truth, options), group.count.trials)});
  }
  if (is_preference(study)) {
    add_equivalence(study, group, subjects, options);
  } else {
    add_sensitivity(study, judgements, group, subjects, options);
  }
  if (ends_by_answers(study.design, study.scale)) {
    group.p_value = group.p_greater = group.p_two_sided = not_a_number;
    group.note = fmt::format(
        "no test of the count: how many trials {} takes, and how hard they are, follows the answers",
        study.design == Design::staircase ? "a staircase" : "QUEST+ that ends by an interval");
  }
  group.p_adjusted = group.p_value;
  return group;
}

void add_trials_needed(AnswerGroup& group, const AnalysisOptions& options) {
  for (TestPower& power : group.power) {
    if (std::abs(power.truth - group.chance) < 0.01 || (group.one_sided && power.truth < group.chance))
      continue;
    power.trials_needed =
        psychophysics::trials_for_power(design_of(group, power.truth, options), power_wanted);
  }
}

SlotBias slot_bias(const Study& study, const std::vector<const Judgement*>& judgements,
                   const AnalysisOptions& options) {
  SlotBias bias;
  if (!study.slots_known) {
    bias.note = "which slot held which sample is not known";
    return bias;
  }
  const std::size_t slots = study.design == Design::three_interval ? 3 : 2;
  bias.answers.assign(slots, 0);
  bias.right_in.assign(slots, Count{});
  for (const Judgement* judgement : judgements) {
    if (judgement->answer >= slots || judgement->right >= slots)
      throw std::invalid_argument(fmt::format("subject {}: slot {} was answered and {} right, of {} slots",
                                              judgement->subject, judgement->answer, judgement->right,
                                              slots));
    ++bias.answers[judgement->answer];
    Count& here = bias.right_in[judgement->right];
    ++here.trials;
    here.successes += judgement->is_right() ? 1 : 0;
  }
  const bool has_all = std::all_of(bias.right_in.begin(), bias.right_in.end(),
                                   [](const Count& count) { return count.trials > 0; });
  if (!has_all) {
    bias.note = has_two_rates(study.design) ? "one of the answers was never right"
                                            : "one slot was never the right one";
    return bias;
  }
  bias.test = psychophysics::equal_proportions(bias.right_in, {.seed = options.seed});
  if (has_two_rates(study.design)) bias.detection = detection_of(study, judgements, options);
  if (study.design == Design::two_interval) {
    const Count in_second = bias.right_in[1];
    bias.detection = psychophysics::two_interval(
        bias.right_in[0], {.successes = in_second.trials - in_second.successes, .trials = in_second.trials},
        psychophysics::Correction::extremes, options.confidence);
  }
  return bias;
}

SubjectSpread subject_spread(const Study& study, const std::vector<AnswerGroup>& subjects,
                             const AnalysisOptions& options) {
  SubjectSpread spread{.subjects = subjects.size()};
  std::vector<Count> counts;
  double sum = 0.0;
  double squares = 0.0;
  for (const AnswerGroup& subject : subjects) {
    counts.push_back(subject.count);
    const double share = static_cast<double>(subject.count.successes) / subject.count.trials;
    sum += share;
    squares += share * share;
  }
  spread.equal = psychophysics::equal_proportions(counts, {.seed = options.seed});
  const auto n = static_cast<double>(subjects.size());
  if (subjects.size() < 3) {
    spread.note = "fewer than three subjects: nothing can be said of the people that they stand for";
    return spread;
  }
  const double mean = sum / n;
  const double variance = (squares - n * mean * mean) / (n - 1.0);
  if (is_adaptive(study.design)) {
    spread.note = "an adaptive rule holds every subject at much the same share of right answers";
  } else if (variance <= 1e-12) {
    spread.note = "all subjects have the same share, which gives Student's interval no width";
  } else {
    spread.population = population_of(study, subjects, mean, std::sqrt(variance / n), options);
  }
  return spread;
}

void correct(std::vector<AnswerGroup>& family, const AnalysisOptions& options) {
  std::vector<double> p;
  for (const AnswerGroup& group : family) {
    if (std::isnan(group.p_value)) return;
    p.push_back(group.p_value);
  }
  const auto adjusted = options.correction == FamilyCorrection::holm ? psychophysics::holm(p)
                                                                     : psychophysics::benjamini_hochberg(p);
  for (std::size_t i = 0; i < family.size(); ++i) family[i].p_adjusted = adjusted[i];
}

}  // namespace kerf::bench

#include "answers/two_rates.h"

#include <stdexcept>

#include <fmt/core.h>

#include <kerf/psychophysics/detection/same_different.h>

#include "answers/analysis.h"

namespace kerf::bench {
namespace {

using psychophysics::Decision;

psychophysics::SameRule rule_of(const psychophysics::Task& task) {
  return task.decision == Decision::same_different_differencing ? psychophysics::SameRule::differencing
                                                                : psychophysics::SameRule::likelihood;
}

}  // namespace

TwoRates two_rates_of(const std::vector<const Judgement*>& judgements) {
  TwoRates rates;
  for (const Judgement* judgement : judgements) {
    if (judgement->answer > 1 || judgement->right > 1) {
      throw std::invalid_argument(fmt::format("subject {}: answer {} and right {} are not one of two",
                                              judgement->subject, judgement->answer, judgement->right));
    }
    psychophysics::Count& count = judgement->right == 1 ? rates.hits : rates.false_alarms;
    ++count.trials;
    count.successes += judgement->answer == 1 ? 1 : 0;
  }
  return rates;
}

std::optional<psychophysics::Detection> detection_of(const Study& study,
                                                     const std::vector<const Judgement*>& judgements,
                                                     const AnalysisOptions& options) {
  const auto [hits, false_alarms] = two_rates_of(judgements);
  if (hits.trials == 0 || false_alarms.trials == 0) return std::nullopt;
  constexpr auto correction = psychophysics::Correction::extremes;
  if (study.design == Design::yes_no)
    return psychophysics::yes_no(hits, false_alarms, correction, options.confidence);
  return psychophysics::same_different(
      rule_of(study.task.value_or(psychophysics::Task{Decision::same_different})), hits, false_alarms,
      correction, options.confidence);
}

double d_prime_of_rates(const psychophysics::Task& task, double hit, double false_alarm) {
  if (task.decision == Decision::yes_no) return psychophysics::yes_no_d_prime(hit, false_alarm);
  return psychophysics::same_different_d_prime(rule_of(task), {.hit = hit, .false_alarm = false_alarm});
}

}  // namespace kerf::bench

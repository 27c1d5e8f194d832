#include "observers/simulated_looks.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "answers/look_decision.h"

namespace kerf::bench {
namespace {

/// The judgements of the first subjects.
Study of_first(const Study& whole, std::size_t subjects) {
  Study part = whole;
  part.judgements.clear();
  std::set<std::string> seen;
  for (const Judgement& each : whole.judgements) {
    if (!seen.contains(each.subject) && seen.size() == subjects) continue;
    seen.insert(each.subject);
    part.judgements.push_back(each);
  }
  return part;
}

}  // namespace

std::vector<Look> planned_looks(const Experiment& experiment, bool two_sided) {
  const std::vector<std::size_t> at = experiment.planned_looks();
  const std::vector<LookLevel> levels = look_levels(experiment, at, two_sided);
  std::vector<Look> looks;
  for (std::size_t i = 0; i < at.size(); ++i) {
    looks.push_back({.number = i + 1,
                     .is_last = i + 1 == at.size(),
                     .participants = std::vector<std::string>(at[i]),
                     .reason = {},
                     .spent = levels[i].spent,
                     .nominal = levels[i].nominal});
  }
  return looks;
}

StudyCourse course_of(const Study& whole, const Experiment& experiment, const std::vector<Look>& looks,
                      const AnalysisOptions& options) {
  AnalysisOptions test_alone = options;
  test_alone.curves = false;
  StudyCourse course;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const Study part = of_first(whole, looks[i].participants.size());
    const MainResult result = main_result(part, options_at(experiment.analysis, looks[i], test_alone));
    const LookDecision decision =
        decide(part, experiment, looks[i], {.p_value = result.p_value, .equivalent = result.equivalent});
    course.look = i;
    course.is_shown = decision.is_shown;
    course.is_none =
        decision.bayes_factor && *decision.bayes_factor <= 1.0 / experiment.analysis.stopping.evidence;
    if (decision.ends) break;
  }
  return course;
}

}  // namespace kerf::bench

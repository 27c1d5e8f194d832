#include "dataset/registration_text.h"

#include <algorithm>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "answer_pages/experiment_words.h"

namespace kerf::bench {
namespace {

std::string stopping_in_words(const Experiment& experiment) {
  const StoppingRule& rule = experiment.analysis.stopping;
  if (rule.kind == StoppingKind::fixed) return "one analysis, when everybody was through";
  const auto looks = fmt::format("looks at {} participants", fmt::join(experiment.planned_looks(), ", "));
  if (rule.kind == StoppingKind::bayes_factor)
    return fmt::format("a Bayes factor of {:g} or one over it, {}", rule.evidence, looks);
  return fmt::format("alpha spending ({}), {}", name_of(rule.spending), looks);
}

std::string exclusions_in_words(const ExclusionPlan& rules) {
  std::vector<std::string> all;
  if (rules.faulty)
    all.push_back(fmt::format("a fault in more than {:g} % of the trials", 100.0 * *rules.faulty));
  if (rules.unfelt)
    all.push_back(fmt::format("a rendering that was not felt in more than {:g} % of the trials",
                              100.0 * *rules.unfelt));
  if (rules.catch_right)
    all.push_back(fmt::format("less than {:g} % of the catch trials right", 100.0 * *rules.catch_right));
  all.insert(all.end(), rules.rules.begin(), rules.rules.end());
  return all.empty() ? "nobody was to be left out of the analysis"
                     : fmt::format("left out of the analysis: {}", fmt::join(all, "; "));
}

std::string margins_in_words(const AnalysisPlan& plan) {
  std::string text;
  if (plan.margin) text += fmt::format(", 50 % +- {:g} %", 100.0 * *plan.margin);
  if (plan.d_prime) text += fmt::format(", d' below {:g}", *plan.d_prime);
  if (plan.jnd_margins)
    text += fmt::format(", a JND from {:g} to {:g}", plan.jnd_margins->lower, plan.jnd_margins->upper);
  return text;
}

}  // namespace

std::string registration_text(const DatasetExperiment& of) {
  const Experiment& experiment = of.state.experiment;
  const AnalysisPlan& plan = experiment.analysis;
  const ParticipantPlan& people = experiment.participants;
  std::string text = fmt::format(
      "The plan was registered at {} and sealed with each session before it began "
      "(materials/experiment.toml, "
      "documentation/experiment.log): {} participants",
      of.registered_at, people.target);
  if (!people.groups.empty()) text += fmt::format(" in the groups {}", fmt::join(people.groups, ", "));
  if (people.visits > 1) text += fmt::format(", {} sessions each", people.visits);
  text += fmt::format("; primary test: {}{}, alpha = {:g}; stopping rule: {}; {}.\n\n", name_of(plan.test),
                      margins_in_words(plan), plan.alpha, stopping_in_words(experiment),
                      exclusions_in_words(plan.exclude));
  for (const std::string& line : flow_lines(of.state, flow_of(of.state)))
    text += fmt::format("- {}\n", line.substr(std::min(line.find_first_not_of(' '), line.size())));
  text += '\n';
  if (of.state.looks.empty())
    text += "The answers had not been looked at as registered when this was written.";
  for (std::size_t i = 0; i < of.state.looks.size(); ++i) {
    const PastLook& look = of.state.looks[i];
    text +=
        fmt::format("{}Look {} at {} participants ({}){}", i == 0 ? "" : " ", i + 1, look.participants.size(),
                    look.time, look.paid ? "." : fmt::format(", in no registered rule: {}.", look.reason));
  }
  for (const std::string& opening : of.state.openings) text += fmt::format("\n- {}", opening);
  for (const std::string& problem : of.state.problems) text += fmt::format("\n- {}", problem);
  return text +
         "\n\nWhere an analysis departs from the plan, its own report says so (`kerf session analyze`).";
}

}  // namespace kerf::bench

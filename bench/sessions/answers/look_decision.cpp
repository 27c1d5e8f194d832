#include "answers/look_decision.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <kerf/psychophysics/sequential/bayes_factor.h>

#include "answers/analysis.h"
#include "answers/over_subjects.h"

namespace kerf::bench {
namespace {

/// Sentences have a level even where a look may spend none: one that nothing reaches.
constexpr double next_to_nothing = 1e-9;

double factor_of(const Study& study) {
  std::vector<const Judgement*> counted;
  for (const Judgement& each : study.judgements) {
    if (each.counts()) counted.push_back(&each);
  }
  const double chance = study.task ? psychophysics::chance_of(*study.task) : 0.5;
  std::vector<double> beyond;
  for (const psychophysics::Count& count : counts_by_subject(study, counted))
    beyond.push_back(static_cast<double>(count.successes) / count.trials - chance);
  if (beyond.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  return psychophysics::bayes_factor(beyond, {.positive_alone = study.design != Design::preference});
}

void decide_by_evidence(const Study& study, double evidence, const Look& look, LookDecision& decision) {
  const double factor = factor_of(study);
  decision.bayes_factor = factor;
  decision.is_shown = factor >= evidence;
  decision.ends = look.is_last || factor >= evidence || factor <= 1.0 / evidence;
  if (std::isnan(factor)) {
    decision.text = "there is no Bayes factor: all participants have the same share";
  } else if (factor <= 1.0 / evidence) {
    decision.text =
        fmt::format("no difference: the Bayes factor for one is {:.3g}, at most 1/{:g}", factor, evidence);
  } else {
    decision.text = fmt::format("{}: the Bayes factor is {:.3g}, and {:g} was registered",
                                decision.is_shown ? "a difference" : "undecided", factor, evidence);
  }
}

std::string alpha_text(const Experiment& experiment, const Look& look) {
  const AnalysisPlan& plan = experiment.analysis;
  if (plan.stopping.kind == StoppingKind::fixed) return fmt::format("alpha {:.3g}", plan.alpha);
  return fmt::format("{:.3g} of this look, {:.3g} of alpha {:.3g} spent", look.nominal, look.spent,
                     plan.alpha);
}

void decide_by_level(const Experiment& experiment, const Look& look, const PrimaryFigures& figures,
                     LookDecision& decision) {
  const bool of_difference = experiment.analysis.test == PrimaryTest::difference;
  const bool reaches = of_difference ? figures.p_value <= look.nominal
                                     : figures.equivalent.value_or(false) && look.nominal > 0.0;
  decision.is_shown = look.is_paid && reaches;
  const bool may_end = experiment.analysis.stopping.kind == StoppingKind::alpha_spending;
  decision.ends = look.is_last || (may_end && decision.is_shown);
  const char* what = of_difference ? "a difference" : "an equivalence";
  if (!look.is_paid) {
    decision.text = fmt::format("this look decides nothing: no alpha was registered for it");
  } else if (of_difference && std::isnan(figures.p_value)) {
    decision.text = "the primary test has no p value";
  } else {
    decision.text = fmt::format("{} is {}shown{} ({})", what, decision.is_shown ? "" : "not ",
                                of_difference ? fmt::format(": p = {:.3g}", figures.p_value) : "",
                                alpha_text(experiment, look));
  }
}

}  // namespace

PrimaryFigures primary_figures(const Analysis& analysis) {
  PrimaryFigures figures{.p_value = analysis.p_value};
  if (analysis.levels) {
    const LevelAnalysis& levels = *analysis.levels;
    figures.equivalent = levels.people ? levels.people->jnd_within : levels.pooled.jnd_within;
  } else if (analysis.all && analysis.all->equivalence) {
    figures.equivalent = analysis.all->equivalence->is_shown;
  }
  return figures;
}

LookDecision decide(const Study& study, const Experiment& experiment, const Look& look,
                    const PrimaryFigures& figures) {
  LookDecision decision{.p_value = figures.p_value};
  const StoppingRule& rule = experiment.analysis.stopping;
  if (rule.kind == StoppingKind::bayes_factor) {
    decide_by_evidence(study, rule.evidence, look, decision);
  } else {
    decide_by_level(experiment, look, figures, decision);
  }
  if (rule.kind != StoppingKind::fixed)
    decision.text += decision.ends ? "; the study ends" : "; the study goes on";
  return decision;
}

AnalysisOptions options_at(const AnalysisPlan& plan, const Look& look, AnalysisOptions options) {
  options.alpha = plan.alpha;
  options.level = std::max(next_to_nothing, look.nominal);
  options.margin = plan.margin;
  options.d_prime_bound = plan.d_prime;
  options.jnd_margins = plan.jnd_margins;
  return options;
}

}  // namespace kerf::bench

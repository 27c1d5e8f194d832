#include "answers/level_analysis.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/psychophysics/posterior.h>

#include "answers/analysis.h"
#include "answers/two_sided_fit.h"

namespace kerf::bench {
namespace {

using psychophysics::Axis;
using psychophysics::FitOptions;
using psychophysics::Level;
using psychophysics::PsychometricFit;
using psychophysics::Shape;
using psychophysics::Threshold;

using Answers = std::vector<const Judgement*>;

/// One row a level.
std::vector<Level> rows_of(const Study& study, const Answers& judgements) {
  std::vector<Level> rows;
  for (const Judgement* judgement : judgements) {
    const double at = intensity_of(study, *judgement);
    auto row = std::find_if(rows.begin(), rows.end(), [&](const Level& level) {
      return std::abs(level.intensity - at) <= 1e-9 * std::max(1e-3, std::abs(at));
    });
    if (row == rows.end()) row = rows.insert(rows.end(), {.intensity = at});
    ++row->answers.trials;
    row->answers.successes += judgement->is_right() ? 1 : 0;
  }
  std::sort(rows.begin(), rows.end(),
            [](const Level& a, const Level& b) { return a.intensity < b.intensity; });
  return rows;
}

struct Question {
  bool two_sided = false;
  bool adaptive = false;
  const AnalysisOptions* options = nullptr;
  FitOptions fit;
};

Question question_of(const Study& study, const AnalysisOptions& options) {
  Question question{
      .two_sided = study.scale.two_sided(), .adaptive = is_adaptive(study.design), .options = &options};
  FitOptions& fit = question.fit;
  fit.shape = study.scale.shape;
  fit.guess = study.task ? psychophysics::chance_of(*study.task) : 0.5;
  fit.lapse = options.lapse;
  fit.criterion = options.criterion;
  fit.confidence = options.confidence;
  if (question.two_sided) {
    if (fit.shape == Shape::weibull) fit.shape = Shape::gaussian;  // its axis is a logarithm
    fit.axis = Axis::linear;
    fit.guess = 0.0;
    fit.criterion = 0.5;
  }
  return question;
}

PsychometricFit fitted(const Question& question, const std::vector<Level>& rows, const FitOptions& options) {
  return question.two_sided ? fit_with_equal_lapses(rows, options)
                            : psychophysics::fit_psychometric(rows, options);
}

Threshold jnd_of(const PsychometricFit& fit, bool two_sided) {
  return two_sided ? psychophysics::half_interquartile(fit) : fit.threshold;
}

/// Several subjects after an adaptive design have no posterior: it does not know that they differ.
bool by_posterior(const Question& question) { return question.adaptive && !question.fit.overdispersed; }

std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

/// Nothing that the answers do not bound where no level was shown is an estimate.
std::optional<Threshold> bounded(const Threshold& found, const char* name, double least, double most,
                                 std::vector<std::string>& notes) {
  const bool is_open_above = !std::isfinite(found.interval.upper);
  const bool is_open_below = found.interval.lower <= 0.0 && least > 0.0;
  const bool no_lower = !std::isfinite(found.interval.lower);
  if (!std::isfinite(found.value) || (is_open_above && (found.value > most || is_open_below || no_lower))) {
    notes.push_back(found.interval.lower > 0.0
                        ? fmt::format("no {}: the answers only say that it is above {}", name,
                                      percent(found.interval.lower))
                        : fmt::format("no {}: the answers bound it neither above nor below", name));
    return std::nullopt;
  }
  if ((is_open_below || no_lower) && found.value < least) {
    notes.push_back(
        fmt::format("no {}: the answers only say that it is below {}", name, percent(found.interval.upper)));
    return std::nullopt;
  }
  if (is_open_above) notes.push_back(fmt::format("the answers do not bound the {} from above", name));
  if (is_open_below || no_lower)
    notes.push_back(fmt::format("the answers do not bound the {} from below", name));
  if (found.value > most || found.value < least)
    notes.push_back(fmt::format("the {} lies beyond the levels that were shown", name));
  return found;
}

void add_thresholds(LevelFit& result, const std::vector<Level>& rows, const Question& question) {
  const double least = result.points.front().intensity;
  const double most = result.points.back().intensity;
  const PsychometricFit& fit = *result.fit;
  if (question.two_sided) {
    result.equality = bounded(fit.threshold, "PSE", least, most, result.notes);
    result.jnd = bounded(jnd_of(fit, true), "JND", 0.0, 2.0 * (most - least), result.notes);
  } else {
    result.by_posterior = by_posterior(question);
    const Threshold jnd =
        result.by_posterior ? psychophysics::posterior_threshold(rows, question.fit) : jnd_of(fit, false);
    result.jnd = bounded(jnd, "JND", least, most, result.notes);
  }
  if (fit.slope_at_bound)
    result.notes.emplace_back("the answers do not say a slope: they fit a step or a flat line");
}

/// The interval of an equivalence test is one of 1 - 2 level.
std::optional<bool> within_margins(const Question& question, const std::vector<Level>& rows) {
  if (!question.options->jnd_margins) return std::nullopt;
  FitOptions options = question.fit;
  options.confidence = 1.0 - 2.0 * question.options->level;
  const Threshold jnd = by_posterior(question) ? psychophysics::posterior_threshold(rows, options)
                                               : jnd_of(fitted(question, rows, options), question.two_sided);
  return psychophysics::lies_within(jnd.interval, *question.options->jnd_margins);
}

/// Without a curve where no curve can be told.
std::string why_no_curve(const std::vector<Level>& points, bool two_sided) {
  int right = 0;
  int trials = 0;
  for (const Level& level : points) {
    right += level.answers.successes;
    trials += level.answers.trials;
  }
  if (points.size() < 2) {
    return fmt::format("no psychometric function: all answers are at one level, {}",
                       points.empty() ? std::string("of none") : percent(points.front().intensity));
  }
  if (two_sided && (right == 0 || right == trials))
    return "no psychometric function: all answers name the same sample, whatever the level";
  if (right == trials)
    return fmt::format("no JND: all {} answers are right, so that it lies below the levels shown", trials);
  if (right == 0) return "no JND: no answer is right; do the answers mean what the table says?";
  return {};
}

LevelFit level_fit(const Study& study, const Answers& judgements, const std::vector<Level>& rows,
                   std::string name, const Question& question, bool thorough) {
  LevelFit result{.name = std::move(name), .points = rows_of(study, judgements)};
  if (auto why = why_no_curve(result.points, question.two_sided); !why.empty()) {
    result.notes.push_back(std::move(why));
    return result;
  }
  try {
    result.fit = fitted(question, rows, question.fit);
    add_thresholds(result, rows, question);
    if (result.jnd) result.jnd_within = within_margins(question, rows);
    if (thorough && question.options->bootstrap > 0) {
      FitOptions options = question.fit;
      if (question.two_sided) {
        options.guess = result.fit->curve.guess;
        options.lapse = result.fit->curve.lapse;
      }
      result.bootstrap =
          psychophysics::bootstrap(*result.fit, rows, options,
                                   {.samples = question.options->bootstrap, .seed = question.options->seed});
    }
  } catch (const std::invalid_argument& refused) {
    result.notes.push_back(fmt::format("no psychometric function: {}", refused.what()));
  }
  return result;
}

/// Answers of a level together, as binomial: what tells shapes apart is the course of the mean.
void compare_shapes(LevelAnalysis& analysis, const Question& question) {
  std::vector<Shape> shapes{analysis.shape};
  for (const Shape shape : {Shape::weibull, Shape::logistic, Shape::gaussian}) {
    if (shape != analysis.shape && (shape != Shape::weibull || analysis.axis == Axis::logarithmic))
      shapes.push_back(shape);
  }
  for (const Shape shape : shapes) {
    Question trial = question;
    trial.fit.shape = shape;
    trial.fit.overdispersed = false;
    const PsychometricFit fit = fitted(trial, analysis.pooled.points, trial.fit);
    const int parameters = question.options->lapse ? 2 : 3;
    analysis.shapes.push_back({.shape = shape,
                               .parameters = parameters,
                               .log_likelihood = fit.log_likelihood,
                               .deviance = fit.deviance,
                               .aic = 2.0 * parameters - 2.0 * fit.log_likelihood,
                               .jnd = jnd_of(fit, question.two_sided).value});
  }
}

std::optional<psychophysics::AcrossSubjects> mean_of(const std::vector<LevelFit>& subjects, double confidence,
                                                     bool of_equality, std::vector<std::string>& notes) {
  std::vector<PsychometricFit> fits;
  for (const LevelFit& subject : subjects) {
    const auto& found = of_equality ? subject.equality : subject.jnd;
    if (!found) {
      notes.push_back(
          fmt::format("no mean {} of the subjects: {} has none", of_equality ? "PSE" : "JND", subject.name));
      return std::nullopt;
    }
    // A JND is a ratio, and so is its mean, whatever the axis of the curve that it comes from.
    PsychometricFit& fit = fits.emplace_back(*subject.fit);
    fit.threshold = *found;
    fit.curve.axis = of_equality ? Axis::linear : Axis::logarithmic;
  }
  return psychophysics::across_subjects(fits, confidence);
}

std::optional<PeopleFit> fit_people(const std::vector<std::vector<Level>>& subjects, const Question& question,
                                    std::vector<std::string>& notes) {
  try {
    const psychophysics::MixedOptions options{.shape = question.fit.shape,
                                              .axis = question.fit.axis,
                                              .guess = question.fit.guess,
                                              .two_sided = question.two_sided,
                                              .lapse = question.fit.lapse,
                                              .criterion = question.fit.criterion};
    PeopleFit people{.fit = psychophysics::fit_mixed(subjects, options)};
    people.jnd = question.two_sided ? psychophysics::half_interquartile(people.fit, options.shape)
                                    : people.fit.threshold;
    if (question.two_sided) people.equality = people.fit.threshold;
    if (question.options->jnd_margins)
      people.jnd_within = psychophysics::lies_within(people.jnd.interval(1.0 - 2.0 * question.options->level),
                                                     *question.options->jnd_margins);
    return people;
  } catch (const std::invalid_argument& refused) {
    notes.push_back(fmt::format("no JND of people: {}", refused.what()));
    return std::nullopt;
  }
}

}  // namespace

double intensity_of(const Study& study, const Judgement& judgement) noexcept {
  return study.scale.two_sided() ? judgement.level : std::abs(judgement.level);
}

LevelAnalysis analyse_levels(const Study& study, const std::vector<const Judgement*>& judgements,
                             const AnalysisOptions& options, bool thorough) {
  for (const Judgement* judgement : judgements) {
    if (!std::isfinite(judgement->level)) {
      throw std::invalid_argument(
          fmt::format("{}: an answer of subject {} has no level; the design '{}' needs one", study.name,
                      judgement->subject, name_of(study.design)));
    }
  }
  Question question = question_of(study, options);
  LevelAnalysis analysis{.two_sided = question.two_sided,
                         .axis = question.fit.axis,
                         .shape = question.fit.shape,
                         .guess = question.fit.guess};
  std::vector<std::string> subjects;
  for (const Judgement* judgement : judgements) {
    if (std::find(subjects.begin(), subjects.end(), judgement->subject) == subjects.end())
      subjects.push_back(judgement->subject);
  }
  std::vector<Level> rows;
  std::vector<std::vector<Level>> rows_by_subject;
  for (const std::string& subject : subjects) {
    Answers own;
    std::copy_if(judgements.begin(), judgements.end(), std::back_inserter(own),
                 [&](const Judgement* judgement) { return judgement->subject == subject; });
    const std::vector<Level> own_rows = rows_of(study, own);
    rows.insert(rows.end(), own_rows.begin(), own_rows.end());
    rows_by_subject.push_back(own_rows);
    if (thorough && subjects.size() > 1)
      analysis.by_subject.push_back(level_fit(study, own, own_rows, subject, question, thorough));
  }
  question.fit.overdispersed = subjects.size() > 1;
  analysis.pooled = level_fit(study, judgements, rows, "all", question, thorough);
  if (subjects.size() >= 3 && !question.adaptive && analysis.pooled.fit)
    analysis.people = fit_people(rows_by_subject, question, analysis.notes);
  if (!thorough) return analysis;
  if (analysis.pooled.fit) compare_shapes(analysis, question);
  if (subjects.size() >= 3) {
    analysis.across = mean_of(analysis.by_subject, options.confidence, false, analysis.notes);
    if (analysis.two_sided)
      analysis.across_equality = mean_of(analysis.by_subject, options.confidence, true, analysis.notes);
  } else if (subjects.size() == 2) {
    analysis.notes.emplace_back("no mean of the subjects: two are too few to say how far subjects differ");
  }
  return analysis;
}

}  // namespace kerf::bench

#include "answer_pages/levels_json.h"

#include <optional>
#include <utility>

#include "answer_pages/analysis_words.h"
#include "files/json_number.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json threshold_as_json(const std::optional<psychophysics::Threshold>& threshold, const char* definition) {
  if (!threshold) return nullptr;
  return {{"value", json_number(threshold->value)},
          {"ci95", pair_of(threshold->interval)},
          {"criterion", threshold->criterion},
          {"definition", definition},
          {"unit", "1 (fraction of the standard)"}};
}

json curve_as_json(const psychophysics::PsychometricFit& fit) {
  return {{"shape", name_of(fit.curve.shape)},
          {"axis", fit.curve.axis == psychophysics::Axis::linear ? "linear" : "logarithmic"},
          {"threshold", json_number(fit.curve.threshold)},
          {"slope", json_number(fit.slope)},
          {"slope_ci95", pair_of(fit.slope_interval)},
          {"guess", fit.curve.guess},
          {"lapse", json_number(fit.curve.lapse)},
          {"log_likelihood", json_number(fit.log_likelihood)},
          {"deviance", json_number(fit.deviance)},
          {"freedom", fit.degrees_of_freedom},
          {"overdispersion", json_number(fit.overdispersion)},
          {"overdispersion_p", json_number(fit.overdispersion_p)}};
}

json level_fit_as_json(const LevelFit& fit, bool two_sided) {
  json points = json::array();
  for (const psychophysics::Level& level : fit.points) {
    points.push_back(
        {{"level", level.intensity}, {"count", level.answers.successes}, {"trials", level.answers.trials}});
  }
  json result{{"name", fit.name},
              {"jnd", threshold_as_json(fit.jnd, two_sided ? "half the way from 25 to 75 %"
                                                 : fit.by_posterior
                                                     ? "level at the criterion, median of the posterior"
                                                     : "level at the criterion")},
              {"pse", threshold_as_json(fit.equality, "level at 50 %")},
              {"jnd_within_margins", fit.jnd_within ? json(*fit.jnd_within) : json(nullptr)},
              {"curve", fit.fit ? curve_as_json(*fit.fit) : json(nullptr)},
              {"bootstrap", nullptr},
              {"points", std::move(points)},
              {"notes", fit.notes}};
  if (fit.bootstrap) {
    result["bootstrap"] = {{"samples", fit.bootstrap->samples},
                           {"threshold_ci95", pair_of(fit.bootstrap->threshold)},
                           {"slope_ci95", pair_of(fit.bootstrap->slope)},
                           {"deviance_p", json_number(fit.bootstrap->deviance_p)}};
  }
  return result;
}

json across_as_json(const std::optional<psychophysics::AcrossSubjects>& across) {
  if (!across) return nullptr;
  return {{"mean", json_number(across->mean)},
          {"ci95", pair_of(across->interval)},
          {"deviation", json_number(across->deviation)}};
}

json of_people_as_json(const psychophysics::OfPeople& found, double confidence) {
  return {{"value", json_number(found.mean)},
          {"ci95", pair_of(found.interval(confidence))},
          {found.is_ratio ? "deviation_of_log" : "deviation", json_number(found.deviation)},
          {"unit", "1 (fraction of the standard)"}};
}

json people_as_json(const std::optional<PeopleFit>& people, double confidence) {
  if (!people) return nullptr;
  json slope = of_people_as_json(people->fit.slope, confidence);
  slope.erase("unit");
  return {{"model", "mixed, adaptive quadrature"},
          {"subjects", people->fit.subjects},
          {"jnd", of_people_as_json(people->jnd, confidence)},
          {"pse", people->equality ? of_people_as_json(*people->equality, confidence) : json(nullptr)},
          {"slope", std::move(slope)},
          {"correlation", json_number(people->fit.correlation)},
          {"lapse", people->fit.lapse},
          {"log_likelihood", json_number(people->fit.log_likelihood)},
          {"jnd_within_margins", people->jnd_within ? json(*people->jnd_within) : json(nullptr)}};
}

}  // namespace

nlohmann::ordered_json pair_of(psychophysics::Interval interval) {
  return json::array({json_number(interval.lower), json_number(interval.upper)});
}

nlohmann::ordered_json levels_as_json(const LevelAnalysis& levels, double confidence) {
  json result{{"two_sided", levels.two_sided},
              {"all", level_fit_as_json(levels.pooled, levels.two_sided)},
              {"by_subject", json::array()},
              {"people", people_as_json(levels.people, confidence)},
              {"mean_jnd", across_as_json(levels.across)},
              {"mean_pse", across_as_json(levels.across_equality)},
              {"shapes", json::array()},
              {"notes", levels.notes}};
  for (const LevelFit& subject : levels.by_subject)
    result["by_subject"].push_back(level_fit_as_json(subject, levels.two_sided));
  for (const ShapeFit& shape : levels.shapes) {
    result["shapes"].push_back({{"shape", name_of(shape.shape)},
                                {"parameters", shape.parameters},
                                {"log_likelihood", json_number(shape.log_likelihood)},
                                {"deviance", json_number(shape.deviance)},
                                {"aic", json_number(shape.aic)},
                                {"jnd", json_number(shape.jnd)}});
  }
  return result;
}

}  // namespace kerf::bench

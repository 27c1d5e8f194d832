#include "fit/fit_table.h"

#include <cmath>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr std::size_t parameters_said = 16;  ///< of a law; fit.csv has them all

std::string number_or_dash(double value) { return std::isfinite(value) ? fmt::format("{:.4f}", value) : "-"; }

void say_comparison(const RecordingFit& fit, Context& context) {
  const std::string& unit = fit.settings.force_unit;
  const bool tested = fit.settings.test_share > 0.0;
  context.say(fmt::format("  {:17} {:>4} {:>9} {:>9} {:>7} {:>9} {:>9}{} {:>6} {:>9}", "law", "free",
                          "rmse " + unit, "max " + unit, "R2", "held-out", "rendered",
                          tested ? "      test" : "", "> JND", "converged"));
  for (const FittedLaw& law : fit.laws) {
    const fitting::FitResult& result = law.result;
    context.say(fmt::format("  {:17} {:4} {:9.4f} {:9.4f} {:7.4f} {:>9} {:>9}{} {:5.1f}% {:>9}", result.model,
                            result.free_parameters, result.rmse, result.max_abs, result.r2,
                            number_or_dash(result.cv_rmse), number_or_dash(result.rendered.cv_rmse),
                            tested ? fmt::format(" {:>9}", number_or_dash(result.test_rmse)) : "",
                            100.0 * result.jnd_fraction, result.converged ? "yes" : "NO"));
  }
  context.say(fmt::format("  {:17} {:4} {:9.4f} {:>9} {:>7} {:>9}", "straight line", 2, fit.line_rmse_n, "",
                          "", number_or_dash(fit.line_cv_rmse_n)));
}

std::string interval_of(const fitting::Estimate& estimate) {
  if (estimate.std_error == 0.0) return "held";
  const bool above = std::isfinite(estimate.lower);
  const bool below = std::isfinite(estimate.upper);
  if (above && below) return fmt::format("{:.5g} to {:.5g}", estimate.lower, estimate.upper);
  if (above) return fmt::format("above {:.5g}", estimate.lower);
  return below ? fmt::format("below {:.5g}", estimate.upper) : "not determined by these data";
}

void say_parameters(const RecordingFit& fit, const FittedLaw& law, Context& context) {
  const auto& parameters = law.result.parameters;
  if (parameters.size() > parameters_said) {
    context.say(fmt::format("  {}: {} parameters, in fit.csv", law.result.model, parameters.size()));
    return;
  }
  std::string of_places;
  for (const models::DataOption& option : models::law_facts(law.result.model).from_data) {
    const auto* const value = std::get_if<double>(&law.result.law_options.at(std::string(option.name)));
    if (value != nullptr) of_places += fmt::format("; {} = {:.6g}", option.name, *value);
  }
  context.say(fmt::format("  {}, with {:g} % intervals{}", law.result.model, 100.0 * fit.settings.confidence,
                          of_places));
  const auto say_one = [&](const fitting::Estimate& estimate) {
    const bool shared = estimate.recording == fitting::Estimate::shared;
    const std::string unit =
        models::unit_of(estimate.info.quantity, law.file.force_unit, law.file.position_unit);
    context.say(fmt::format("    {:22} {:>12.6g}  {:28} {}{}", estimate.info.name, estimate.value,
                            interval_of(estimate), unit,
                            shared ? "" : "  of " + fit.recordings.at(estimate.recording).name));
  };
  for (const fitting::Estimate& estimate : parameters) say_one(estimate);
  for (const fitting::Estimate& estimate : law.result.others) say_one(estimate);
  for (const fitting::Profile& profile : law.result.profiles) {
    const auto end = [](double value) {
      return std::isfinite(value) ? fmt::format("{:.5g}", value) : "open";
    };
    context.say(fmt::format("    {:22} {:>12}  {} to {}", profile.parameter, "by profile", end(profile.lower),
                            end(profile.upper)));
  }
}

void say_floor(const RecordingFit& fit, Context& context) {
  if (!fit.floor || fit.floor->folds < 2) return;
  const auto of_law = [&](double error) { return fmt::format("{:.4f}", error); };
  context.say(fmt::format("  {:17} {:>4} {:>9} {:>9} {:>7} {:>9}", "floor of x, +-", "", "", "", "",
                          of_law(fit.floor->position_n)));
  context.say(fmt::format("  {:17} {:>4} {:>9} {:>9} {:>7} {:>9}", "floor of x, v", "", "", "", "",
                          of_law(fit.floor->velocity_n)));
}

}  // namespace

void say_fit(const RecordingFit& fit, Context& context) {
  say_comparison(fit, context);
  say_floor(fit, context);
  for (const FittedLaw& law : fit.laws) say_parameters(fit, law, context);
  context.say(fit.choice.model.empty() ? fit.choice.why
                                       : fmt::format("choice: {}: {}", fit.choice.model, fit.choice.why));
  for (const FittedLaw& law : fit.laws) {
    const std::string blame = law.result.model == fit.choice.model ? fit.blame(law) : "";
    if (!blame.empty()) context.say("what is to blame: " + blame);
  }
}

void warn_of(const RecordingFit& fit) {
  for (const std::string& warning : fit.warnings) warn(warning);
  for (const Refusal& refusal : fit.refusals) warn(refusal.model + ": " + refusal.why);
  for (const FittedLaw& law : fit.laws) {
    for (const std::string& warning : law.result.warnings) warn(law.result.model + ": " + warning);
  }
}

}  // namespace kerf::bench

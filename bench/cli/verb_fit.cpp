#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "cli/verbs.h"
#include "fits/fit_recording.h"
#include "recordings/axes.h"

namespace kerf::bench {
namespace {

struct Arguments {
  std::string recording;
  std::string output;
  std::string axis;
  std::string direction;
  std::optional<double> contact;
  bool force = false;
  FitRecordingOptions options;
};

void print_table(const RecordingFit& fit) {
  say(fmt::format("  {:12} {:>4} {:>9} {:>9} {:>7} {:>9} {:>6} {:>9}", "law", "free", "rmse N", "max N", "R2",
                  "held-out", "> JND", "converged"));
  for (const FittedLaw& law : fit.laws) {
    const fitting::FitResult& result = law.result;
    say(fmt::format("  {:12} {:4} {:9.4f} {:9.4f} {:7.4f} {:9.4f} {:5.1f}% {:>9}", result.model,
                    result.free_parameters, result.rmse, result.max_abs, result.r2, result.cv_rmse,
                    100.0 * result.jnd_fraction, result.converged ? "yes" : "NO"));
  }
  say(fmt::format("  {:12} {:4} {:9.4f}", "straight line", 2, fit.line_rmse_n));
}

void run_fit(const Arguments& arguments, Context& context) {
  const std::filesystem::path folder = arguments.output;
  if (!arguments.force) refuse_to_replace_fits(arguments.options, folder);
  const schema::Recording recording = schema::read_recording(arguments.recording);
  FitRecordingOptions options = arguments.options;
  options.axis = find_axis(recording, arguments.axis);
  if (arguments.contact || !arguments.direction.empty()) {
    options.contact = contact_of(recording, options.axis);
    if (arguments.contact) options.contact->position = *arguments.contact;
    if (!arguments.direction.empty())
      options.contact->direction = arguments.direction == "increasing" ? 1.0 : -1.0;
  }
  RecordingFit fit = fit_recording(recording, options);
  for (const std::string& warning : fit.warnings) warn(warning);
  for (const FittedLaw& law : fit.laws) {
    for (const std::string& warning : law.result.warnings) warn(law.result.model + ": " + warning);
  }
  context.result = fits_as_json(fit);
  if (std::none_of(fit.laws.begin(), fit.laws.end(),
                   [](const FittedLaw& law) { return law.result.converged; })) {
    context.exit = Exit::check_failed;
    if (fit.laws.empty()) return;
  }
  write_fits(fit, arguments.recording, folder);
  print_table(fit);
  say(fmt::format("{}: {}", fit.choice.model, fit.choice.why));
  say(fmt::format("law files, fit.json and fit.csv are in {}", folder.string()));
}

}  // namespace

void add_fit(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<Arguments>();
  FitRecordingOptions& options = arguments->options;
  Verb verb =
      add_verb(app, context, "fit", "Fit force laws to a recording, with the uncertainty of each parameter",
               "kerf fit punch.h5 --models kelvin,piecewise --segments 4 -o fits\n\n"
               "Segment a recording of cycles first: laws with branches are then fitted as loops, and held-\n"
               "out errors are by cycle. Exit status 1 if no law converged.",
               [arguments, &context] { run_fit(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "Recording").required();
  verb.add_option("--models", options.models,
                  "Laws, separated by commas (default: kelvin, exponential, piecewise, recording)")
      .separated_by(',');
  verb.add_option("--axis", arguments->axis, "Axis to fit (default: the first)");
  verb.add_option("--segments", options.segments, "Segments of the piecewise law")
      .within(1, 12)
      .with_default();
  verb.add_option("--contact", arguments->contact,
                  "Position where the penetration is zero, in m or rad (default: from the recording)");
  verb.add_option("--direction", arguments->direction, "Way into the tissue (default: from the recording)")
      .one_of({"increasing", "decreasing"});
  verb.add_option("--weber", options.fit.jnd.weber_fraction, "Weber fraction of the force JND")
      .within(0.0, 1.0)
      .with_default();
  verb.add_option("--threshold", options.fit.jnd.threshold_n, "Smallest force JND [N]")
      .not_negative()
      .with_default();
  verb.add_option("--folds", options.fit.folds, "Folds of the cross-validation")
      .within(2, 100)
      .with_default();
  verb.add_option("-o,--output", arguments->output, "Folder for law files, fit.json and fit.csv").required();
  verb.add_flag("--force", arguments->force, "Replace an existing fit");
}

}  // namespace kerf::bench

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "fits/blade_recording.h"
#include "program/verbs.h"
#include "recordings/provenance.h"
#include "recordings/whole_recording.h"

namespace kerf::bench {
namespace {

struct BladeVerbArguments {
  std::string recording;
  std::string shape;
  std::string output;
  std::string fidelity;
  bool force = false;
  fitting::BladeFitOptions options;
};

void say_parameters(const fitting::BladeFit& fit, double confidence, Context& context) {
  context.say(fmt::format("  {:22} {:>11} {:>10}   {:25} {}", "parameter", "value", "std error",
                          fmt::format("{:g} % interval", 100.0 * confidence), "unit"));
  for (const fitting::Estimate& estimate : fit.parameters) {
    context.say(fmt::format("  {:22} {:11.5g} {:10.3g}   {:25} {}", estimate.info.name, estimate.value,
                            estimate.std_error,
                            fmt::format("{:.5g} to {:.5g}", estimate.lower, estimate.upper),
                            models::unit_of(estimate.info.quantity, "N", "m")));
  }
}

void say_errors(const BladeRecordingFit& all, Context& context) {
  const fitting::BladeFit& fit = all.fit;
  context.say(fmt::format("  {:6} {:>12} {:>12}   {}", "axis", "rms error", "rms force", "unit"));
  for (std::size_t axis = 0; axis < 6; ++axis) {
    if (!std::isfinite(fit.rmse[axis])) continue;
    context.say(fmt::format("  {:6} {:12.4g} {:12.4g}   {}", all.axes[axis], fit.rmse[axis], fit.rms[axis],
                            axis < 3 ? "N" : "N·m"));
  }
}

void run_blade(const BladeVerbArguments& arguments, Context& context) {
  if (!arguments.output.empty()) require_output(arguments.output, arguments.force);
  fitting::BladeFitOptions options = arguments.options;
  options.law_options = blade_shape_of(read_law_file(arguments.shape), arguments.shape);
  if (!arguments.fidelity.empty()) set_blade_fidelity(options.law_options, arguments.fidelity);
  BladeRecordingFit all = fit_blade_recording(read_whole_recording(arguments.recording), options);
  for (const std::string& warning : all.warnings) warn(warning);
  context.result = blade_fit_as_json(all);
  const fitting::BladeFit& fit = all.fit;
  if (std::ranges::none_of(fit.parameters, [](const auto& p) { return std::isfinite(p.std_error); })) {
    context.exit = Exit::check_failed;
  }
  context.say(fmt::format("{} of {} samples in the tissue", fit.rows_in_tissue, fit.rows));
  say_parameters(fit, options.confidence, context);
  say_errors(all, context);
  if (options.thresholds) {
    context.say(fmt::format(
        "{} ruptures with a spread of {:.3g} N, {} releases with {:.3g} N; stepped along the "
        "recording, the law is in the same phase {:.1f} % of the time",
        fit.phases.ruptures.force_n.size(), fit.phases.ruptures.spread_n, fit.phases.releases.force_n.size(),
        fit.phases.releases.spread_n, 100.0 * fit.phases.agreement));
  }
  if (arguments.output.empty()) return;
  name_recording(all.file.fit, arguments.recording);
  write_law_file(arguments.output, all.file, schema::existing_if(arguments.force));
  context.say(fmt::format("{}: law 'blade'", arguments.output));
}

}  // namespace

void add_blade(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<BladeVerbArguments>();
  fitting::BladeFitOptions& options = arguments->options;
  Verb verb = add_verb(
      app, context, "blade", "Fit the friction of a blade, and its thresholds, to a recording of six axes",
      "kerf blade cut.h5 --shape examples/blade.law.toml -o scalpel.law.toml\n"
      "  kerf blade cut.h5 --shape scalpel.law.toml --thresholds --json\n\n"
      "The recording has the axes x, y, z and rx, ry, rz; polygons, edge and fidelity are those of the\n"
      "shape's law file, whose numbers are not used. Exit status 1 if the data determine no parameter.",
      [arguments, &context] { run_blade(*arguments, context); });
  verb.add_option("RECORDING", arguments->recording, "Recording").required();
  verb.takes_texts(context, arguments->recording);
  verb.add_option("--shape", arguments->shape, "Law file of a blade: its polygons, edge and fidelity")
      .required();
  verb.add_option("--fidelity", arguments->fidelity,
                  "exact, strips:N or paper (default: the law file's, exact there)");
  verb.add_flag("--thresholds", options.thresholds,
                "Also the elastic field and the forces at which the tissue ruptures and holds again");
  verb.add_flag("--robust", options.robust, "Huber's loss, against outliers");
  verb.add_option("--confidence", options.confidence, "Confidence level of the intervals")
      .within(0.5, 0.9999)
      .with_default();
  verb.add_option("--prominence", options.peaks.prominence,
                  "Prominence of a drop of the force, in standard errors, with --thresholds")
      .positive()
      .with_default();
  verb.add_option("--window", options.peaks.window_s, "Time before and after a drop, with --thresholds [s]")
      .positive()
      .with_default();
  verb.add_option("-o,--output", arguments->output, "Law file to write");
  verb.add_flag("--force", arguments->force, "Replace an existing file");
}

}  // namespace kerf::bench

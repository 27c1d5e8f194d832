#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include "compare/comparison_page.h"
#include "compare/run_comparison.h"
#include "files/whole_file.h"
#include "program/verbs.h"
#include "regress/read_tolerance.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

struct CompareVerbArguments {
  std::string expected;
  std::string got;
  std::string align = "tick";
  double most_lag_ms = 500.0;
  ComparedForce force;
  std::optional<double> absolute;
  std::optional<double> absolute_torque;
  std::optional<double> relative;
  std::optional<double> jnd;
  bool exact = false;
  std::optional<double> vibration;
  std::optional<double> slew;
  std::optional<double> drift;
  std::optional<double> peak;
  std::string tolerance;
  double match_ms = 50.0;
  std::string output;
  bool force_output = false;
  RefuseIdle refuse_idle;
};

/// @throws std::invalid_argument if options say of it too.
compare::Tolerance tolerance_of_file(const CompareVerbArguments& arguments) {
  const CompareVerbArguments& a = arguments;
  if (a.exact || a.absolute || a.absolute_torque || a.relative || a.jnd || a.vibration || a.slew || a.drift ||
      a.peak)
    throw std::invalid_argument("--tolerance says all that is allowed; leave out the other options that do");
  return read_tolerance_file(arguments.tolerance);
}

compare::Tolerance tolerance_of(const CompareVerbArguments& arguments) {
  if (!arguments.tolerance.empty()) return tolerance_of_file(arguments);
  const bool inexact = arguments.absolute || arguments.absolute_torque || arguments.relative || arguments.jnd;
  if (arguments.exact && inexact)
    throw std::invalid_argument("--exact leaves no room for a tolerance; leave out either");
  compare::Tolerance tolerance{.force_n = arguments.absolute,
                               .torque_n_m = arguments.absolute_torque,
                               .relative = arguments.relative,
                               .jnd = arguments.jnd,
                               .exact = arguments.exact,
                               .vibration = arguments.vibration,
                               .slew = {.force = arguments.slew, .torque = arguments.slew},
                               .drift = {.force = arguments.drift, .torque = arguments.drift},
                               .peak = {.force = arguments.peak, .torque = arguments.peak}};
  if (!inexact && !arguments.exact) tolerance.jnd = 1.0;
  return tolerance;
}

void run_compare(const CompareVerbArguments& arguments, Context& context) {
  if (arguments.align != "lag")
    arguments.refuse_idle({"--max-lag"}, "--align " + arguments.align, "it is for --align lag");
  RunComparisonOptions options{
      .align = {.by = compare::align_by(arguments.align), .most_lag_s = 1e-3 * arguments.most_lag_ms},
      .tolerance = tolerance_of(arguments),
      .match_s = 1e-3 * arguments.match_ms};
  if (!arguments.output.empty())
    require_output(std::filesystem::path(arguments.output) / "compare.json", arguments.force_output);
  std::array<ComparedRun, 2> runs;
  for_each_index(2, 2, [&](std::size_t i) {
    runs[i] = read_run(i == 0 ? arguments.expected : arguments.got, arguments.force);
  });
  require_kinds_of(arguments.force, runs[0], runs[1]);
  bring_to_one_sense(runs[0], runs[1]);
  const RunComparison result = compare_runs(std::move(runs[0]), std::move(runs[1]), options);
  context.result = comparison_as_json(result, options);
  for (const std::string& one : result.notes) note(one);
  for (const std::string& line : comparison_lines(result)) context.say("  " + line);
  context.say(result.comparison.passed ? "within the tolerance" : "NOT within the tolerance");
  if (!arguments.output.empty()) {
    write_comparison(arguments.output, result, options, arguments.force_output);
    context.say(
        fmt::format("compare.html, compare.json and a picture of each channel are in {}", arguments.output));
  }
  if (!result.comparison.passed) context.exit = Exit::check_failed;
}

}  // namespace

void add_compare(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<CompareVerbArguments>();
  Verb verb = add_verb(
      app, context, "compare", "Compare the forces of two runs, and say what changed",
      "kerf compare before.h5 after.h5\n"
      "  kerf compare expected.csv got.csv --align lag --jnd 0.5 -o compared\n\n"
      "Runs are recordings, what 'kerf replay' writes, a suite's stored forces, or tables with units in\n"
      "their heads:\n"
      "time [s],x [N],rx [N·m]. Exits with 1 if the second is not within the tolerance of the\n"
      "first. docs/comparing.md says more.",
      [arguments, &context] { run_compare(*arguments, context); });
  arguments->refuse_idle = verb.refuses_idle();
  verb.add_option("EXPECTED", arguments->expected, "Recording or table that is taken to be right").required();
  verb.add_option("GOT", arguments->got, "Recording or table that is compared with it").required();
  verb.add_option("--align", arguments->align, "Which rows belong together: tick, time, position or lag")
      .one_of({"tick", "time", "position", "lag"})
      .with_default();
  verb.add_option("--max-lag", arguments->most_lag_ms, "Largest lag that is looked for [ms]")
      .within(0.0, 60000.0)
      .with_default();
  verb.add_flag("--measured", arguments->force.measured,
                "The measured force of recordings, not the commanded one");
  verb.add_option("--channel", arguments->force.channel, "This force alone");
  verb.add_option("--case", arguments->force.stored, "The case, of a suite's stored forces");
  verb.add_option("--tolerance", arguments->tolerance,
                  "What is allowed, also of single channels, from a file with the keys of a suite's case");
  verb.add_option("--jnd", arguments->jnd,
                  "Allowed in each tick: so many JNDs (1, if nothing is allowed otherwise)")
      .not_negative();
  verb.add_option("--absolute", arguments->absolute, "Likewise, of forces [N]").not_negative();
  verb.add_option("--absolute-torque", arguments->absolute_torque, "Likewise, of torques [N·m]")
      .not_negative();
  verb.add_option("--relative", arguments->relative, "Likewise, a share of the expected force")
      .not_negative();
  verb.add_flag("--exact", arguments->exact, "The same bits");
  verb.add_option("--vibration", arguments->vibration,
                  "Allowed in each band of frequency: so many times what is felt (2 with JNDs)")
      .not_negative();
  verb.add_option("--slew", arguments->slew,
                  "Allowed change of the difference from tick to tick [N/s, N·m/s]")
      .not_negative();
  verb.add_option("--drift", arguments->drift, "Allowed drift of the difference over the run [N, N·m]")
      .not_negative();
  verb.add_option("--peak", arguments->peak, "Allowed between the largest forces [N, N·m]").not_negative();
  verb.add_option("--match", arguments->match_ms, "Largest time between events that count as the same [ms]")
      .within(0.0, 10000.0)
      .with_default();
  verb.add_option("-o,--output", arguments->output, "Folder for compare.html, compare.json and pictures");
  verb.add_flag("--force", arguments->force_output, "Replace what is there");
}

}  // namespace kerf::bench

#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <kerf/fitting/rupture.h>

#include "files/whole_file.h"
#include "fits/rupture_table.h"
#include "laws/law_file.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

struct TrainVerbArguments {
  std::string table;
  std::string output;
  std::string learning = "projection";
  std::vector<double> element;
  double depth_m = 0.005;
  bool example = false;
  bool force = false;
  fitting::RuptureOptions options;
};

/// The threshold alone, or with a Kelvin element before it.
models::Law law_of(const TrainVerbArguments& arguments, const models::Law& threshold) {
  if (arguments.element.empty()) return threshold;
  std::vector<double> values = arguments.element;
  values.insert(values.end(), threshold.values().begin(), threshold.values().end());
  models::Options options = threshold.options();
  options["depth"] = arguments.depth_m;
  return models::Law::make("fuzzy_kelvin", values, options);
}

void run_train(const TrainVerbArguments& arguments, Context& context) {
  require_output(arguments.output, arguments.force);
  if (arguments.example) {
    write_whole_file(arguments.output, as_csv(liver_ruptures()), schema::existing_if(arguments.force));
    context.say(fmt::format("{}: a table made from a formula, to begin with", arguments.output));
    context.result = {{"written", arguments.output}};
    return;
  }
  if (arguments.table.empty()) {
    throw std::invalid_argument("no table of ruptures; give one, or --example to have one written");
  }
  fitting::RuptureOptions options = arguments.options;
  options.learning = arguments.learning == "projection" ? fitting::Learning::variable_projection
                                                        : fitting::Learning::back_propagation;
  const fitting::RuptureSamples samples = read_ruptures(arguments.table);
  const fitting::RuptureFit fit = fitting::train_rupture(samples, options);
  const LawFile file{
      .law = law_of(arguments, fit.law), .contact = {}, .axis = {}, .std_errors = {}, .fit = {}};
  write_law_file(arguments.output, file, schema::existing_if(arguments.force));
  context.result = {{"law", std::string(file.law.model())},
                    {"samples", samples.force_n.size()},
                    {"parameters", fit.law.values().size()},
                    {"learning", arguments.learning},
                    {"rmse_n", fit.rmse_n},
                    {"max_abs_n", fit.max_abs_n},
                    {"iterations", fit.iterations},
                    {"seconds", fit.seconds},
                    {"converged", fit.converged},
                    {"message", fit.message}};
  context.say(fmt::format(
      "{} samples, {} parameters: error {:.3g} N rms, {:.3g} N at most, after {} iterations in {:.2f} s",
      samples.force_n.size(), fit.law.values().size(), fit.rmse_n, fit.max_abs_n, fit.iterations,
      fit.seconds));
  context.say(fmt::format("{}: law '{}'", arguments.output, file.law.model()));
}

}  // namespace

void add_train(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<TrainVerbArguments>();
  Verb verb = add_verb(
      app, context, "train", "Train the rupture threshold of a fuzzy law from a table of ruptures",
      "kerf train --example -o ruptures.csv\n"
      "  kerf train ruptures.csv -o threshold.law.toml\n"
      "  kerf train ruptures.csv --element 8 7 130 --depth 0.005 -o liver.law.toml\n\n"
      "The table is a CSV with columns depth, speed and force and their units in the header. No trend\n"
      "is assumed: force may rise or fall with speed.",
      [arguments, &context] { run_train(*arguments, context); });
  verb.add_option("TABLE", arguments->table, "CSV of ruptures: depth [mm],speed [mm/s],force [N]");
  verb.add_flag("--example", arguments->example, "Write a table made from a formula instead");
  verb.add_option("--memberships", arguments->options.memberships,
                  "Memberships an input; rules are its square")
      .within(1, 5)
      .with_default();
  verb.add_option("--learning", arguments->learning,
                  "projection (variable projection) or gradient (plain back-propagation)")
      .one_of({"projection", "gradient"})
      .with_default();
  verb.add_option("--iterations", arguments->options.iterations,
                  "Largest number of iterations (default: 200, or 20000 of gradient)")
      .within(1, 10000000);
  verb.add_option("--element", arguments->element,
                  "K1 K2 B of a Kelvin element [N/m, N/m, N·s/m]: write a fuzzy_kelvin law")
      .taking(3);
  verb.add_option("--depth", arguments->depth_m, "Depth of the blade for a fuzzy_kelvin law [m]")
      .not_negative()
      .with_default();
  verb.add_option("-o,--output", arguments->output, "Law file, or the table of --example").required();
  verb.add_flag("--force", arguments->force, "Replace an existing file");
}

}  // namespace kerf::bench

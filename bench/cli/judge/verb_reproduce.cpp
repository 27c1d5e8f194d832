#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "program/verbs.h"
#include "reproduce/reproduce.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_points = 1600;  // of a curve: more than a page shows

struct ReproduceVerbArguments {
  std::string paper;
  std::string output;
  bool force = false;
};

void run_reproduce(const ReproduceVerbArguments& arguments, Context& context) {
  const std::filesystem::path folder = arguments.output;
  for (const auto* name : {"claims.json", "claims.md"}) require_output(folder / name, arguments.force);
  const Reproduction result = reproduce(arguments.paper, context.seed);
  WholeFolder whole(folder, schema::existing_if(arguments.force));
  for (const Figure& figure : result.figures) {
    Chart chart = figure.chart;
    for (Curve& curve : chart.curves) curve = decimated(curve, max_points);
    write_whole_file(whole.path() / (figure.name + ".svg"), draw(chart));
  }
  context.result = to_json(result);
  write_whole_file(whole.path() / "claims.md", as_markdown(result));
  write_json_file(whole.path() / "claims.json", context.result);
  whole.commit();
  context.say(fmt::format("[{}]: {}", result.key, result.title));
  for (const Claim& claim : result.claims) {
    context.say(fmt::format("  {:13}  {} ({})", name_of(claim.verdict), claim.claim, claim.where));
    context.say(fmt::format("                 {}", claim.measured));
  }
  context.say(
      fmt::format("{} figures, claims.md and claims.json are in {}", result.figures.size(), folder.string()));
}

}  // namespace

void add_reproduce(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<ReproduceVerbArguments>();
  Verb verb = add_verb(
      app, context, "reproduce", "Run the experiments of a paper, draw its figures and judge its claims",
      "kerf reproduce Okamura2003 -o scissors\n\n"
      "The papers, by the keys of docs/bibliography.md or by their numbers:\n"
      "  Henry2004      000  blade and tissue\n"
      "  Sepulveda2008  001  orthogonal decomposition\n"
      "  FuzzyKelvin    002  fuzzy-Kelvin hybrid\n"
      "  Weiss2004      003  two-mesh scissors\n"
      "  Okamura2003    004  haptic scissors\n"
      "Experiments run in virtual time on simulated devices and on tissues made for this bench. A claim\n"
      "holds, does not hold, or answers what a paper left open.",
      [arguments, &context] { run_reproduce(*arguments, context); });
  verb.add_option("PAPER", arguments->paper, "Its key or its number").required();
  verb.add_option("-o,--output", arguments->output, "Folder for the figures, claims.md and claims.json")
      .required();
  verb.add_flag("--force", arguments->force, "Replace earlier results there");
}

}  // namespace kerf::bench

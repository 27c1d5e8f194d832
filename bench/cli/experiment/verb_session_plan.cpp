#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "experiment/verb_session.h"
#include "files/whole_file.h"
#include "registered/looks.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct SessionPlanVerbArguments {
  std::string protocol;
  std::string output;
  Experiment experiment;
  std::string test = "difference";
  std::string rule = "fixed";
  std::string spending = "obrien-fleming";
  std::string replacement = "dropped";
  std::vector<double> looks;
  std::vector<double> jnd_margins;
  bool replace = false;
};

Experiment experiment_of(const SessionPlanVerbArguments& arguments, const fs::path& file,
                         const Protocol& protocol) {
  Experiment experiment = arguments.experiment;
  experiment.name = protocol.name;
  const fs::path folder = fs::absolute(file).parent_path();
  experiment.protocol = fs::proximate(fs::absolute(arguments.protocol), folder).generic_string();
  ParticipantPlan& people = experiment.participants;
  if (arguments.replacement == "never") people.replace = ReplacementRule::never;
  if (arguments.replacement == "dropped-or-excluded") people.replace = ReplacementRule::dropped_or_excluded;
  AnalysisPlan& plan = experiment.analysis;
  if (arguments.test == "equivalence") plan.test = PrimaryTest::equivalence;
  if (!arguments.jnd_margins.empty())
    plan.jnd_margins = psychophysics::Interval{arguments.jnd_margins[0], arguments.jnd_margins[1]};
  if (arguments.rule == "alpha-spending") plan.stopping.kind = StoppingKind::alpha_spending;
  if (arguments.rule == "bayes-factor") plan.stopping.kind = StoppingKind::bayes_factor;
  if (arguments.spending == "pocock") plan.stopping.spending = psychophysics::SpendingFunction::pocock;
  for (const double at : arguments.looks) {
    if (at != std::floor(at) || at < 1.0 || at >= static_cast<double>(people.target))
      throw std::invalid_argument(
          fmt::format("--look: found {:g}, expected a whole number of participants below the target of {}, "
                      "which is the last "
                      "look",
                      at, people.target));
    plan.stopping.looks.push_back(static_cast<std::size_t>(at));
  }
  return experiment;
}

/// What each look may spend, and whether its participants could reach that at all.
void tell_looks(const Experiment& experiment, const Protocol& protocol, Context& context) {
  const AnalysisPlan& plan = experiment.analysis;
  const bool two_sided = is_two_sided(protocol, plan.test);
  const std::vector<std::size_t> looks = experiment.planned_looks();
  const std::vector<LookLevel> levels = look_levels(experiment, looks, two_sided);
  context.result["looks"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < looks.size(); ++i) {
    context.result["looks"].push_back(
        {{"participants", looks[i]}, {"alpha_spent", levels[i].spent}, {"nominal", levels[i].nominal}});
    if (plan.stopping.kind != StoppingKind::alpha_spending) continue;
    // Of flipped signs no p is smaller than that of one outcome among all.
    const double least = std::exp2((two_sided ? 1.0 : 0.0) - static_cast<double>(looks[i]));
    const bool is_out_of_reach = plan.test == PrimaryTest::difference && levels[i].nominal < least;
    context.say(fmt::format("  look {} at {} participants: p <= {:.2g}, alpha spent {:.3g}{}", i + 1,
                            looks[i], levels[i].nominal, levels[i].spent,
                            is_out_of_reach ? fmt::format("; so few cannot reach it: flipped signs have no p "
                                                          "below {:.2g}",
                                                          least)
                                            : std::string()));
  }
}

void write_plan(const SessionPlanVerbArguments& arguments, Context& context) {
  fs::path file = arguments.output;
  if (file.extension() != ".toml") file /= "experiment.toml";
  if (!is_experiment(file))
    throw std::invalid_argument(
        fmt::format("-o: {} is no name of an experiment; expected a folder, or a file whose name ends with "
                    "experiment.toml",
                    file.string()));
  require_output(file, arguments.replace);
  const Protocol protocol = read_protocol(arguments.protocol);
  const std::string text = experiment_text(experiment_of(arguments, file, protocol));
  const Experiment experiment = parse_experiment(text, file.string());
  require_fits(experiment, protocol, file.string());
  if (fs::exists(log_of(file)))
    throw std::invalid_argument(
        fmt::format("{}: an experiment was registered there; plan another one in a folder of its own",
                    log_of(file).string()));
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
  write_whole_file(file, text, schema::existing_if(arguments.replace));
  context.result = {{"file", file.string()},
                    {"name", experiment.name},
                    {"participants", experiment.participants.target},
                    {"test", name_of(experiment.analysis.test)},
                    {"stopping", name_of(experiment.analysis.stopping.kind)}};
  context.say(
      fmt::format("{}: {} participants; edit it, and simulate it, until 'kerf session new' registers it",
                  file.string(), experiment.participants.target));
  tell_looks(experiment, protocol, context);
}

}  // namespace

void add_session_plan(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionPlanVerbArguments>();
  Verb verb = add_verb(
      session, context, "plan", "Plan an experiment: participants, analysis and stopping rule of a protocol",
      "kerf session plan abx.protocol.toml --participants 12 -o study\n"
      "  kerf session plan abx.protocol.toml --participants 24 --rule alpha-spending --look 12 --look 18 -o "
      "study\n\n"
      "Writes study/experiment.toml, to be edited by hand. 'kerf session simulate study' tells what it can\n"
      "find, 'kerf session new study' registers it and makes the sessions; from then on the plan is sealed\n"
      "with them. docs/experiments.md leads from the plan to the report.",
      [arguments, &context] { write_plan(*arguments, context); });
  verb.takes_laws(context);
  ParticipantPlan& people = arguments->experiment.participants;
  AnalysisPlan& analysis = arguments->experiment.analysis;
  verb.add_option("PROTOCOL", arguments->protocol, "The protocol, NAME.protocol.toml").required();
  verb.add_option("-o,--output", arguments->output,
                  "Folder of the study, or a file in it whose name ends with experiment.toml")
      .required();
  verb.add_option("--participants", people.target, "How many are to be analysed").required();
  verb.add_option("--visits", people.visits, "Sessions of each participant").with_default();
  verb.add_option("--group", people.groups, "A group of participants (may be repeated; all of equal size)")
      .one_value_each();
  verb.add_option("--replace", arguments->replacement,
                  "Who may be replaced: never, dropped, dropped-or-excluded")
      .one_of({"never", "dropped", "dropped-or-excluded"})
      .with_default();
  verb.add_option("--test", arguments->test, "Primary test: difference or equivalence")
      .one_of({"difference", "equivalence"})
      .with_default();
  verb.add_option("--alpha", analysis.alpha, "Significance level of the whole study")
      .within(0.001, 0.2)
      .with_default();
  verb.add_option("--margin", analysis.margin, "Equivalence margin of a preference, 50 % +- this")
      .within(0.001, 0.5);
  verb.add_option("--d-prime", analysis.d_prime, "Renderings count as equal below this d'").positive();
  verb.add_option("--jnd-margins", arguments->jnd_margins, "LOWER UPPER: equivalence margin of a JND")
      .taking(2);
  verb.add_option("--exclude-faulty", analysis.exclude.faulty,
                  "Exclude participants with more than this share of trials with a fault")
      .within(0.0, 1.0);
  verb.add_option("--exclude-unfelt", analysis.exclude.unfelt,
                  "Likewise of trials with a slot whose force cannot be felt")
      .within(0.0, 1.0);
  verb.add_option("--exclude-catch-right", analysis.exclude.catch_right,
                  "Least share of right catch trials of a participant who is analysed (default: not asked)")
      .within(0.0, 1.0);
  verb.add_option("--exclude", analysis.exclude.rules,
                  "Why else a participant is excluded, in words (may be repeated)")
      .one_value_each();
  verb.add_option("--rule", arguments->rule, "Stopping rule: fixed, alpha-spending or bayes-factor")
      .one_of({"fixed", "alpha-spending", "bayes-factor"})
      .with_default();
  verb.add_option("--look", arguments->looks,
                  "Number of participants at which the answers are looked at, before all are through (may be "
                  "repeated)")
      .one_value_each();
  verb.add_option("--spending", arguments->spending, "How alpha is spent: obrien-fleming or pocock")
      .one_of({"obrien-fleming", "pocock"})
      .with_default();
  verb.add_option("--evidence", analysis.stopping.evidence, "Bayes factor at which the study ends")
      .within(1.5, 1e6)
      .with_default();
  verb.add_flag("--force", arguments->replace, "Replace an existing file");
}

}  // namespace kerf::bench

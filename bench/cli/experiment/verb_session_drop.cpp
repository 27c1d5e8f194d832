#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "answer_pages/analysis_words.h"
#include "answer_pages/experiment_words.h"
#include "experiment/session_log.h"
#include "experiment/verb_session.h"
#include "sealed/trials/session_quality.h"

namespace kerf::bench {
namespace {

struct SessionDropVerbArguments {
  std::string experiment;
  std::string participant;
  std::string reason;
  std::string rule;
  std::vector<std::string> receipts;  ///< of the log
  bool quality = false;
  KeyArguments key;
};

void drop_participant(SessionDropVerbArguments& arguments, Context& context) {
  if (arguments.reason.find_first_not_of(" \t\r\n") == std::string::npos)
    throw std::invalid_argument("--reason: expected a few words, which every report will print");
  OpenedExperiment opened = open_experiment(arguments.experiment, arguments.key);
  const Participant* who = opened.state.find(arguments.participant);
  if (who == nullptr)
    throw std::invalid_argument(
        fmt::format("there is no participant {} in this experiment", arguments.participant));
  if (who->is_out())
    throw std::invalid_argument(
        fmt::format("{} was {} already: {}", who->code, who->dropped ? "dropped" : "excluded", who->reason));
  const auto& rules = opened.state.experiment.analysis.exclude.rules;
  if (!arguments.rule.empty() && std::ranges::count(rules, arguments.rule) == 0)
    throw std::invalid_argument(fmt::format("--rule: \"{}\" was not registered; expected one of \"{}\"",
                                            arguments.rule, fmt::join(rules, "\", \"")));
  const bool excludes = who->completed();
  if (!excludes && !arguments.rule.empty())
    throw std::invalid_argument(
        fmt::format("--rule: {} is not through, and is dropped whatever the rules of "
                    "exclusion are; leave it out",
                    who->code));
  const char* kind = excludes ? "excluded" : "dropped";
  ExperimentLog::Facts facts{{"participant", who->code}, {"reason", arguments.reason}};
  if (!arguments.rule.empty()) facts["rule"] = arguments.rule;
  opened.log.append(kind, facts);
  context.result = {{"participant", who->code}, {"as", kind}, {"log_receipt", opened.log.receipt()}};
  context.say(fmt::format("{}: {} ({})", who->code, kind, arguments.reason));
  if (excludes && arguments.rule.empty())
    warn(
        fmt::format("{} is through, and no registered rule of exclusion was named with --rule: every report "
                    "will call it a deviation",
                    who->code));
}

/// Sums over the trials of a session, while it is run too; nothing that tells samples or answers.
nlohmann::ordered_json told_quality(const std::string& file, SessionDropVerbArguments& arguments,
                                    Context& context) {
  const SessionStore store(file, key_for(arguments.key, derivation_of(file)), SessionStore::Purpose::read);
  const SessionQuality quality = session_quality(store);
  context.say(fmt::format("  {}: {}", store.session().subject, in_words(quality)));
  nlohmann::ordered_json facts = to_json(quality);
  facts["participant"] = store.session().subject;
  facts["file"] = file;
  return facts;
}

void tell_quality(const ExperimentState& state, SessionDropVerbArguments& arguments, Context& context) {
  context.result["quality"] = nlohmann::ordered_json::array();
  for (const Participant& each : state.participants) {
    for (const AssignedSession& session : each.sessions) {
      if (session.is_there && session.begun)
        context.result["quality"].push_back(told_quality(session.file.string(), arguments, context));
    }
  }
}

void tell_status(SessionDropVerbArguments& arguments, Context& context) {
  if (!is_experiment(arguments.experiment)) {
    if (!arguments.quality)
      throw std::invalid_argument(
          fmt::format("{}: is no experiment; of a session by itself --quality tells how its trials went",
                      arguments.experiment));
    context.result["quality"] =
        nlohmann::ordered_json::array({told_quality(arguments.experiment, arguments, context)});
    return;
  }
  const OpenedExperiment opened = open_experiment(arguments.experiment, arguments.key);
  const ExperimentState& state = opened.state;
  const auto flow = flow_of(state);
  for (const std::string& line : flow_lines(state, flow)) context.say(line);
  for (const Participant& each : state.participants) {
    if (each.is_out() || each.completed()) continue;
    context.say(fmt::format("  {} {}", each.code, each.begun() ? "has begun" : "is still to come"));
  }
  std::vector<std::string> problems = state.problems;
  for (const std::string& receipt : arguments.receipts) {
    if (!opened.log.bears_out(receipt))
      problems.push_back(
          fmt::format("receipt {}: experiment.log has not the lines that it had: it was cut short, or "
                      "an older copy was put back",
                      receipt));
  }
  for (const std::string& problem : problems) warn(problem);
  if (!problems.empty()) context.exit = Exit::check_failed;
  context.say(fmt::format("{} so far; {}", plural(state.looks.size(), "look"),
                          state.is_over() ? "everybody is through" : "the study is under way"));
  context.say("log: receipt " + opened.log.receipt());
  context.result = {{"name", state.experiment.name},
                    {"flow", flow_json(state, flow)},
                    {"over", state.is_over()},
                    {"looks", state.looks.size()},
                    {"files", problems},
                    {"log_receipt", opened.log.receipt()}};
  if (arguments.quality) tell_quality(state, arguments, context);
}

}  // namespace

void add_session_drop(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionDropVerbArguments>();
  Verb verb = add_verb(
      session, context, "drop", "Say that a participant of an experiment left, or is not to be analysed",
      "kerf session drop study S04 --reason \"felt unwell in practice\" --key-file keeper.key\n"
      "  kerf session new study --replaces S04 --key-file keeper.key\n\n"
      "Who is not through is dropped; who is through is excluded, by a registered rule (--rule), or the\n"
      "report will call it a deviation. The study's log keeps both, and every report prints the reason.",
      [arguments, &context] { drop_participant(*arguments, context); });
  verb.add_option("EXPERIMENT", arguments->experiment, "The study's folder, or its experiment.toml")
      .required();
  verb.add_option("PARTICIPANT", arguments->participant, "Code of the participant").required();
  verb.add_option("--reason", arguments->reason, "Why, in a few words").required();
  verb.add_option("--rule", arguments->rule, "The registered rule of exclusion that it is");
  add_key_options(verb, arguments->key);
}

void add_session_status(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionDropVerbArguments>();
  Verb verb = add_verb(session, context, "status",
                       "Where an experiment stands: its participants and files; no answer is looked at",
                       "kerf session status study --key-file keeper.key\n"
                       "  kerf session status study --quality --key-file keeper.key\n\n"
                       "Exits with 1 where a session is missing, foreign, there twice, or older than it was, "
                       "or where a receipt\n"
                       "of the log is not borne out.",
                       [arguments, &context] { tell_status(*arguments, context); });
  verb.add_option("EXPERIMENT", arguments->experiment, "The study's folder, or its experiment.toml")
      .required();
  verb.add_flag(
      "--quality", arguments->quality,
      "Also how the trials went, of each session: void, unfelt, faults, late ticks, response times; "
      "also of a session by itself");
  verb.add_option("--receipt", arguments->receipts,
                  "Receipt of the log, as this verb prints it (may be repeated)")
      .one_value_each();
  add_key_options(verb, arguments->key);
}

}  // namespace kerf::bench

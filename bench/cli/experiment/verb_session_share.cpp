#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "dataset/psych_ds.h"
#include "experiment/key_arguments.h"
#include "experiment/session_log.h"
#include "experiment/verb_session.h"
#include "files/named_file.h"
#include "registered/participant_sessions.h"
#include "sealed/opening.h"

namespace kerf::bench {
namespace {

struct SessionShareVerbArguments {
  std::vector<std::string> files;
  std::string output;
  std::string reason;
  DatasetNotes notes;
  KeyArguments key;
  bool dropped = false;
  bool replace = false;
};

void report_written(const std::vector<const SessionStore*>& sessions, const std::string& folder,
                    Context& context) {
  std::size_t trials = 0;
  for (const SessionStore* const store : sessions) trials += store->trials().size();
  context.result = {{"output", folder}, {"sessions", sessions.size()}, {"trials", trials}};
  context.say(fmt::format("{}: a Psych-DS dataset of {} trials in {} sessions, with a methods section",
                          folder, trials, sessions.size()));
}

void warn_of(const SessionStore& store, const std::string& file) {
  for (const std::string& opening : store.early_openings())
    warn(fmt::format("{}: opened before its end: {}", file, opening));
  if (was_rehearsed(store.session())) warn(fmt::format("{}: a rehearsal, whose answers are by chance", file));
}

/// Everybody who is through, and on request who was dropped. Before the registered analysis each session is
/// opened by itself, and the log keeps that.
void share_experiment(SessionShareVerbArguments& arguments, Context& context) {
  OpenedExperiment opened = open_experiment(arguments.files.front(), arguments.key);
  ExperimentState& state = opened.state;
  const bool is_analysed = state.is_over() && !state.looks.empty();
  if (!is_analysed && is_blank(arguments.reason))
    throw std::invalid_argument(
        fmt::format("{}: an experiment that {}; 'kerf session analyze' looks at it as was registered; "
                    "--reason shares it before, "
                    "and the study's log will keep that",
                    arguments.files.front(), state.is_over() ? "was not analysed" : "is under way"));
  const std::string reason =
      is_blank(arguments.reason) ? "shared with the data of the study" : arguments.reason;
  std::vector<OpenParticipant> open;
  std::vector<std::string> warnings;
  const auto key_of = [&](const std::filesystem::path& file) {
    SealKey key = key_for(arguments.key, derivation_of(file));
    record_opening(file, key, reason);
    return key;
  };
  for (const Participant& each : state.participants) {
    if (each.dropped ? !arguments.dropped : !each.completed()) continue;
    open.push_back(open_participant(each, key_of, state, warnings));
  }
  for (const std::string& warning : warnings) warn(warning);
  for (const std::string& problem : state.problems) warn(problem);
  exclude_by_measure(open, state.experiment.analysis.exclude, state);
  const std::vector<const SessionStore*> sessions = sessions_of(open);
  if (sessions.empty())
    throw std::invalid_argument(
        fmt::format("{}: nobody is through, so there is nothing to share", arguments.files.front()));
  if (!is_analysed) {
    for (const SessionStore* const store : sessions)
      opened.log.append("opened", {{"participant", store->session().subject},
                                   {"session", store->session().uuid},
                                   {"reason", reason}});
  }
  for (const SessionStore* const store : sessions) warn_of(*store, store->session().subject);
  const DatasetExperiment experiment{.state = state,
                                     .registered_at = opened.log.registered().time,
                                     .log = read_named_file(log_of(opened.file))};
  write_dataset(sessions, &experiment, arguments.notes, arguments.output, arguments.replace);
  report_written(sessions, arguments.output, context);
  if (!state.problems.empty()) context.exit = Exit::check_failed;
}

void share(SessionShareVerbArguments& arguments, Context& context) {
  require_dataset_output(arguments.output, arguments.replace);  // before a session is opened for it
  if (is_experiment(arguments.files.front())) {
    if (arguments.files.size() != 1)
      throw std::invalid_argument(
          "an experiment is shared alone, and knows its sessions; leave out all else");
    share_experiment(arguments, context);
    return;
  }
  if (arguments.dropped)
    throw std::invalid_argument("--dropped is for an experiment; of sessions name each file");
  std::vector<std::unique_ptr<SessionStore>> stores;
  std::vector<const SessionStore*> sessions;
  for (const std::string& file : arguments.files) {
    stores.push_back(opened_session(file, arguments.key, arguments.reason));
    const SessionStore& store = *stores.back();
    sessions.push_back(&store);
    for (const std::string& warning : store.warnings()) warn(warning);
    warn_of(store, file);
  }
  write_dataset(sessions, nullptr, arguments.notes, arguments.output, arguments.replace);
  report_written(sessions, arguments.output, context);
}

}  // namespace

void add_session_share(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionShareVerbArguments>();
  Verb verb = add_verb(
      session, context, "share", "Sessions as a dataset that others read: Psych-DS, with a methods section",
      "kerf session share study --key-file keeper.key --licence CC-BY-4.0 -o dataset\n"
      "  kerf session share S*.h5 --key-file keeper.key -o dataset\n\n"
      "Tables of trials, slots and participants as plain CSV, what each column is and its unit, the "
      "protocol,\n"
      "the laws, and a methods section of what the files themselves say. It lifts the blinding, as 'open' "
      "does.\n"
      "Of an experiment (its folder) everybody who is through, with what was registered, what became of "
      "each\n"
      "participant, and the log.",
      [arguments, &context] { share(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("FILES", arguments->files, "An experiment, or the sessions of one protocol").required();
  verb.add_option("-o,--output", arguments->output, "Folder of the dataset").required();
  verb.add_option("--licence", arguments->notes.licence, "Licence of the data: SPDX or an address");
  verb.add_option("--author", arguments->notes.authors, "Who is named as an author (may be repeated)")
      .one_value_each();
  verb.add_option("--description", arguments->notes.description, "What the dataset is, in a sentence");
  verb.add_option("--reason", arguments->reason,
                  "Why sessions are opened before their end; kept in the files");
  verb.add_flag("--dropped", arguments->dropped,
                "Of an experiment also what those answered who were dropped");
  add_key_options(verb, arguments->key);
  verb.add_flag("--force", arguments->replace, "Replace existing files");
}

}  // namespace kerf::bench

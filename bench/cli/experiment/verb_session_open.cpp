#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/core.h>

#include "experiment/key_arguments.h"
#include "experiment/session_log.h"
#include "experiment/verb_session.h"
#include "sealed/session_export.h"

namespace kerf::bench {
namespace {

struct SessionOpenVerbArguments {
  std::string file;
  std::string output;
  std::string reason;
  KeyArguments key;
  bool replace = false;
};

void open(SessionOpenVerbArguments& arguments, Context& context) {
  const auto opened = opened_session(arguments.file, arguments.key, arguments.reason);
  const SessionStore& store = *opened;
  for (const std::string& warning : store.warnings()) warn(warning);
  export_session(store, arguments.output, arguments.replace);
  context.result = {{"file", arguments.file},
                    {"output", arguments.output},
                    {"trials", store.trials().size()},
                    {"finished", store.finished()},
                    {"early_openings", store.early_openings()}};
  for (const std::string& opening : store.early_openings()) warn("opened before its end: " + opening);
  context.say(fmt::format(
      "{}: trials.csv, slots.csv{} and a recording of each of {} trials", arguments.output,
      store.protocol().questionnaire.is_asked() ? ", questionnaire.csv" : "", store.trials().size()));
}

}  // namespace

void add_session_open(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionOpenVerbArguments>();
  Verb verb = add_verb(
      session, context, "open", "Lift the blinding: answers as a table, each trial as a recording",
      "kerf session open S01.h5 --key-file keeper.key -o S01\n\n"
      "Before a session is finished, or the experiment that it is of, it takes a --reason, and the file or\n"
      "the experiment's log keeps both: every analysis says that it was opened early.",
      [arguments, &context] { open(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("FILE", arguments->file, "The session").required();
  verb.add_option(
          "-o,--output", arguments->output,
          "Folder for trials.csv, slots.csv, questionnaire.csv (where one is asked) and the recordings")
      .required();
  verb.add_option("--reason", arguments->reason, "Why it is opened before its end; kept in the file");
  add_key_options(verb, arguments->key);
  verb.add_flag("--force", arguments->replace, "Replace existing files");
}

}  // namespace kerf::bench

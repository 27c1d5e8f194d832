#include <memory>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "experiment/key_arguments.h"
#include "experiment/verb_session.h"
#include "sealed/trials/session_notes.h"
#include "session/receipt.h"

namespace kerf::bench {
namespace {

struct SessionNoteVerbArguments {
  std::string file;
  std::string text;
  KeyArguments key;
};

void keep_note(SessionNoteVerbArguments& arguments, Context& context) {
  const std::string text = note_text(arguments.text);
  SessionStore store(arguments.file, key_for(arguments.key, derivation_of(arguments.file)),
                     SessionStore::Purpose::run);
  for (const std::string& warning : store.warnings()) warn(warning);
  store.note("note", text);
  const std::string time = store.session().entries.back().time;
  store.close();
  const Receipt receipt = receipt_of(store);
  context.result = {{"file", arguments.file}, {"time", time}, {"text", text}, {"receipt", receipt.in_full()}};
  context.say(fmt::format("{}: noted at {}. Receipt {}", arguments.file, time, receipt.in_short()));
  try {
    keep_receipt(arguments.file, receipt);
  } catch (const std::system_error& error) {
    warn(error.what());
  }
}

}  // namespace

void add_session_note(CLI::App& session, Context& context) {
  auto arguments = std::make_shared<SessionNoteVerbArguments>();
  Verb verb = add_verb(
      session, context, "note", "Keep a note of the experimenter in a session, for everybody to read",
      "kerf session note S01.h5 \"the telephone rang in trial 7\" --key-file keeper.key\n\n"
      "It stands in the file with its time, under no seal but bound to the others, in the analysis and in "
      "the\n"
      "methods section. Nothing of order or answers is looked at. While the session runs, type it at its\n"
      "terminal or write it in the studio.",
      [arguments, &context] { keep_note(*arguments, context); });
  verb.takes_laws(context);
  verb.add_option("FILE", arguments->file, "The session").required();
  verb.add_option("TEXT", arguments->text, "One line of 1 to 500 characters").required();
  add_key_options(verb, arguments->key);
}

}  // namespace kerf::bench

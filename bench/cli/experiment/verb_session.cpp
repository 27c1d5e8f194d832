#include "experiment/verb_session.h"

#include "program/verbs.h"

namespace kerf::bench {

void add_session(CLI::App& app, Context& context) {
  CLI::App& session = add_verb_of_verbs(
      app, "session", "Blind comparisons of renderings, with people or simulated observers",
      "Example:\n"
      "  kerf session key keeper.key\n"
      "  kerf session new abx.protocol.toml --subject S01 --key-file keeper.key -o S01.h5\n"
      "  kerf session run S01.h5 --key-file keeper.key --page\n"
      "  kerf session analyze S01.h5 --key-file keeper.key -o analysis\n"
      "  kerf session simulate abx.protocol.toml --subjects 12 -o power\n\n"
      "The order of the samples, the answers and the forces lie sealed in the session file; "
      "docs/sessions.md\n"
      "says how to plan and run a study, docs/blinding.md what the seal protects from and what not.");
  add_session_key(session, context);
  add_session_plan(session, context);
  add_session_new(session, context);
  add_session_run(session, context);
  add_session_note(session, context);
  add_session_drop(session, context);
  add_session_status(session, context);
  add_session_analyze(session, context);
  add_session_open(session, context);
  add_session_share(session, context);
  add_session_simulate(session, context);
}

}  // namespace kerf::bench

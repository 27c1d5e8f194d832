#include "cli/verb_session.h"

#include "cli/verbs.h"

namespace kerf::bench {

void add_session(CLI::App& app, Context& context) {
  CLI::App& session = add_verb_of_verbs(app, "session",
                                        "Blind comparisons of renderings, with people or simulated observers",
                                        "Example:\n  kerf session simulate abx.protocol.toml");
  add_session_simulate(session, context);
}

}  // namespace kerf::bench

#include "registered/logged_run.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

#include "registered/experiment_state.h"
#include "session/receipt.h"

namespace kerf::bench {

std::optional<std::filesystem::path> log_of_session(const std::filesystem::path& session_file,
                                                    const schema::Session& session) {
  if (!membership_of(session)) return std::nullopt;
  return log_of(session_file);
}

void require_takes_part(const std::filesystem::path& session_file, const ExperimentLog& log,
                        const schema::Session& session) {
  const ExperimentState state = experiment_state(session_file.parent_path() / "experiment.toml", log);
  const Participant* who = state.find(session.subject);
  const bool is_assigned =
      who != nullptr && std::ranges::count(who->sessions, session.uuid, &AssignedSession::uuid) > 0;
  if (!is_assigned)
    throw std::invalid_argument(
        fmt::format("{}: the experiment beside it assigned this session to nobody", session_file.string()));
  if (who->is_out())
    throw std::invalid_argument(fmt::format(
        "{}: {} was {} ({}); 'kerf session new --replaces {}' makes a session for somebody else",
        session_file.string(), who->code, who->dropped ? "dropped" : "excluded", who->reason, who->code));
}

ExperimentLog::Facts run_facts(const SessionStore& store, bool is_rehearsal) {
  return {{"participant", store.session().subject},
          {"session", store.session().uuid},
          {"entries", store.session().entries.size()},
          {"finished", store.finished()},
          {"rehearsal", is_rehearsal},
          {"receipt", receipt_of(store).in_full()}};
}

}  // namespace kerf::bench

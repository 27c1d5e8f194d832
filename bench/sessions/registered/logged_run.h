#pragma once

#include <filesystem>
#include <optional>

#include "registered/experiment_log.h"
#include "sealed/session_store.h"

// What a run of a session has to do with the log of its experiment.

namespace kerf::bench {

/// The log beside a session that is of an experiment, whether or not it is there; of any other session none.
[[nodiscard]] std::optional<std::filesystem::path> log_of_session(const std::filesystem::path& session_file,
                                                                  const schema::Session& session);

/// @throws std::invalid_argument: the session of a participant who is out, or of whom nobody was assigned it.
void require_takes_part(const std::filesystem::path& session_file, const ExperimentLog& log,
                        const schema::Session& session);

/// What the log keeps of a run, its receipt above all.
[[nodiscard]] ExperimentLog::Facts run_facts(const SessionStore& store, bool is_rehearsal);

}  // namespace kerf::bench

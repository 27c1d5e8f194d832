#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "experiment/key_arguments.h"
#include "registered/experiment_state.h"
#include "registered/logged_run.h"
#include "sealed/session_store.h"

namespace kerf::bench {

/// Whether a reason that was given is none.
[[nodiscard]] bool is_blank(const std::string& text);

/// An experiment that a verb was given, with its log.
struct OpenedExperiment {
  std::filesystem::path file;  ///< experiment.toml, which may be missing by now
  ExperimentLog log;
  ExperimentState state;
};

/// @throws std::invalid_argument: no log, another key, a log that was changed.
[[nodiscard]] OpenedExperiment open_experiment(const std::filesystem::path& file_or_folder,
                                               KeyArguments& key);

/// The log beside a session that is of an experiment; of any other session, or where it is missing, nothing.
[[nodiscard]] std::optional<ExperimentLog> log_beside(const std::filesystem::path& session_file,
                                                      const schema::Session& session, KeyArguments& key);

/// Keeps in the log what a session was opened by itself for. @throws std::invalid_argument: the study is
/// under way, and no reason was given.
void log_opening(const std::filesystem::path& session_file, const SessionStore& store, KeyArguments& key,
                 const std::string& reason);

/// Lifts the blinding of a session to read it: its file keeps that, and the log of its experiment.
/// @throws as key_for(), record_opening(), SessionStore and log_opening() do.
[[nodiscard]] std::unique_ptr<SessionStore> opened_session(const std::string& file, KeyArguments& key,
                                                           const std::string& reason);

}  // namespace kerf::bench

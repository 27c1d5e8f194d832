#include "experiment/session_log.h"

#include <stdexcept>

#include <fmt/core.h>

#include "program/app.h"
#include "sealed/opening.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// The folder may have lost its experiment.toml; the log has what it said.
fs::path named_experiment(const fs::path& file_or_folder) {
  std::error_code ignored;
  if (fs::is_directory(file_or_folder, ignored) && fs::exists(file_or_folder / "experiment.log", ignored))
    return file_or_folder / "experiment.toml";
  return fs::exists(log_of(file_or_folder), ignored) ? file_or_folder : experiment_file(file_or_folder);
}

}  // namespace

bool is_blank(const std::string& text) { return text.find_first_not_of(" \t\r\n") == std::string::npos; }

OpenedExperiment open_experiment(const fs::path& file_or_folder, KeyArguments& key) {
  const fs::path file = named_experiment(file_or_folder);
  const fs::path log_file = log_of(file);
  if (!fs::exists(log_file))
    throw std::invalid_argument(
        fmt::format("{}: there is no such file; 'kerf session new {}' registers the experiment and makes its "
                    "sessions",
                    log_file.string(), file.string()));
  ExperimentLog log(log_file, key_for(key, ExperimentLog::derivation_of(log_file)));
  for (const std::string& warning : log.warnings()) warn(warning);
  ExperimentState state = experiment_state(file, log);
  return {.file = file, .log = std::move(log), .state = std::move(state)};
}

std::optional<ExperimentLog> log_beside(const fs::path& session_file, const schema::Session& session,
                                        KeyArguments& key) {
  const std::optional<fs::path> log_file = log_of_session(session_file, session);
  if (!log_file) return std::nullopt;
  std::error_code ignored;
  if (!fs::exists(*log_file, ignored)) {
    warn(fmt::format("{}: a session of an experiment, whose {} is not beside it: nothing is logged",
                     session_file.string(), log_file->filename().string()));
    return std::nullopt;
  }
  return ExperimentLog(*log_file, key_for(key, ExperimentLog::derivation_of(*log_file)));
}

void log_opening(const fs::path& session_file, const SessionStore& store, KeyArguments& key,
                 const std::string& reason) {
  auto log = log_beside(session_file, store.session(), key);
  if (!log) return;
  const ExperimentState state = experiment_state(session_file.parent_path() / "experiment.toml", *log);
  if (state.is_over() && !state.looks.empty()) return;
  if (is_blank(reason))
    throw std::invalid_argument(fmt::format(
        "{}: a session of an experiment that is under way; 'kerf session analyze {}' looks at it as "
        "was registered; --reason opens it by itself, and the study's log will keep that",
        session_file.string(), session_file.has_parent_path() ? session_file.parent_path().string() : "."));
  log->append(
      "opened",
      {{"participant", store.session().subject}, {"session", store.session().uuid}, {"reason", reason}});
}

std::unique_ptr<SessionStore> opened_session(const std::string& file, KeyArguments& key,
                                             const std::string& reason) {
  const SealKey seal = key_for(key, derivation_of(file));
  record_opening(file, seal, reason);
  auto store = std::make_unique<SessionStore>(file, seal, SessionStore::Purpose::read);
  log_opening(file, *store, key, reason);
  return store;
}

}  // namespace kerf::bench

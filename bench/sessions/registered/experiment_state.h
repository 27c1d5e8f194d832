#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "registered/experiment.h"
#include "registered/experiment_log.h"

namespace kerf::bench {

/// A session that a participant was assigned, and what its file says without its key.
struct AssignedSession {
  std::filesystem::path file;  ///< where it is by now
  std::string uuid;
  std::size_t visit = 1;
  bool is_there = false;
  bool begun = false;
  bool finished = false;
  bool rehearsed = false;
  std::size_t trials = 0;  ///< answered, practice included
};

struct Participant {
  std::string code;
  std::string group;
  std::size_t number = 0;  ///< whose order it has, from 1
  std::string replaces;
  std::string replaced_by;
  std::vector<AssignedSession> sessions;  ///< one a visit
  bool dropped = false;
  bool excluded = false;
  std::string reason;       ///< of either
  std::string rule;         ///< of an exclusion: the registered one, if it is one
  bool after_look = false;  ///< the answers had been looked at by then

  [[nodiscard]] bool begun() const;
  [[nodiscard]] bool completed() const;  ///< every visit is finished
  [[nodiscard]] bool is_out() const noexcept { return dropped || excluded; }
};

/// How far they came: "assigned", "begun", "completed", "dropped" or "excluded".
[[nodiscard]] std::string_view stage_of(const Participant& who) noexcept;

/// A look at the answers before this one, as the log has it.
struct PastLook {
  std::string time;
  std::vector<std::string> participants;
  bool paid = true;  ///< by the stopping rule
  std::string reason;
};

/// Where a study stands: what the log says, held against the files of its folder.
struct ExperimentState {
  Experiment experiment;  ///< as it was registered
  std::vector<Participant> participants;
  std::vector<PastLook> looks;
  std::vector<std::string> openings;  ///< of sessions by themselves, in words
  std::vector<std::string> receipts;  ///< of the runs, in full
  /// Files that are missing, foreign, doubled, renamed or older than they were.
  std::vector<std::string> problems;

  [[nodiscard]] const Participant* find(std::string_view code) const;
  /// Whether every order has a participant who is through, or one who left and is not to be replaced.
  [[nodiscard]] bool is_over() const;
};

/// @throws std::invalid_argument: a log whose facts are none; std::system_error.
[[nodiscard]] ExperimentState experiment_state(const std::filesystem::path& experiment_file,
                                               const ExperimentLog& log);

/// What binds a session to its experiment: an entry "registered" of its file.
struct SessionMembership {
  std::string experiment;  ///< digest_of() its text
  std::string participant;
  std::size_t visit = 1;
};
[[nodiscard]] std::string to_entry(const SessionMembership& membership);
/// Of a session of an experiment; of any other nothing.
[[nodiscard]] std::optional<SessionMembership> membership_of(const schema::Session& session);

/// Participants as a reviewer counts them (CONSORT).
struct FlowCounts {
  std::string group;
  std::size_t assigned = 0;
  std::size_t begun = 0;
  std::size_t completed = 0;
  std::size_t dropped = 0;
  std::size_t replaced = 0;  ///< of those dropped or excluded
  std::size_t excluded = 0;
  std::size_t analysed = 0;
};
/// Of all, then of each group where there are any.
[[nodiscard]] std::vector<FlowCounts> flow_of(const ExperimentState& state);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "registered/experiment_state.h"
#include "sealed/seal.h"
#include "sealed/session_store.h"

namespace kerf::bench {

/// The sessions of one participant, open to be read.
struct OpenParticipant {
  std::string code;
  std::vector<std::unique_ptr<SessionStore>> stores;  ///< by visit, those that have begun
};
[[nodiscard]] std::vector<const SessionStore*> sessions_of(const std::vector<OpenParticipant>& open);

/// Opens what a participant has begun, and holds it against the plan that it was sealed for and the receipts
/// of the log. What does not bear them out joins the problems of the state, an early opening its openings.
/// @param key_of the key of a session's file
/// @param warnings what the files say of themselves, one line each
/// @throws std::invalid_argument: sealed for another plan; as SessionStore and `key_of` do.
[[nodiscard]] OpenParticipant open_participant(
    const Participant& who, const std::function<SealKey(const std::filesystem::path&)>& key_of,
    ExperimentState& state, std::vector<std::string>& warnings);

/// Marks as excluded who has more trials of a kind than the plan allows for.
void exclude_by_measure(const std::vector<OpenParticipant>& open, const ExclusionPlan& rules,
                        ExperimentState& state);

}  // namespace kerf::bench

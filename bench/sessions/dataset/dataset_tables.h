#pragma once

#include <optional>
#include <vector>

#include "registered/experiment_state.h"
#include "sealed/session_store.h"
#include "sealed/trials/trial_quality.h"
#include "tables/described_table.h"

namespace kerf::bench {

/// A session and, of each of its trials, whether it counts: what its trace tells, which is large.
struct DatasetSession {
  const SessionStore* store;
  std::size_t number;  ///< of the participant's, from 1; of an experiment the visit
  std::vector<std::optional<TrialQuality>> quality;
};
[[nodiscard]] std::vector<DatasetSession> with_quality(const std::vector<const SessionStore*>& sessions);

/// A row a trial, practice included: what was played where, what was answered, whether it counts.
[[nodiscard]] DescribedTable trials_table(const std::vector<DatasetSession>& sessions);
/// A row a slot of a trial: what was felt while it played. A trial without a trace has none.
[[nodiscard]] DescribedTable slots_table(const std::vector<DatasetSession>& sessions);
/// A row an answer to an item of a questionnaire.
[[nodiscard]] DescribedTable questionnaires_table(const std::vector<DatasetSession>& sessions);
/// A row a participant: of an experiment (or nullptr) everybody who was assigned a session, with what became
/// of them.
[[nodiscard]] DescribedTable participants_table(const std::vector<DatasetSession>& sessions,
                                                const ExperimentState* experiment);

}  // namespace kerf::bench

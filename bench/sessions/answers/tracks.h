#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/quest_plus.h>
#include <kerf/psychophysics/staircase.h>

#include "protocol/judgement.h"

namespace kerf::bench {

struct AnalysisOptions;

/// The levels of one session, or of one of its staircases, in their order, and what its rule makes of them.
struct AdaptiveTrack {
  std::string subject;
  std::size_t session = 1;
  std::size_t number = 0;  ///< which of its staircases
  std::vector<double> levels;
  std::vector<bool> right;
  std::vector<std::size_t> reversals;  ///< trials at which a staircase turned
  std::optional<psychophysics::StaircaseEstimate> staircase;
  std::optional<psychophysics::QuestPlusEstimate> quest;
  std::string note;  ///< why there is no estimate
};

/// Of QUEST+ one a session, of staircases one each.
[[nodiscard]] std::vector<AdaptiveTrack> adaptive_tracks(const Study& study,
                                                         const std::vector<const Judgement*>& judgements,
                                                         const AnalysisOptions& options);

}  // namespace kerf::bench

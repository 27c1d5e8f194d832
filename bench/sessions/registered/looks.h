#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "registered/experiment_state.h"

namespace kerf::bench {

/// One look at the answers: what it may decide, and what the log has of it.
struct Look {
  std::size_t number = 1;                 ///< of all looks, from 1
  bool is_new = true;                     ///< not the last one again, at the same participants
  bool is_last = false;                   ///< everybody is through
  bool is_planned = true;                 ///< the registered rule has a look at so many
  bool is_paid = true;                    ///< false: the rule has nothing for it, and false alarms grow
  std::vector<std::string> participants;  ///< who is analysed
  std::string reason;                     ///< why, where the rule has none
  double spent = 0.0;                     ///< of alpha, this look included; of a Bayes factor 0
  double nominal = 0.0;                   ///< the p value that decides here
};

/// What a look is taken at.
struct LookRequest {
  std::vector<std::string> participants;
  std::string reason;  ///< empty: none was given
  bool two_sided = false;
};

/// The look that these participants make, after those of the log.
/// @throws std::invalid_argument: nobody is through; the rule refuses it, and no reason was given.
[[nodiscard]] Look look_at(const ExperimentState& state, const LookRequest& request);

/// What a study may spend at these numbers of participants, of a fixed rule all at the target.
struct LookLevel {
  double spent = 0.0;
  double nominal = 0.0;
};
[[nodiscard]] std::vector<LookLevel> look_levels(const Experiment& experiment,
                                                 const std::vector<std::size_t>& participants,
                                                 bool two_sided);

/// What a log keeps of it.
[[nodiscard]] ExperimentLog::Facts facts_of(const Look& look);

/// What the primary test says at a look.
struct LookDecision {
  double p_value = std::numeric_limits<double>::quiet_NaN();  ///< of the registered test
  std::optional<double> bayes_factor;                         ///< of that rule; NaN: not to be had
  bool is_shown = false;  ///< the registered hypothesis, at this look's level
  bool ends = false;      ///< the rule says that the study is over
  std::string text;       ///< one sentence
};

}  // namespace kerf::bench

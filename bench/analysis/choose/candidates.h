#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

namespace kerf::bench {

using models::Effect;
[[nodiscard]] std::string_view name_of(Effect effect) noexcept;
using Effects = std::set<Effect>;

/// A law as it may be chosen: with the options that make it simpler or richer.
struct CandidateLaw {
  std::string name;                      ///< "piecewise-3-loop"; of its law file, too
  std::string model;                     ///< in the registry
  std::vector<std::string> law_options;  ///< NAME=VALUE
  std::size_t parameters = 0;            ///< that are fitted
  Effects effects;
};

struct CandidateOptions {
  std::size_t max_segments = 12;  ///< of a segmented law, 1 to 16
  std::size_t max_arms = 4;       ///< of a law that a fit makes larger, 1 to 6
};

/// Every scalar law whose units fit an axis, in each form that its facts name, those with fewest parameters
/// first: from a straight line to tables of the recorded force. Those with a branch for each direction are
/// among them only where there are cycles.
[[nodiscard]] std::vector<CandidateLaw> candidates_for(const schema::Axis& axis, bool has_cycles,
                                                       const CandidateOptions& options = {});

}  // namespace kerf::bench

#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

#include <kerf/fitting/fit.h>
#include <kerf/schema/recording.h>

#include "choose/candidate_search.h"
#include "choose/candidates.h"

namespace kerf::bench {

struct ChooseOptions {
  std::size_t axis = 0;
  std::optional<models::Contact> contact;  ///< by default contact_of() the recording
  CandidateOptions candidates;
  fitting::FitOptions fit;       ///< JND and folds
  RowChoice rows{};              ///< that count
  double loop_rate_hz = 1000.0;  ///< of the loop that errors are of
  std::size_t threads = 1;  ///< among which the candidates are shared out; the choice does not depend on it
  std::atomic<std::size_t>* done = nullptr;  ///< counts the candidates that were fitted
  std::atomic<std::size_t>* of = nullptr;    ///< becomes the number of candidates
  bool richer_too = true;  ///< also fit what is richer than the law that serves, for the table
  /// Measure what a tick of each law costs, which no two runs do alike. Else it is 0 of all, and of laws with
  /// as many parameters the one that knows fewer effects comes first.
  bool time_ticks = true;
  CandidateSearchOptions search;
};

/// Fits every candidate to an axis of a recording and takes the simplest that serves (candidate_search.h), by
/// its error on held-out data and the JND at the recording's root mean square force. So a richer law is taken
/// only if the simpler ones leave out more than the JND.
/// @throws std::invalid_argument for a recording without force, a missing axis, or one that no law can be
/// fitted to; std::system_error if it was stopped.
[[nodiscard]] LawChoice choose_law(const schema::Recording& recording, const ChooseOptions& options,
                                   const std::atomic<bool>& stop);

}  // namespace kerf::bench

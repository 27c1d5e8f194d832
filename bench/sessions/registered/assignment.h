#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "registered/experiment_state.h"
#include "sealed/session_store.h"

namespace kerf::bench {

/// A session that a participant is to have.
struct Assignment {
  std::string participant;
  std::string group;
  std::size_t number = 0;
  std::size_t visit = 1;
  std::string replaces;
  Plan plan;

  /// S01.h5, of several visits S01-2.h5
  [[nodiscard]] std::string file_name(const Experiment& experiment) const;
};

/// S01, S02, ...: as many digits as the last one has, two at least.
[[nodiscard]] std::string code_of(std::size_t number, std::size_t subjects);

/// Of all participants and visits; the orders of each visit balanced over those of each group.
[[nodiscard]] std::vector<Assignment> assignments_of(const Experiment& experiment, const Protocol& protocol,
                                                     std::uint64_t seed);

/// Writes the session of an assignment, bound to its experiment. Returns what the log has of it.
/// @throws as SessionStore::create() does.
ExperimentLog::Facts create_assigned(const std::filesystem::path& file, const Assignment& assignment,
                                     const Experiment& experiment, const Protocol& protocol,
                                     const SealKey& key, const schema::KeyDerivation& derivation);

/// What the log registers: the experiment's text, and of protocol and laws what finds a change.
[[nodiscard]] ExperimentLog::Facts registered_facts(const Experiment& experiment, const Protocol& protocol);

/// Whether `leaving` may be replaced by `code` under the registered rule; an empty code stands for the next
/// one that is free, which is returned.
/// @throws std::invalid_argument: nobody of that name, not dropped, replaced already, a code that is taken.
[[nodiscard]] std::string replacement_code(const ExperimentState& state, const std::string& leaving,
                                           const std::string& code);

}  // namespace kerf::bench

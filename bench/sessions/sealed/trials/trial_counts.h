#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "sealed/session_store.h"

namespace kerf::bench {

/// How many trials of a session count, and why others do not: nothing by sample, slot or level.
struct TrialCounts {
  std::size_t given = 0;  ///< practice and void ones included
  std::size_t practice = 0;
  std::size_t counted = 0;
  std::size_t voided = 0;
  std::size_t left_out = 0;                           ///< of those, that do not come again
  std::array<std::size_t, void_reasons> by_reason{};  ///< one trial may have several
  std::optional<bool> practised;                      ///< TrialSequence::practised()
};

[[nodiscard]] TrialCounts counts_of(const SessionStore& session);

/// "26 trials answered, 24 count, 2 void (fault 1, soft-start 1), 1 of them left out"
[[nodiscard]] std::string in_words(const TrialCounts& counts);

}  // namespace kerf::bench

#pragma once

#include <limits>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "regress/run.h"

namespace kerf::bench {

/// A tick near the worst one, in the channel of the worst.
struct ContextRow {
  std::size_t tick = 0;
  double time_s = 0.0;
  double position = std::numeric_limits<double>::quiet_NaN();  ///< NaN past the end
  double velocity = std::numeric_limits<double>::quiet_NaN();
  double expected = std::numeric_limits<double>::quiet_NaN();
  double got = std::numeric_limits<double>::quiet_NaN();
};

/// So many ticks before and after the worst one; none if nothing differs.
[[nodiscard]] std::vector<ContextRow> context_of(const RegressionOutcome& outcome, std::size_t ticks = 5);

/// The same as a table of text, with a head, for people.
[[nodiscard]] std::string context_table(const RegressionOutcome& outcome);

/// Everything about a suite's run, for --json.
[[nodiscard]] nlohmann::ordered_json outcome_as_json(const Suite& suite, const SuiteOutcome& outcome);

}  // namespace kerf::bench

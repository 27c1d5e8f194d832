#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/compare/agreement.h>
#include <kerf/compare/align.h>
#include <kerf/compare/compare.h>
#include <kerf/compare/diagnose.h>

#include "compare/compared_run.h"
#include "replay/force_events.h"

namespace kerf::bench {

struct RunComparisonOptions {
  compare::AlignOptions align;
  compare::Tolerance tolerance;
  double match_s = 0.05;  ///< events that are farther apart are not the same
};

/// How two runs differ.
struct RunComparison {
  std::string expected;  ///< their files
  std::string got;
  compare::Aligned runs;  ///< beside each other
  compare::Comparison comparison;
  std::vector<compare::ChannelAgreement> agreement;
  std::vector<std::array<EventMatch, 3>> events;  ///< of each channel
  compare::Diagnosis diagnosis;
  std::vector<std::string> names;  ///< what changed, a line each; none if the runs are within the tolerance
  std::vector<std::string> notes;
  /// Where rows are missing: which ticks of the expected run lie beside each other.
  std::vector<std::size_t> ticks;

  /// Where a tick of the comparison lies among the rows beside each other.
  [[nodiscard]] std::size_t row_of(std::size_t tick) const;
};

/// Puts two runs beside each other and compares them. By tick, runs of different length do not pass, and
/// ticks of a run with samples missing are compared with their own partners.
/// @throws std::invalid_argument as compare::aligned() and compare::in_order_of() do, naming both files.
[[nodiscard]] RunComparison compare_runs(ComparedRun expected, ComparedRun got,
                                         const RunComparisonOptions& options);

/// Everything about it, for --json.
[[nodiscard]] nlohmann::ordered_json comparison_as_json(const RunComparison& result,
                                                        const RunComparisonOptions& options);

/// Where none was found among those that were looked for; else empty.
[[nodiscard]] std::string unknown_lag_in_words(const RunComparison& result);

/// The same as lines for people.
[[nodiscard]] std::vector<std::string> comparison_lines(const RunComparison& result);

}  // namespace kerf::bench

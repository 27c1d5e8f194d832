#pragma once

#include <array>
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
};

/// Puts two runs beside each other and compares them. By tick, runs of different length do not pass, and
/// ticks of a run with samples missing are compared with their own partners.
/// @throws std::invalid_argument as compare::aligned() and compare::in_order_of() do, naming both files.
[[nodiscard]] RunComparison compare_runs(ComparedRun expected, ComparedRun got,
                                         const RunComparisonOptions& options);

/// Everything about it, for --json.
[[nodiscard]] nlohmann::ordered_json comparison_as_json(const RunComparison& result,
                                                        const RunComparisonOptions& options);

/// The same as lines for people.
[[nodiscard]] std::vector<std::string> comparison_lines(const RunComparison& result);

}  // namespace kerf::bench

#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "registered/experiment_report.h"

// The experiment of an analysis, in lines, as JSON and for the page.

namespace kerf::bench {

/// "participants: 13 assigned, 12 begun, ...", who is out and why, and what is wrong with the files.
[[nodiscard]] std::vector<std::string> flow_lines(const ExperimentState& state,
                                                  const std::vector<FlowCounts>& flow);
[[nodiscard]] nlohmann::ordered_json flow_json(const ExperimentState& state,
                                               const std::vector<FlowCounts>& flow);

[[nodiscard]] std::vector<std::string> experiment_lines(const ExperimentReport& report);
[[nodiscard]] nlohmann::ordered_json experiment_json(const ExperimentReport& report);
[[nodiscard]] std::string experiment_section(const ExperimentReport& report);

}  // namespace kerf::bench

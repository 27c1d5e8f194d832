#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "answers/analysis.h"

// Magnitudes and ratings as JSON, lines, sentences and a part of the page.

namespace kerf::bench {

[[nodiscard]] nlohmann::ordered_json estimates_as_json(const EstimateAnalysis& estimates);
[[nodiscard]] std::vector<std::string> estimate_lines(const Analysis& analysis);
[[nodiscard]] std::string estimates_section(const Analysis& analysis);

/// Of questionnaires; empty where there are none.
[[nodiscard]] nlohmann::ordered_json questionnaire_as_json(const Analysis& analysis);
[[nodiscard]] std::vector<std::string> questionnaire_lines(const Analysis& analysis);
[[nodiscard]] std::string questionnaire_section(const Analysis& analysis);

/// Adds what they show and what they do not.
void add_estimate_findings(Analysis& analysis);

}  // namespace kerf::bench

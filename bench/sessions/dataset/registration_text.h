#pragma once

#include <string>

#include "registered/experiment_state.h"

namespace kerf::bench {

/// The experiment that the sessions of a dataset are of.
struct DatasetExperiment {
  ExperimentState state;
  std::string registered_at;  ///< ISO 8601, UTC
  std::string log;            ///< experiment.log, as it is
};

/// What was registered, who took part, and when the answers were looked at: paragraphs of Markdown.
[[nodiscard]] std::string registration_text(const DatasetExperiment& of);

}  // namespace kerf::bench

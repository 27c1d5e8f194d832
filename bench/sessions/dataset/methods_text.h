#pragma once

#include <string>
#include <vector>

#include "dataset/dataset_tables.h"
#include "dataset/registration_text.h"

namespace kerf::bench {

/// A methods section in Markdown, of what the sessions themselves say: participants, apparatus as it was run,
/// renderings with their gains, the course of a trial, timing as it was met, what does not count, software.
/// Of an experiment (or nullptr) also what was registered, who took part, and when the answers were looked
/// at. Nothing of the results.
[[nodiscard]] std::string methods_text(const std::vector<DatasetSession>& sessions,
                                       const DatasetExperiment* experiment);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plot/plot.h"
#include "regress/run.h"

namespace kerf::bench {

/// Expected and got around the worst tick, then of the worst channel, and of others that are outside, over
/// the whole trajectory both and their difference with what is allowed. None if nothing differs.
[[nodiscard]] std::vector<Figure> figures_of(const RegressionOutcome& outcome);

/// Writes regress.html, regress.json and the pictures of the cases that did not pass into a folder.
/// @throws std::system_error; std::runtime_error if gnuplot is missing.
void write_regress_page(const Suite& suite, const SuiteOutcome& outcome, const std::filesystem::path& folder);

}  // namespace kerf::bench

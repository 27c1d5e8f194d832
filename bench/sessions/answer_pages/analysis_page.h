#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "answers/analysis.h"

namespace kerf::bench {

/// One self-contained page: what is shown and what is not, tables and drawings. `drawings` are those of
/// analysis_figures(), drawn.
[[nodiscard]] std::string analysis_page(const Analysis& analysis, std::span<const std::string> drawings);

/// Writes analysis.html, analysis.json, answers.csv and a drawing (.svg) of each figure into a folder, which
/// is made where it is missing. Returns the names of the files.
/// @throws std::invalid_argument: analysis.html is there and not `replace`; std::system_error;
///         std::runtime_error: gnuplot is not installed.
std::vector<std::string> write_analysis(const Study& study, const Analysis& analysis,
                                        const std::filesystem::path& folder, bool replace);

}  // namespace kerf::bench

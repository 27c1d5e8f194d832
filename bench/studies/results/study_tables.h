#pragma once

#include <filesystem>

#include "results/study_results.h"

namespace kerf::bench {

/// Writes recordings.csv, cycles.csv, parameters.csv, groups.csv, held_out.csv, comparisons.csv: one row an
/// observation, a cell empty where nothing is known; and data_dictionary.csv with what each column is and its
/// unit. @throws std::system_error.
void write_study_tables(const StudyResults& results, const std::filesystem::path& folder);

}  // namespace kerf::bench

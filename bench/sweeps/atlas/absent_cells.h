#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <kerf/schema/sweep_tables_file.h>

#include "plan/sweep_plan.h"

namespace kerf::bench {

/// Cells of a plan that have no row in any table, in order.
struct AbsentCells {
  std::vector<std::uint64_t> failed;
  std::vector<std::uint64_t> missing;
};

/// The cells that are in no table: those that `failed.csv` beside the file names have failed.
/// @throws std::invalid_argument for a cell that the plan does not have.
[[nodiscard]] AbsentCells absent_cells(const schema::SweepTablesFile& tables, const SweepPlan& plan,
                                       const std::filesystem::path& file);

/// The input whose value names the table of a cell, such as the law of a fit; none: there is one table.
[[nodiscard]] std::size_t naming_input(const SweepPlan& plan, const std::string& table);
inline constexpr std::size_t no_input = static_cast<std::size_t>(-1);

/// Those that would have been in a table.
[[nodiscard]] AbsentCells absent_in_table(const AbsentCells& all, const SweepPlan& plan,
                                          const std::string& table);

}  // namespace kerf::bench

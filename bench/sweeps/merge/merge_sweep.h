#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "merge/gathered_cells.h"

namespace kerf::bench {

/// A table that cells of a kind make up: the union of their columns.
struct MergedTable {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<CellColumn> columns;  ///< of what comes out
};

/// Tables in the order of their names. Their columns are those of the largest layout, then what others have
/// besides, so that they depend on what the cells gave and not on who gave it first. Where cells of a table
/// measure a column in several units, each unit has its own: "stiffness_N_per_rad".
class MergedTables {
 public:
  explicit MergedTables(const GatheredCells& cells);
  [[nodiscard]] const std::vector<MergedTable>& all() const noexcept { return tables_; }

  struct Place {
    std::size_t table = 0;
    std::vector<std::size_t> columns;  ///< of the table, of each column of the layout
  };
  [[nodiscard]] const Place& of(std::uint64_t layout) const { return places_.at(layout); }

 private:
  std::vector<MergedTable> tables_;
  std::map<std::uint64_t, Place> places_;
};

/// Writes into a folder what the shards of a plan came to, cell by cell in their order: sweep.h5 and
/// TABLE.csv with the same numbers, failed.csv, missing.csv, columns.csv (what each column is), and
/// times.csv, which alone differs from run to run. `done` counts cells. @throws std::system_error
void write_merged(const PlanFile& plan, const GatheredCells& cells, const std::filesystem::path& folder,
                  std::atomic<std::size_t>& done);

}  // namespace kerf::bench

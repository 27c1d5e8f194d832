#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/sweep_tables_file.h>

#include "atlas/absent_cells.h"
#include "plan/sweep_plan.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {

/// A column of a table of a sweep.
struct AtlasColumn {
  std::string name;
  std::string unit = "1";
  std::string what;
  bool is_input = false;
  /// Of an input that has no more than `SweepAtlas::most_values`: all of them, numbers in order, as texts
  /// and, where they are numbers, as such. Empty for other columns.
  std::vector<std::string> texts{};
  std::vector<double> values{};

  [[nodiscard]] bool is_listed() const noexcept { return !texts.empty(); }
  [[nodiscard]] bool is_text() const noexcept { return is_listed() && values.empty(); }
};

/// A kind of cells: those that were computed, then those of the plan that failed, then those that are
/// missing. These two are nowhere in the table, and counted all the same.
struct AtlasTable {
  std::string name;
  std::size_t computed = 0;
  std::vector<std::uint64_t> failed;   ///< numbers of cells
  std::vector<std::uint64_t> missing;  ///< likewise
  std::vector<AtlasColumn> columns;    ///< inputs in the order of the verb, then what came out

  [[nodiscard]] std::size_t cells() const noexcept { return computed + failed.size() + missing.size(); }
  /// @throws std::invalid_argument that lists them.
  [[nodiscard]] std::size_t column_called(std::string_view column) const;
};

/// The values of a column. Of an input those of all cells, of what came out those of the computed ones.
struct AtlasValues {
  std::vector<std::uint16_t> codes;  ///< of a listed input: places in its list
  std::vector<double> numbers;       ///< of any other column; NaN: not known

  [[nodiscard]] std::size_t bytes() const noexcept {
    return codes.size() * sizeof(codes[0]) + numbers.size() * sizeof(numbers[0]);
  }
};

/// A sweep that was merged, to be looked at from all sides. Of its file only the columns that are asked for
/// are read, and kept as long as there is room for them. For any thread.
class SweepAtlas {
 public:
  static constexpr std::size_t most_values = 1000;         ///< of an input whose values are listed
  static constexpr std::uint64_t most_cells = 50'000'000;  ///< of a plan that is looked at
  static constexpr std::size_t most_bytes = 160UL << 20U;  ///< of columns that are kept

  /// @param merged the folder that 'kerf sweep merge' wrote, or the sweep.h5 in it.
  /// @throws schema::FormatError, std::invalid_argument in one line.
  explicit SweepAtlas(const std::filesystem::path& merged, SweepVerbs verbs = sweep_verbs());

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  [[nodiscard]] const SweepPlan& plan() const noexcept { return plan_; }
  [[nodiscard]] std::string software() const;
  [[nodiscard]] const std::vector<AtlasTable>& tables() const noexcept { return tables_; }
  /// @throws std::invalid_argument that lists them.
  [[nodiscard]] std::size_t table_called(std::string_view name) const;
  [[nodiscard]] std::shared_ptr<const AtlasValues> values(std::size_t table, std::size_t column);

 private:
  struct Kept {
    std::size_t table;
    std::size_t column;
    std::shared_ptr<const AtlasValues> values;
  };

  [[nodiscard]] AtlasValues read(std::size_t table, std::size_t column) const;
  void add_table(const schema::SweepTable& table, AbsentCells absent);
  [[nodiscard]] std::size_t place_in_file(std::size_t table, const std::string& column) const;

  std::filesystem::path file_;
  schema::SweepTablesFile tables_file_;
  SweepPlan plan_;
  std::vector<AtlasTable> tables_;
  std::mutex mutex_;
  std::list<Kept> kept_;  ///< the one asked for last comes first
};

/// The sweep.h5 that a person names by it or by its folder.
[[nodiscard]] std::filesystem::path merged_file(const std::filesystem::path& merged);
/// Whether that is a merged sweep, and not a recording.
[[nodiscard]] bool is_merged_sweep(const std::filesystem::path& path);

}  // namespace kerf::bench

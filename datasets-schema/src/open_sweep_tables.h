#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <kerf/schema/sweep_tables_file.h>

#include "hdf5/h5.h"

namespace kerf::schema::in_process {

/// A file of SweepTablesWriter, read in the very process that calls it (in_process.h).
class OpenSweepTables {
 public:
  /// @throws as SweepTablesFile.
  explicit OpenSweepTables(const std::filesystem::path& file);

  [[nodiscard]] const SweepTablesFacts& facts() const noexcept { return facts_; }
  /// Some rows of a column. @throws FormatError, std::out_of_range.
  void read(std::size_t table, std::size_t column, std::uint64_t first, std::span<double> values) const;

 private:
  void require_layout();
  [[nodiscard]] SweepTablesFacts::Texts texts_of(const std::string& input) const;
  void open_table(const std::string& name);

  std::filesystem::path file_;
  h5::Handle opened_;
  SweepTablesFacts facts_;
  std::vector<std::vector<h5::Handle>> datasets_;
};

}  // namespace kerf::schema::in_process

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <kerf/schema/sweep_tables.h>

namespace kerf::schema {

/// A table, without its values.
struct SweepTable {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<SweepColumn> columns;
};

/// What a file of a sweep's tables says beside their values.
struct SweepTablesFacts {
  std::string plan_sha256;
  std::string plan;      ///< JSON
  std::string software;  ///< of the programs that computed it
  std::string cells;     ///< "20 computed, 0 failed, 0 missing"
  std::vector<SweepTable> tables;
  /// The texts that an input has; cells name them by their place.
  struct Texts {
    std::string input;
    std::vector<std::string> texts;
  };
  std::vector<Texts> texts;
};

/// An open file of a sweep, whose columns stay in the file until they are asked for. It is read by a process
/// of its own, `kerf-reader`, like recordings. May be used by several threads, one at a time.
class SweepTablesFile {
 public:
  /// @throws FormatError (another schema, damage), std::invalid_argument (no such file), std::system_error.
  explicit SweepTablesFile(const std::filesystem::path& file);
  SweepTablesFile(SweepTablesFile&&) noexcept;
  SweepTablesFile& operator=(SweepTablesFile&&) noexcept;
  ~SweepTablesFile();

  [[nodiscard]] const SweepTablesFacts& facts() const noexcept;
  /// All of a column, whatever its type.
  [[nodiscard]] std::vector<double> column(std::size_t table, std::size_t column) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kerf::schema

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/final_name.h>

namespace kerf::schema {

inline constexpr std::string_view sweep_tables_name = "kerf.sweep";
inline constexpr std::uint32_t sweep_tables_version = 1;

/// A column of a table of a sweep; one value a row.
struct SweepColumn {
  enum class Type : std::uint8_t {
    number,  ///< float64; NaN: not known
    whole,   ///< uint64
    code     ///< uint32, a place in /values/NAME
  };
  std::string name;
  std::string unit = "1";
  Type type = Type::number;
};

/// A table, without its values.
struct SweepTableFacts {
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
  std::vector<SweepTableFacts> tables;
  /// Of an input that is a text how many there are.
  struct Texts {
    std::string input;
    std::uint64_t count = 0;
  };
  std::vector<Texts> values;
};

/// @throws FormatError in one line; std::invalid_argument (there is no such file, or it may not be read).
[[nodiscard]] SweepTablesFacts read_sweep_tables_facts(const std::filesystem::path& file);

/// Writes what a sweep came to: an HDF5 file that holds no time and no name of a machine, so that the same
/// numbers are the same bytes.
///
///     /values/NAME   the texts that an input NAME has: {text}
///     /TABLE/NAME    a column, with its attribute `units`; all of a table have as many rows
///
/// and texts about the sweep as attributes of the root. Every function throws std::system_error if it cannot
/// be written.
class SweepTablesWriter {
 public:
  /// Begins a temporary file beside `file`. @throws std::system_error
  explicit SweepTablesWriter(std::filesystem::path file);
  SweepTablesWriter(const SweepTablesWriter&) = delete;
  SweepTablesWriter& operator=(const SweepTablesWriter&) = delete;
  /// Removes what was not committed.
  ~SweepTablesWriter();

  void describe(const std::string& name, const std::string& text);
  void add_values(const std::string& input, const std::vector<std::string>& values);
  /// @returns the number of the table.
  std::size_t add_table(const std::string& name, std::uint64_t rows, const std::vector<SweepColumn>& columns);
  /// The next values of a column.
  void append(std::size_t table, std::size_t column, std::span<const double> values);
  /// @throws as take_name() too.
  void commit(Existing existing);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kerf::schema

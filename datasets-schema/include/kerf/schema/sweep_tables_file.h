#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/sweep_tables.h>

namespace kerf::schema {

/// A text about the whole sweep.
struct SweepNote {
  std::string name;
  std::string text;
};

/// The texts that an input has; cells name them by their place.
struct SweepTexts {
  std::string input;
  std::vector<std::string> texts;
};

struct SweepTable {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<SweepColumn> columns;  ///< in the order in which they were written
};

/// All that a file of SweepTablesWriter says but for its numbers.
struct SweepTablesFacts {
  std::vector<SweepNote> notes;
  std::vector<SweepTexts> texts;
  std::vector<SweepTable> tables;

  /// Nothing where there is no such note.
  [[nodiscard]] std::optional<std::string> note(std::string_view name) const;
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

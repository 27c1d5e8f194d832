#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace kerf::bench {

/// A table of numbers as renderers read and write it: a line of names with their units, `x[m]`, then a row a
/// tick, separated by commas. Lines with '#' before the head declare: `# sign: resisting`.
struct NumberTable {
  std::vector<std::pair<std::string, std::string>> declared;
  std::vector<std::string> names;  ///< as they stand, with units
  std::vector<double> values;      ///< N x D, row-major; nan and inf as they stand

  [[nodiscard]] std::size_t rows() const noexcept { return names.empty() ? 0 : values.size() / names.size(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    return values[row * names.size() + column];
  }
  /// The column of a name; names.size() if there is none.
  [[nodiscard]] std::size_t column(const std::string& name) const;
};

/// @throws std::invalid_argument with file and line for what is no such table: no head, a row of another
/// length (the last one may be half written), a word that is no number; a file of more than that many bytes.
[[nodiscard]] NumberTable read_number_table(const std::filesystem::path& file, std::uintmax_t at_most);

}  // namespace kerf::bench

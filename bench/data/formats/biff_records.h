#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::bench {

/// A number, a truth or an error as a record of a sheet has it.
struct BiffCell {
  enum class Kind : std::uint8_t { number, date, truth, error, no_number };  ///< the last: of a formula
  Kind kind = Kind::number;
  double value = 0.0;  ///< days of a date, the code of an error
};

/// What the records of a sheet say that freexl does not tell: which cells are dates and of which moment (it
/// gives them as text, to the second), truths, errors, merged cells, whether the sheet is hidden.
struct BiffSheet {
  bool hidden = false;
  std::map<std::pair<std::uint16_t, std::uint16_t>, BiffCell> cells;  ///< by row and column, from 0
  std::string merged;                                                 ///< "A1:C1, A9:B9", the first of them
};

/// The sheets of an Excel workbook of before 2007 in their order, by [MS-CFB] (the container) and [MS-XLS]
/// and BIFF5 (the records). Empty for what is none, or damaged before the first; cells stop where a sheet is.
[[nodiscard]] std::vector<BiffSheet> biff_sheets(std::string_view file);

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/unpacked_limits.h"

namespace kerf::bench {

/// A sheet as text: one line a row, from row 1, and a tab between columns, from column A.
struct Sheet {
  std::string name;
  std::string text;
  std::vector<std::string> notes;
};

/// A sheet among the others of its book.
struct SheetName {
  std::string name;
  bool hidden = false;
};

/// A row with what stands in it, by its column from 0.
struct SheetRow {
  std::size_t number = 0;  ///< from 1
  std::map<std::size_t, std::string> cells;
};

/// What is to be told of the cells of a sheet.
struct CellCounts {
  std::string comma{};        ///< the first number with one
  std::size_t comma_row = 0;  ///< and where it stands
  std::size_t dates = 0;
  std::size_t commas = 0;
  std::size_t formulas = 0;  ///< without a value
  std::size_t wordy = 0;     ///< formulas whose value is a text or an error, and not read
  std::size_t numbers = 0;

  [[nodiscard]] bool has_numbers() const noexcept { return numbers + commas > 0; }
};

/// The whole of a text as a number with a decimal point.
[[nodiscard]] std::optional<double> cell_number(std::string_view text);

/// A text as a cell of a table: tabs and line ends are blanks, a number with a decimal comma has a point.
[[nodiscard]] std::string text_cell(std::string text, std::size_t row, CellCounts& counts);

/// Days as seconds.
[[nodiscard]] std::string date_cell(double days, CellCounts& counts);

/// A line a row, also for those that are not there, with a field for each of `width` columns.
/// @throws std::invalid_argument if it is longer than allowed.
[[nodiscard]] std::string rows_as_text(const std::vector<SheetRow>& rows, std::size_t width,
                                       const UnpackedLimits& limits);

/// A sentence each, which names the sheet. `merged` lists merged cells, "A1:C1, A9:B9"; empty: there are
/// none.
[[nodiscard]] std::vector<std::string> cell_notes(const std::string& sheet, const CellCounts& counts,
                                                  bool epoch_1904, const std::string& merged);

/// "'Run 1', 'Old' (hidden)", without one of them if it is named.
[[nodiscard]] std::string sheet_names(const std::vector<SheetName>& sheets,
                                      std::optional<std::size_t> without = {});

/// By name, or by number from 1. @throws std::invalid_argument that lists what there is.
[[nodiscard]] std::size_t asked_sheet(const std::vector<SheetName>& sheets, const std::string& asked,
                                      const std::string& file);

/// Reads the sheet that is asked for or, if none is, the first that is not hidden and has numbers, and says
/// which others there are. `read` takes the place of a sheet and counts what is in it.
/// @throws std::invalid_argument that lists what there is; as `read` does.
template <typename Read>
Sheet taken_sheet(const std::vector<SheetName>& sheets, const std::string& asked, const std::string& file,
                  const Read& read);

/// @throws std::invalid_argument that lists what there is.
[[noreturn]] void refuse_without_numbers(const std::vector<SheetName>& sheets, const std::string& file);

/// That another sheet could be taken; empty if there is none.
[[nodiscard]] std::string taken_note(const std::vector<SheetName>& sheets, std::size_t taken);

template <typename Read>
Sheet taken_sheet(const std::vector<SheetName>& sheets, const std::string& asked, const std::string& file,
                  const Read& read) {
  CellCounts counts;
  if (!asked.empty()) return read(asked_sheet(sheets, asked, file), counts);
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (sheets[i].hidden) continue;
    counts = {};
    Sheet sheet = read(i, counts);
    if (!counts.has_numbers()) continue;
    if (std::string note = taken_note(sheets, i); !note.empty()) sheet.notes.push_back(std::move(note));
    return sheet;
  }
  refuse_without_numbers(sheets, file);
}

}  // namespace kerf::bench

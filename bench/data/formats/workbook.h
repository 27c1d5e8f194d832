#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "formats/sheet_cells.h"
#include "formats/unpacked_limits.h"

namespace kerf::bench {

[[nodiscard]] bool is_zip(std::string_view bytes) noexcept;

/// A spreadsheet as ECMA-376 and ISO/IEC 29500 (strict, too) have it: xlsx, xlsm. Cells as they were
/// computed last: a number as it stands in the file, so that nothing is lost; a text with tabs and line ends
/// as blanks, and a number that was written as text with a decimal comma as one with a point; true as 1,
/// false as 0; a date or a duration in seconds, dates from 1899-12-30 on (1904-01-01 where the book says so);
/// an error as its text. Empty are a formula whose value was not kept, and all but the first of merged cells.
class Workbook {
 public:
  /// @throws std::invalid_argument for a zip that holds no workbook, is damaged or unpacks to too much.
  Workbook(std::string_view bytes, UnpackedLimits limits);
  Workbook(const Workbook&) = delete;
  Workbook& operator=(const Workbook&) = delete;
  ~Workbook();

  /// By name, by number from 1, or, if nothing is asked for, the first that is not hidden and has numbers.
  /// @throws std::invalid_argument that lists what there is.
  [[nodiscard]] Sheet sheet(const std::string& asked);

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kerf::bench

#pragma once

#include <string>
#include <string_view>

#include "formats/sheet_cells.h"
#include "formats/unpacked_limits.h"

namespace kerf::bench {

/// An Excel workbook of before 2007 (BIFF5 and BIFF8 in a compound file), or another old Office file.
[[nodiscard]] bool is_xls(std::string_view bytes) noexcept;

/// A sheet of it, chosen and written as those of Workbook are: by freexl, and by what its records say that
/// freexl does not (biff_records.h). The value of a formula that is a text or an error is empty.
/// freexl believes what a file says of itself: call it in a process of its own (unpacked_apart.h).
/// @throws std::invalid_argument for a file that is damaged, holds no workbook, is encrypted, or has no such
///         sheet; std::system_error if there is no memory for a copy.
[[nodiscard]] Sheet xls_sheet(std::string_view bytes, const std::string& asked, const UnpackedLimits& limits);

}  // namespace kerf::bench

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/unpacked_limits.h"

namespace kerf::bench {

/// What a packed file was made to.
struct Unpacked {
  std::string sheet;  ///< of a workbook, that it is of
  std::vector<std::string> notes;
  std::string text;
};

/// A workbook's sheet, chosen as Workbook::sheet() does, or a MAT-file's variables as text, by `kerf-unpack`:
/// a process of its own, since libraries take memory as a damaged file asks for it and believe what it says
/// of itself. It may take as much memory as is allowed to be unpacked and 1 GiB, and two minutes of a
/// processor.
/// @throws std::invalid_argument as the readers do, and if the process fell over the file or ran out of what
/// it
///         may take; std::system_error if there is no process to be had.
[[nodiscard]] Unpacked unpacked_apart(std::string_view bytes, const std::string& sheet,
                                      const UnpackedLimits& limits);

/// What that process does: `path` has the same bytes. @throws std::invalid_argument as the readers do.
[[nodiscard]] Unpacked unpacked_here(std::string_view bytes, const std::string& path,
                                     const std::string& sheet, const UnpackedLimits& limits);

/// How it tells, and how that is read. @throws std::invalid_argument of a refusal, with its reason.
[[nodiscard]] std::string answer_of(const Unpacked& unpacked);
[[nodiscard]] std::string refusal_of(std::string_view why);
[[nodiscard]] Unpacked unpacked_from(const std::string& answer);

}  // namespace kerf::bench

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/unpacked_limits.h"

namespace kerf::bench {

/// The variables of a MAT-file as text: a row of names, then one line an element, with a tab between columns.
struct MatTable {
  std::string text;
  std::vector<std::string> notes;
};

/// A MAT-file of level 5 (MATLAB 5 to 7.2, and later by -v7 or -v6), or one of 7.3, which is not read.
[[nodiscard]] bool is_mat(std::string_view bytes) noexcept;

/// The numeric vectors of the length that holds most numbers, each a column; the columns of a matrix with as
/// many rows as NAME[1], NAME[2], ...; fields of a struct as NAME.FIELD. Numbers lose nothing. What has
/// another length, or is no number, is named in the notes.
/// @throws std::invalid_argument for a file that is damaged, of version 7.3, or has no two such columns;
///         tables, timetables and other objects are named with how to save what they hold.
[[nodiscard]] MatTable mat_table(std::string_view bytes, const UnpackedLimits& limits);

}  // namespace kerf::bench

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

/// A MAT-file of 7.3 under a name of its own, in memory: HDF5 asks for one that is no link. Of any other
/// bytes it has none.
class MatName {
 public:
  /// @throws std::system_error if there is no room for it.
  explicit MatName(std::string_view bytes);
  MatName(const MatName&) = delete;
  MatName& operator=(const MatName&) = delete;
  ~MatName();

  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  std::string name_;
};

/// A MAT-file of level 5 (MATLAB 5 to 7.2, and later by -v7 or -v6), or one of 7.3, which is HDF5.
[[nodiscard]] bool is_mat(std::string_view bytes) noexcept;

/// The numeric vectors of the length that holds most numbers, each a column; the columns of a matrix with as
/// many rows as NAME[1], NAME[2], ...; fields of a struct as NAME.FIELD. A struct `units` of texts has the
/// unit of each column by its name. Numbers lose nothing. What has another length, is no number, or a whole
/// one beyond 2^53, which no double holds, is named in the notes.
/// matio reads files only: `path` has the same bytes. matio believes what a file says of itself: call it in a
/// process of its own (unpacked_apart.h).
/// @throws std::invalid_argument for a file that is damaged or has no two such columns;
///         tables, timetables and other objects are named with how to save what they hold.
[[nodiscard]] MatTable mat_table(std::string_view bytes, const std::string& path,
                                 const UnpackedLimits& limits);

}  // namespace kerf::bench

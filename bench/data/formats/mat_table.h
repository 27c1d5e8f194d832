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

/// A file with these bytes that has a path: matio reads files only, and what comes may be a pipe or packed.
/// It lies in memory. HDF5 asks for a name that is no link, so a file of 7.3 has one until it is opened, and
/// whoever made the copy removes it if the reader fell.
class MatCopy {
 public:
  /// @throws std::system_error if there is no room for it.
  explicit MatCopy(std::string_view bytes);
  MatCopy(const MatCopy&) = delete;
  MatCopy& operator=(const MatCopy&) = delete;
  ~MatCopy();

  [[nodiscard]] std::string path() const;
  void remove_name() const noexcept;

 private:
  int file_ = -1;
  std::string name_;  ///< empty of a file without one
};

/// A MAT-file of level 5 (MATLAB 5 to 7.2, and later by -v7 or -v6), or one of 7.3, which is HDF5.
[[nodiscard]] bool is_mat(std::string_view bytes) noexcept;

/// The numeric vectors of the length that holds most numbers, each a column; the columns of a matrix with as
/// many rows as NAME[1], NAME[2], ...; fields of a struct as NAME.FIELD. A struct `units` of texts has the
/// unit of each column by its name. Numbers lose nothing. What has another length, is no number, or a whole
/// one beyond 2^53, which no double holds, is named in the notes.
/// @throws std::invalid_argument for a file that is damaged or has no two such columns;
///         tables, timetables and other objects are named with how to save what they hold.
[[nodiscard]] MatTable mat_table(std::string_view bytes, const MatCopy& copy, const UnpackedLimits& limits);

}  // namespace kerf::bench

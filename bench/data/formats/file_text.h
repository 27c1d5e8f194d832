#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clocks/time_stamp.h"
#include "files/mapped_file.h"

namespace kerf::bench {

struct FileTextOptions {
  std::size_t max_bytes = 0;  ///< of the file, and of what it holds
  std::string sheet;  ///< of a workbook: its name, or its number from 1; empty: the first with numbers
};

/// A file of numbers as text in which each line is a row, whatever it was: text as it stands; what gzip
/// packed; UTF-16 as UTF-8; a LabVIEW file (lvm) without
/// its headers; a TDMS file; a sheet of a workbook (xlsx, xls), or the variables of a MAT-file, as columns
/// with tabs between them and a row of names. Numbers of the two latter lose nothing. What a file is is told
/// by its first bytes, not by its name, and of gzip by what is in it.
class FileText {
 public:
  /// @throws std::invalid_argument that names file and place for what is damaged, larger than allowed, or of
  ///         a kind that cannot be read, and as MappedFile does.
  FileText(const std::filesystem::path& file, const FileTextOptions& options);

  [[nodiscard]] std::string_view text() const noexcept { return is_made_ ? made_ : mapped_.text(); }
  /// As MappedFile has it.
  void require_whole() const { mapped_.require_whole(); }
  /// The file itself, as it is hashed.
  [[nodiscard]] std::string_view bytes() const noexcept { return mapped_.text(); }
  /// What stands for the text in messages: "drawer.xlsx, sheet 'Run 2'". A line of it is a row of the sheet.
  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// What is to be known of how it was read, a sentence each.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }
  /// The moment from which its times count, where the format says it beside them.
  [[nodiscard]] const std::optional<TimeStamp>& begin() const noexcept { return begin_; }
  /// What the column of those times is called.
  [[nodiscard]] const std::string& time_column() const noexcept { return time_column_; }

 private:
  MappedFile mapped_;
  std::string name_;
  std::string made_;
  bool is_made_ = false;
  std::vector<std::string> notes_;
  std::optional<TimeStamp> begin_;
  std::string time_column_;
};

}  // namespace kerf::bench

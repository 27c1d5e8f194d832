#include "formats/file_text.h"

#include <stdexcept>

#include <fmt/format.h>

#include "formats/gzip.h"
#include "formats/lvm.h"
#include "formats/mat_table.h"
#include "formats/tdms/tdms.h"
#include "formats/tdms/tdms_segments.h"
#include "formats/unpacked_apart.h"
#include "formats/utf16.h"
#include "formats/workbook.h"
#include "formats/xls.h"

namespace kerf::bench {
namespace {

/// Formats that are known and not read, each with what to do.
void refuse_what_cannot_be_read(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\x89PNG") || bytes.starts_with("\xFF\xD8\xFF") || bytes.starts_with("GIF8"))
    throw std::invalid_argument(fmt::format("{}: a picture, not a file of numbers", name));
  if (bytes.starts_with("TDSh"))
    throw std::invalid_argument(
        fmt::format("{}: the index of a TDMS file; expected the file beside it that ends in .tdms", name));
  if (bytes.starts_with("\x89HDF"))
    throw std::invalid_argument(
        fmt::format("{}: a binary file, HDF5; a recording of Kerf's need not be imported, of others export "
                    "the columns as CSV",
                    name));
}

}  // namespace

FileText::FileText(const std::filesystem::path& file, const FileTextOptions& options)
    : mapped_(file, options.max_bytes), name_(file.string()) {
  const auto take = [&](std::string made) {
    made_ = std::move(made);
    is_made_ = true;
  };
  if (is_gzip(text())) {
    take(gunzip(text(), {.name = name_, .at_most = options.max_bytes}));
    notes_.push_back("unpacked by gzip");
  }
  if (!options.sheet.empty() && !is_zip(text()) && !is_xls(text()))
    throw std::invalid_argument(
        fmt::format("{}: --sheet is for a workbook (xlsx, xls), which it is not", name_));
  if (is_zip(text()) || is_xls(text()) || is_mat(text())) {
    const bool has_sheets = !is_mat(text());
    Unpacked made = unpacked_apart(text(), options.sheet, {.name = name_, .at_most = options.max_bytes});
    notes_.insert(notes_.end(), made.notes.begin(), made.notes.end());
    if (has_sheets) name_ += fmt::format(", sheet '{}'", made.sheet);
    take(std::move(made.text));
  } else if (is_tdms(text())) {
    TdmsText made = tdms_text(text(), name_);
    begin_ = made.begin;
    time_column_ = tdms_time_column;
    notes_.insert(notes_.end(), made.notes.begin(), made.notes.end());
    take(std::move(made.text));
  } else if (const auto order = utf16_order(text())) {
    take(utf8_of_utf16(text(), *order, name_));
    notes_.push_back("UTF-16 text");
  } else if (is_lvm(text())) {
    LvmText made = lvm_text(text(), name_);
    begin_ = made.begin;
    time_column_ = "X_Value";
    notes_.insert(notes_.end(), made.notes.begin(), made.notes.end());
    take(std::move(made.text));
  } else {
    refuse_what_cannot_be_read(text(), name_);
  }
  mapped_.require_whole();
}

}  // namespace kerf::bench

#include "formats/file_text.h"

#include <stdexcept>

#include <fmt/core.h>

#include "formats/gzip.h"
#include "formats/mat_table.h"
#include "formats/utf16.h"
#include "formats/workbook.h"

namespace kerf::bench {
namespace {

/// Formats that are known and not read, each with what to do.
void refuse_what_cannot_be_read(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("\xD0\xCF\x11\xE0"))
    throw std::invalid_argument(
        fmt::format("{}: an Excel workbook of before 2007 (xls); save it as xlsx or as CSV", name));
  if (bytes.starts_with("\x89PNG") || bytes.starts_with("\xFF\xD8\xFF") || bytes.starts_with("GIF8"))
    throw std::invalid_argument(fmt::format("{}: a picture, not a file of numbers", name));
  if (bytes.starts_with("TDSm"))
    throw std::invalid_argument(
        fmt::format("{}: a TDMS file; export it from LabVIEW as text (lvm) or CSV", name));
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
  if (!options.sheet.empty() && !is_zip(text()))
    throw std::invalid_argument(fmt::format("{}: --sheet is for a workbook (xlsx), which it is not", name_));
  if (is_zip(text())) {
    Workbook book(text(), {.name = name_, .at_most = options.max_bytes});
    Sheet sheet = book.sheet(options.sheet);
    notes_.insert(notes_.end(), sheet.notes.begin(), sheet.notes.end());
    name_ += fmt::format(", sheet '{}'", sheet.name);
    take(std::move(sheet.text));
  } else if (is_mat(text())) {
    MatTable table = mat_table(text(), {.name = name_, .at_most = options.max_bytes});
    notes_.insert(notes_.end(), table.notes.begin(), table.notes.end());
    take(std::move(table.text));
  } else if (const auto order = utf16_order(text())) {
    take(utf8_of_utf16(text(), *order, name_));
    notes_.push_back("UTF-16 text");
  } else {
    refuse_what_cannot_be_read(text(), name_);
  }
}

}  // namespace kerf::bench

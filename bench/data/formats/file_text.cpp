#include "formats/file_text.h"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include "formats/gzip.h"
#include "formats/lvm.h"
#include "formats/mat_table.h"
#include "formats/run_apart.h"
#include "formats/tdms/tdms.h"
#include "formats/tdms/tdms_segments.h"
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

/// What a file was made to, as it comes back from a process of its own.
struct Made {
  std::string sheet{};
  std::vector<std::string> notes{};
  std::string text{};
};

constexpr char end_of_part = '\x1E';

/// Libraries take memory as a damaged file asks for it, and believe what it says of itself.
Made made_apart(const UnpackedLimits& limits, const std::function<Made()>& make) {
  const std::string told = run_apart(limits, [&] {
    const Made made = make();
    return fmt::format("{}{}{}{}{}", made.sheet, end_of_part, fmt::join(made.notes, "\n"), end_of_part,
                       made.text);
  });
  const std::size_t first = told.find(end_of_part);
  const std::size_t second = told.find(end_of_part, first + 1);
  Made made{.sheet = told.substr(0, first), .notes = {}, .text = told.substr(second + 1)};
  std::string_view notes = std::string_view(told).substr(first + 1, second - first - 1);
  while (!notes.empty()) {
    const std::string_view line = notes.substr(0, notes.find('\n'));
    made.notes.emplace_back(line);
    notes.remove_prefix(std::min(notes.size(), line.size() + 1));
  }
  return made;
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
  if (is_zip(text()) || is_xls(text())) {
    const UnpackedLimits limits{.name = name_, .at_most = options.max_bytes};
    Made made = made_apart(limits, [&]() -> Made {
      Sheet sheet = is_xls(text()) ? xls_sheet(text(), options.sheet, limits)
                                   : Workbook(text(), limits).sheet(options.sheet);
      return {.sheet = std::move(sheet.name), .notes = std::move(sheet.notes), .text = std::move(sheet.text)};
    });
    notes_.insert(notes_.end(), made.notes.begin(), made.notes.end());
    name_ += fmt::format(", sheet '{}'", made.sheet);
    take(std::move(made.text));
  } else if (is_mat(text())) {
    const UnpackedLimits limits{.name = name_, .at_most = options.max_bytes};
    const MatCopy copy(text());
    Made made = made_apart(limits, [&]() -> Made {
      MatTable table = mat_table(text(), copy, limits);
      return {.notes = std::move(table.notes), .text = std::move(table.text)};
    });
    notes_.insert(notes_.end(), made.notes.begin(), made.notes.end());
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
}

}  // namespace kerf::bench

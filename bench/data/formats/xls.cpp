#include "formats/xls.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <freexl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "formats/biff_records.h"

namespace kerf::bench {
namespace {

/// freexl reads files by their path: these bytes as one, in memory.
class XlsCopy {
 public:
  explicit XlsCopy(std::string_view bytes) : file_(memfd_create("kerf-xls", MFD_CLOEXEC)) {
    while (file_ >= 0 && !bytes.empty()) {
      const ssize_t written = ::write(file_, bytes.data(), bytes.size());
      if (written <= 0) break;
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    if (file_ < 0 || !bytes.empty())
      throw std::system_error(errno, std::generic_category(), "no file in memory");
  }
  XlsCopy(const XlsCopy&) = delete;
  XlsCopy& operator=(const XlsCopy&) = delete;
  ~XlsCopy() { ::close(file_); }

  [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", file_); }

 private:
  int file_;
};

struct CloseBook {
  void operator()(const void* book) const { freexl_close(book); }
};

class XlsBook {
 public:
  XlsBook(std::string_view bytes, const UnpackedLimits& limits)
      : copy_(bytes), limits_(limits), records_(biff_sheets(bytes)) {
    const void* book = nullptr;
    const int opened = freexl_open(copy_.path().c_str(), &book);
    book_.reset(book);
    if (opened == FREEXL_BIFF_WORKBOOK_NOT_FOUND) refuse("an old Office file, but no workbook (xls)");
    // An encrypted file is opened without its cells, or not at all.
    if (opened != FREEXL_OK)
      refuse(fmt::format("a workbook (xls) that cannot be read (freexl says {}): is it whole?", opened));
    if (info(FREEXL_BIFF_PASSWORD) == FREEXL_BIFF_OBFUSCATED)
      refuse("a workbook that is protected by a password; save it without one");
    epoch_1904_ = info(FREEXL_BIFF_DATEMODE) == FREEXL_BIFF_DATEMODE_1904;
    records_.resize(info(FREEXL_BIFF_SHEET_COUNT));
    for (std::size_t i = 0; i < records_.size(); ++i) {
      const char* name = nullptr;
      const int told = freexl_get_worksheet_name(book_.get(), static_cast<unsigned short>(i), &name);
      sheets_.push_back(
          {.name = told == FREEXL_OK && name != nullptr ? name : "", .hidden = records_[i].hidden});
    }
    if (sheets_.empty()) refuse("a workbook without a sheet");
  }

  Sheet sheet(const std::string& asked) {
    return taken_sheet(sheets_, asked, limits_.name,
                       [&](std::size_t place, CellCounts& counts) { return read(place, counts); });
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw std::invalid_argument(fmt::format("{}: {}", limits_.name, why));
  }

  [[nodiscard]] unsigned int info(unsigned short what) const {
    unsigned int value = 0;
    return freexl_get_info(book_.get(), what, &value) == FREEXL_OK ? value : 0;
  }

  Sheet read(std::size_t place, CellCounts& counts) {
    const std::string& name = sheets_[place].name;
    unsigned int rows = 0;
    unsigned short columns = 0;
    if (freexl_select_active_worksheet(book_.get(), static_cast<unsigned short>(place)) != FREEXL_OK ||
        freexl_worksheet_dimensions(book_.get(), &rows, &columns) != FREEXL_OK)
      refuse(fmt::format("sheet '{}' cannot be read: is the file whole?", name));
    std::vector<SheetRow> taken;
    std::size_t width = 0;
    for (unsigned int row = 0; row < rows; ++row) {
      SheetRow& cells = taken.emplace_back(SheetRow{.number = row + 1, .cells = {}});
      for (unsigned short column = 0; column < columns; ++column) {
        std::string value = value_of(records_[place], row, column, counts);
        if (value.empty()) continue;
        cells.cells[column] = std::move(value);
        width = std::max<std::size_t>(width, column + 1U);
      }
    }
    while (!taken.empty() && taken.back().cells.empty()) taken.pop_back();
    return {.name = name,
            .text = rows_as_text(taken, width, limits_),
            .notes = cell_notes(name, counts, epoch_1904_, records_[place].merged)};
  }

  /// A cell as the text has it.
  std::string value_of(const BiffSheet& records, unsigned int row, unsigned short column,
                       CellCounts& counts) const {
    FreeXL_CellValue value{};
    if (freexl_get_cell_value(book_.get(), row, column, &value) != FREEXL_OK) return "";
    const auto found = records.cells.find({static_cast<std::uint16_t>(row), column});
    if (found != records.cells.end()) {
      const BiffCell& cell = found->second;
      counts.numbers += cell.kind == BiffCell::Kind::number || cell.kind == BiffCell::Kind::date ? 1 : 0;
      if (cell.kind == BiffCell::Kind::date) return date_cell(cell.value, counts);
      if (cell.kind == BiffCell::Kind::truth) return cell.value != 0.0 ? "1" : "0";
      if (cell.kind == BiffCell::Kind::error) return "#N/A";
      if (cell.kind == BiffCell::Kind::number) return fmt::format("{}", cell.value);
      ++counts.wordy;
      return "";
    }
    if (value.type == FREEXL_CELL_TEXT || value.type == FREEXL_CELL_SST_TEXT)
      return value.value.text_value == nullptr ? "" : text_cell(value.value.text_value, row + 1, counts);
    // Numbers in records that are not looked at; dates and times are text, to the second, and never guessed.
    if (value.type == FREEXL_CELL_INT) return number_text(value.value.int_value, counts);
    if (value.type == FREEXL_CELL_DOUBLE) return number_text(value.value.double_value, counts);
    return "";
  }

  static std::string number_text(double value, CellCounts& counts) {
    ++counts.numbers;
    return fmt::format("{}", value);
  }

  XlsCopy copy_;
  const UnpackedLimits& limits_;
  std::vector<BiffSheet> records_;
  std::unique_ptr<const void, CloseBook> book_;
  bool epoch_1904_ = false;
  std::vector<SheetName> sheets_;
};

}  // namespace

bool is_xls(std::string_view bytes) noexcept { return bytes.starts_with("\xD0\xCF\x11\xE0"); }

Sheet xls_sheet(std::string_view bytes, const std::string& asked, const UnpackedLimits& limits) {
  return XlsBook(bytes, limits).sheet(asked);
}

}  // namespace kerf::bench

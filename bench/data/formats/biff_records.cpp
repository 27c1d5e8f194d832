#include "formats/biff_records.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "formats/cell_format.h"

namespace kerf::bench {
namespace {

/// A number of a file that is little-endian; 0 where the file has ended.
template <typename T>
T number_at(std::string_view bytes, std::size_t at) {
  T value{};
  if (at <= bytes.size() && bytes.size() - at >= sizeof value)
    std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::uint16_t word_at(std::string_view bytes, std::size_t at) { return number_at<std::uint16_t>(bytes, at); }
std::uint32_t long_at(std::string_view bytes, std::size_t at) { return number_at<std::uint32_t>(bytes, at); }

/// The container: files in sectors, chained by a table.
class Container {
 public:
  explicit Container(std::string_view file)
      : file_(file), sector_(std::size_t{1} << (word_at(file, 30) & 15U)) {
    constexpr std::size_t first_tables = 109;
    std::vector<std::uint32_t> tables;
    for (std::size_t i = 0; i < first_tables; ++i) tables.push_back(long_at(file, 76 + 4 * i));
    const std::size_t most = file.size() / sector_ + 1;
    std::uint32_t more = long_at(file, 68);
    for (std::size_t i = 0; i < most && is_sector(more) && sector_ >= 8; ++i) {
      const std::string_view list = sector(more);
      for (std::size_t at = 0; at + 8 <= sector_; at += 4) tables.push_back(long_at(list, at));
      more = long_at(list, sector_ - 4);
    }
    for (const std::uint32_t table : tables) {
      if (!is_sector(table) || next_.size() > most) continue;
      const std::string_view list = sector(table);
      for (std::size_t at = 0; at < sector_; at += 4) next_.push_back(long_at(list, at));
    }
  }

  /// The file with a workbook's records; empty if there is none.
  [[nodiscard]] std::string workbook() const {
    const std::string directory = chained(long_at(file_, 48));
    std::string root;
    for (std::size_t at = 0; at + entry_size <= directory.size(); at += entry_size) {
      const std::string_view entry = std::string_view(directory).substr(at, entry_size);
      const std::uint32_t begin = long_at(entry, 116);
      const std::uint32_t size = long_at(entry, 120);
      if (entry[66] == 5) root = chained(begin);
      if (!is_book(entry)) continue;
      std::string book = size < long_at(file_, 56) ? small(root, begin) : chained(begin);
      book.resize(std::min<std::size_t>(book.size(), size));
      return book;
    }
    return {};
  }

 private:
  static constexpr std::size_t entry_size = 128;

  static bool is_book(std::string_view entry) {
    std::string name;
    for (std::size_t at = 0; at < 64 && entry[at] != '\0'; at += 2) name += entry[at];
    return entry[66] == 2 && (name == "Workbook" || name == "Book");
  }

  [[nodiscard]] bool is_sector(std::uint32_t number) const { return number < file_.size() / sector_; }
  [[nodiscard]] std::string_view sector(std::uint32_t number) const {
    const std::size_t at = (std::size_t{number} + 1) * sector_;
    return at < file_.size() ? file_.substr(at, sector_) : std::string_view{};
  }

  [[nodiscard]] std::string chained(std::uint32_t number) const {
    std::string all;
    for (std::size_t i = 0; i <= next_.size() && number < next_.size() && is_sector(number); ++i) {
      all += sector(number);
      number = next_[number];
    }
    return all;
  }

  /// A file below the cut-off lies in pieces of a file of its own.
  [[nodiscard]] std::string small(std::string_view root, std::uint32_t number) const {
    const std::size_t size = std::size_t{1} << (word_at(file_, 32) & 15U);
    const std::string chain = chained(long_at(file_, 60));
    std::string all;
    for (std::size_t i = 0; i <= chain.size() / 4 && number < chain.size() / 4; ++i) {
      if (std::size_t{number} * size >= root.size()) break;
      all += root.substr(std::size_t{number} * size, size);
      number = long_at(chain, std::size_t{4} * number);
    }
    return all;
  }

  std::string_view file_;
  std::size_t sector_;
  std::vector<std::uint32_t> next_;
};

/// Kinds of records, [MS-XLS] 2.3.
enum class RecordKind : std::uint16_t {
  formula = 0x0006,
  end_of_part = 0x000A,
  sheet_place = 0x0085,
  compact_numbers = 0x00BD,
  cell_style = 0x00E0,
  merged_cells = 0x00E5,
  full_number = 0x0203,
  truth_or_error = 0x0205,
  compact_one = 0x027E,
  number_format = 0x041E,
  begin_of_part = 0x0809
};

struct BiffRecord {
  RecordKind kind = RecordKind::end_of_part;
  std::string_view data;
};

/// Takes the first record off; none where there is no whole one left.
std::optional<BiffRecord> take_record(std::string_view& book) {
  if (book.size() < 4) return std::nullopt;
  const std::size_t size = word_at(book, 2);
  if (book.size() - 4 < size) return std::nullopt;
  const BiffRecord record{.kind = static_cast<RecordKind>(word_at(book, 0)), .data = book.substr(4, size)};
  book.remove_prefix(4 + size);
  return record;
}

/// A number in 30 bits: the upper ones of a double or a whole one, divided by 100 or not.
double compact_number(std::uint32_t packed) {
  const double value = (packed & 2U) != 0 ? static_cast<double>(std::bit_cast<std::int32_t>(packed) >> 2)
                                          : std::bit_cast<double>(std::uint64_t{packed & ~3U} << 32U);
  return (packed & 1U) != 0 ? value / 100.0 : value;
}

std::string column_letters(std::uint16_t column) {
  std::string letters;
  for (unsigned rest = column + 1U; rest > 0; rest = (rest - 1) / 26)
    letters.insert(letters.begin(), static_cast<char>('A' + (rest - 1) % 26));
  return letters;
}

/// The records that all sheets share: their places, and which formats of cells show a date.
class BiffBook {
 public:
  explicit BiffBook(std::string_view book) : book_(book) {
    std::set<std::uint16_t> dates;
    std::string_view rest = book;
    while (const auto record = take_record(rest)) {
      const std::string_view data = record->data;
      if (record->kind == RecordKind::end_of_part) break;
      if (record->kind == RecordKind::begin_of_part) is_new_ = word_at(data, 0) >= 0x0600;
      if (record->kind == RecordKind::number_format && is_date_format(164, format_code(data)))
        dates.insert(word_at(data, 0));
      if (record->kind == RecordKind::cell_style) {
        const std::uint16_t format = word_at(data, 2);
        is_date_.push_back(dates.contains(format) || is_date_format(format, ""));
      }
      if (record->kind == RecordKind::sheet_place && data.size() > 6)
        places_.emplace_back(long_at(data, 0), data[4] != 0);
    }
  }

  [[nodiscard]] std::vector<BiffSheet> sheets() const {
    std::vector<BiffSheet> sheets;
    for (const auto& [place, hidden] : places_) {
      sheets.push_back({.hidden = hidden, .cells = {}, .merged = {}});
      if (place < book_.size()) read(book_.substr(place), sheets.back());
    }
    return sheets;
  }

 private:
  [[nodiscard]] std::string format_code(std::string_view data) const {
    if (!is_new_) return std::string(data.substr(std::min<std::size_t>(data.size(), 3)));
    if (data.size() < 5) return {};
    const std::size_t step = (data[4] & 1) != 0 ? 2 : 1;  // two bytes a letter, or one
    std::string code;
    for (std::size_t at = 5; at < data.size(); at += step) code += data[at];
    return code;
  }

  [[nodiscard]] BiffCell number_of(std::uint16_t format, double value) const {
    const bool date = format < is_date_.size() && is_date_[format];
    return {.kind = date ? BiffCell::Kind::date : BiffCell::Kind::number, .value = value};
  }

  /// The value of a formula: a double, or what is none.
  [[nodiscard]] BiffCell formula_of(std::string_view data) const {
    if (word_at(data, 12) != 0xFFFF) return number_of(word_at(data, 4), number_at<double>(data, 6));
    const char what = data.size() > 8 ? data[6] : '\0';
    if (what == 1) return {.kind = BiffCell::Kind::truth, .value = static_cast<double>(data[8])};
    return {.kind = BiffCell::Kind::no_number, .value = 0.0};
  }

  void read(std::string_view rest, BiffSheet& sheet) const {
    std::size_t depth = 0;  // charts within a sheet have records of their own
    while (const auto record = take_record(rest)) {
      if (record->kind == RecordKind::begin_of_part) ++depth;
      if (record->kind == RecordKind::end_of_part && (depth == 0 || --depth == 0)) return;
      if (depth == 1) take(*record, sheet);
    }
  }

  void take(const BiffRecord& record, BiffSheet& sheet) const {
    const std::string_view data = record.data;
    const std::uint16_t row = word_at(data, 0);
    const std::uint16_t column = word_at(data, 2);
    const auto put = [&](std::size_t at, BiffCell cell) {
      sheet.cells[{row, static_cast<std::uint16_t>(at)}] = cell;
    };
    switch (record.kind) {
      case RecordKind::full_number:
        put(column, number_of(word_at(data, 4), number_at<double>(data, 6)));
        break;
      case RecordKind::compact_one:
        put(column, number_of(word_at(data, 4), compact_number(long_at(data, 6))));
        break;
      case RecordKind::compact_numbers:
        for (std::size_t at = 4, i = 0; at + 8 <= data.size(); at += 6, ++i)
          put(column + i, number_of(word_at(data, at), compact_number(long_at(data, at + 2))));
        break;
      case RecordKind::formula:
        put(column, formula_of(data));
        break;
      case RecordKind::truth_or_error:
        if (data.size() >= 8)
          put(column, {.kind = data[7] == 0 ? BiffCell::Kind::truth : BiffCell::Kind::error,
                       .value = static_cast<double>(static_cast<unsigned char>(data[6]))});
        break;
      case RecordKind::merged_cells:
        take_merged(data, sheet.merged);
        break;
      default:
        break;
    }
  }

  static void take_merged(std::string_view data, std::string& merged) {
    constexpr std::size_t enough = 60;  // bytes of a message
    for (std::size_t at = 2; at + 8 <= data.size() && merged.size() < enough; at += 8)
      merged += fmt::format("{}{}{}:{}{}", merged.empty() ? "" : ", ", column_letters(word_at(data, at + 4)),
                            word_at(data, at) + 1, column_letters(word_at(data, at + 6)),
                            word_at(data, at + 2) + 1);
  }

  std::string_view book_;
  bool is_new_ = true;
  std::vector<bool> is_date_;  ///< by the format of a cell
  std::vector<std::pair<std::uint32_t, bool>> places_;
};

}  // namespace

std::vector<BiffSheet> biff_sheets(std::string_view file) {
  const std::string book = Container(file).workbook();
  return BiffBook(book).sheets();
}

}  // namespace kerf::bench

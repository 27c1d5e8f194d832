#include "import/text/text_table.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <thread>

#include "import/decimal.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

constexpr std::size_t smallest_part = std::size_t{1} << 18U;  ///< bytes that are worth a thread of their own
constexpr int not_wanted = -1;

/// Reads the wanted fields of one line.
class LineReader {
 public:
  LineReader(const TextLayout& layout, std::span<const std::size_t> columns) : layout_(&layout) {
    slots_.assign(*std::max_element(columns.begin(), columns.end()) + 1, not_wanted);
    for (std::size_t slot = columns.size(); slot-- > 0;) slots_[columns[slot]] = static_cast<int>(slot);
  }

  /// Puts the number of each wanted column into values[slot][row]; false if one is missing or none.
  bool read(const char* at, const char* end, std::span<double* const> values,
            std::size_t row) const noexcept {
    const char separator = layout_->separator;
    for (std::size_t field = 0; field < slots_.size(); ++field) {
      at = skip_blanks(at, end);
      const bool quoted = at != end && *at == '"';
      if (quoted) ++at;
      if (const int slot = slots_[field]; slot != not_wanted) {
        double value = 0.0;
        const auto& stamps = layout_->columns[field].stamps;
        const std::int64_t origin = layout_->columns[field].origin;
        const char* const stop = stamps        ? read_stamp(at, end, quoted ? '"' : separator, *stamps, value)
                                 : origin != 0 ? read_difference(at, end, origin, value)
                                               : parse_decimal(at, end, layout_->point, value);
        if (stop == at) return false;
        values[static_cast<std::size_t>(slot)][row] = value;
        at = stop;
      } else {
        at = skip_field(at, end, quoted ? '"' : separator);
      }
      if (quoted) {
        if (at == end || *at != '"') return false;
        ++at;
      }
      const char* const after = skip_blanks(at, end);
      const bool last = field + 1 == slots_.size();
      if (after == end) return last;
      if (separator == ' ') {
        if (after == at) return false;
        at = after;
      } else {
        if (*after != separator) return false;
        at = after + 1;
      }
    }
    return true;
  }

 private:
  [[nodiscard]] const char* skip_blanks(const char* at, const char* end) const noexcept {
    while (at != end && (*at == ' ' || *at == '\r' || (*at == '\t' && layout_->separator != '\t'))) ++at;
    return at;
  }
  static const char* read_stamp(const char* at, const char* end, char separator, const TimeStamp& first,
                                double& value) noexcept {
    TimeStamp stamp;
    const char* const stop = parse_time_stamp(at, end, separator, stamp);
    if (stop == at || stamp.has_zone != first.has_zone) return at;
    value = static_cast<double>(stamp.ns - first.ns);
    return stop;
  }
  /// Whole part and fraction each by itself: 64 bits hold the one, and a double the other.
  const char* read_difference(const char* at, const char* end, std::int64_t origin,
                              double& value) const noexcept {
    const char* const stop = parse_decimal(at, end, layout_->point, value);
    std::int64_t whole = 0;
    const auto read = std::from_chars(at, stop, whole);
    double fraction = 0.0;
    const bool is_split = read.ec == std::errc{} && whole >= 0 &&
                          (read.ptr == stop || *read.ptr == layout_->point) &&
                          std::find_if(read.ptr, stop, [](char c) { return c == 'e' || c == 'E'; }) == stop;
    if (!is_split) {
      value -= static_cast<double>(origin);
      return stop;
    }
    if (stop - read.ptr > 1) parse_decimal(read.ptr, stop, layout_->point, fraction);
    value = static_cast<double>(whole - origin) + fraction;
    return stop;
  }
  static const char* skip_field(const char* at, const char* end, char stop) noexcept {
    if (stop == ' ') {
      while (at != end && *at != ' ' && *at != '\t' && *at != '\r') ++at;
      return at;
    }
    const void* found = std::memchr(at, stop, static_cast<std::size_t>(end - at));
    return found != nullptr ? static_cast<const char*>(found) : end;
  }

  const TextLayout* layout_;
  std::vector<int> slots_;
};

/// A stretch of whole lines that one thread reads, and what it found, with lines counted from its begin.
struct Part {
  std::string_view text;
  std::size_t first_row = 0;  ///< where its rows go
  std::size_t rows = 0;
  std::size_t lines = 0;
  std::vector<std::size_t> bad;
  std::vector<std::size_t> empty;
};

std::size_t count_lines(std::string_view text) {
  constexpr std::size_t block = 255;  // a count that fits a byte is one that vectors add up fast
  std::size_t ends = 0;
  for (std::size_t begin = 0; begin < text.size(); begin += block) {
    std::uint8_t in_block = 0;
    for (const char c : text.substr(begin, block))
      in_block = static_cast<std::uint8_t>(in_block + (c == '\n' ? 1 : 0));
    ends += in_block;
  }
  return ends + (text.empty() || text.back() == '\n' ? 0 : 1);
}

std::vector<Part> split_into_parts(std::string_view text) {
  const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t size = std::max(smallest_part, text.size() / threads + 1);
  std::vector<Part> parts;
  while (!text.empty()) {
    auto end = text.size() <= size ? std::string_view::npos : text.find('\n', size);
    end = end == std::string_view::npos ? text.size() : end + 1;
    parts.push_back({.text = text.substr(0, end)});
    text.remove_prefix(end);
  }
  return parts;
}

void read_part(Part& part, const LineReader& reader, std::span<double* const> columns,
               std::atomic<std::size_t>& bytes_done) {
  constexpr std::size_t lines_per_report = 8192;
  std::string_view rest = part.text;
  std::size_t reported = rest.size();
  while (!rest.empty()) {
    const auto line = take_line(rest);
    ++part.lines;
    if (reader.read(line.data(), line.data() + line.size(), columns, part.first_row + part.rows)) {
      ++part.rows;
    } else {
      const bool empty = line.find_first_not_of(" \t\r") == std::string_view::npos;
      (empty ? part.empty : part.bad).push_back(part.lines);
    }
    if (part.lines % lines_per_report == 0 || rest.empty()) {
      bytes_done += reported - rest.size();
      reported = rest.size();
    }
  }
}

/// Runs `work` on every part, one thread each.
template <typename Work>
void on_all_cores(std::vector<Part>& parts, const Work& work) {
  for_each_index(parts.size(), parts.size(), [&](std::size_t i) { work(parts[i]); });
}

}  // namespace

std::size_t TextTable::line_of(std::size_t row) const {
  if (!row_lines.empty()) return row_lines.at(row);
  // Each line without data before the row moves it one line down.
  std::size_t line = first_line + row;
  auto bad = bad_lines.begin();
  auto empty = empty_lines.begin();
  while (true) {
    const bool bad_next =
        bad != bad_lines.end() && *bad <= line && (empty == empty_lines.end() || *bad < *empty);
    if (bad_next) {
      ++bad;
    } else if (empty != empty_lines.end() && *empty <= line) {
      ++empty;
    } else {
      return line;
    }
    ++line;
  }
}

TextTable parse_table(std::string_view text, const TextLayout& layout, std::span<const std::size_t> columns,
                      std::atomic<std::size_t>& bytes_done) {
  const LineReader reader(layout, columns);
  std::vector<Part> parts = split_into_parts(text.substr(layout.data_begin));
  on_all_cores(parts, [](Part& part) { part.lines = count_lines(part.text); });
  std::size_t max_rows = 0;
  for (Part& part : parts) {
    part.first_row = max_rows;
    max_rows += part.lines;
    part.lines = 0;
  }

  TextTable table{.columns = {},
                  .bad_lines = {},
                  .empty_lines = {},
                  .first_line = layout.preamble_lines + 1,
                  .row_lines = {}};
  std::vector<double*> begins;
  for (std::size_t i = 0; i < columns.size(); ++i)
    begins.push_back(table.columns.emplace_back(max_rows).data());
  on_all_cores(parts, [&](Part& part) { read_part(part, reader, begins, bytes_done); });

  std::size_t rows = 0;
  std::size_t line = layout.preamble_lines;
  for (const Part& part : parts) {
    for (double* column : begins) {
      if (rows != part.first_row) std::copy_n(column + part.first_row, part.rows, column + rows);
    }
    for (const std::size_t bad : part.bad) table.bad_lines.push_back(line + bad);
    for (const std::size_t empty : part.empty) table.empty_lines.push_back(line + empty);
    rows += part.rows;
    line += part.lines;
  }
  for (auto& column : table.columns) column.resize(rows);
  for (std::size_t i = 0; i < columns.size(); ++i) {  // a column that was asked for twice is read once
    const auto first =
        static_cast<std::size_t>(std::find(columns.begin(), columns.end(), columns[i]) - columns.begin());
    if (first != i) table.columns[i] = table.columns[first];
  }
  return table;
}

}  // namespace kerf::bench

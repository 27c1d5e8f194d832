#include "import/text/text_layout.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <fmt/core.h>
#include <iconv.h>

#include "files/trimmed.h"
#include "import/decimal.h"
#include "import/text/text_header.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_preamble_lines = 1000;
constexpr std::size_t sampled_data_lines = 50;

bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r'; }

bool is_stamp(std::string_view field) noexcept {
  TimeStamp stamp;
  return is_time_stamp(field, stamp);
}

/// One way to read the lines, and how well it reads them.
struct Reading {
  char separator;
  char point;
  std::size_t lines = 0;      ///< lines that are numbers in this reading
  std::size_t strangers = 0;  ///< fields in them that are no numbers
  std::size_t columns = 0;    ///< of the most of them

  [[nodiscard]] bool reads(std::string_view line) const {
    if (trimmed(line).empty()) return false;
    const auto fields = split_line(line, separator);
    const auto numbers =
        std::count_if(fields.begin(), fields.end(), [&](auto f) { return is_decimal(f, point); });
    const auto filled = std::count_if(fields.begin(), fields.end(), [](auto f) { return !f.empty(); });
    // A stamp alone is a remark: when something began.
    const auto values = numbers >= 1 ? numbers + std::count_if(fields.begin(), fields.end(), is_stamp) : 0;
    return values >= 1 && 2 * values > filled && 2 * static_cast<std::size_t>(values) >= columns;
  }
};

/// The reading under which most sampled lines are numbers, then the one with fewest other fields, then the
/// one with most columns.
Reading best_reading(const std::vector<std::string_view>& lines) {
  // In order of preference between equals: a comma separates before it is a decimal comma.
  std::array readings{Reading{'\t', '.'}, Reading{';', '.'}, Reading{',', '.'}, Reading{' ', '.'},
                      Reading{'\t', ','}, Reading{';', ','}, Reading{' ', ','}, Reading{',', ','}};
  Reading best = readings[0];
  for (Reading& reading : readings) {
    std::size_t numbers = 0;
    for (const auto line : lines) {
      if (!reading.reads(line)) continue;
      ++reading.lines;
      for (const auto field : split_line(line, reading.separator)) {
        if (is_decimal(field, reading.point) || is_stamp(field)) {
          ++numbers;
        } else if (!field.empty()) {
          ++reading.strangers;
        }
      }
    }
    reading.columns = reading.lines > 0 ? (numbers + reading.lines / 2) / reading.lines : 0;
    const auto worth = [](const Reading& r) {
      return std::tuple(r.lines, std::numeric_limits<std::size_t>::max() - r.strangers, r.columns);
    };
    if (worth(reading) > worth(best)) best = reading;
  }
  return best;
}

bool is_utf8(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80                   ? 1
                               : lead >= 0xC2 && lead < 0xE0 ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xC0U) != 0x80U) return false;
    }
    i += length;
  }
  return true;
}

/// Chinese text has its high bytes in pairs of 0xA1 and above; a lone one is a Latin letter or sign.
bool looks_like_gb(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (static_cast<unsigned char>(text[i]) < 0x80) continue;
    if (i + 1 == text.size() || static_cast<unsigned char>(text[i]) < 0xA1 ||
        static_cast<unsigned char>(text[i + 1]) < 0xA1) {
      return false;
    }
    ++i;
  }
  return true;
}

/// Which columns hold time stamps, by the first line of the data.
void find_stamps(TextLayout& layout, std::string_view line) {
  const auto fields = split_line(line, layout.separator);
  for (std::size_t i = 0; i < std::min(fields.size(), layout.columns.size()); ++i) {
    TimeStamp stamp;
    if (!is_time_stamp(fields[i], stamp)) continue;
    layout.columns[i].stamps = stamp;
    layout.columns[i].unit = "s";
  }
}

}  // namespace

std::string to_utf8(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  const iconv_t converter = iconv_open("UTF-8", looks_like_gb(text) ? "GB18030" : "ISO-8859-1");
  std::string in(text);
  std::string out(4 * text.size(), '\0');
  char* from = in.data();
  char* to = out.data();
  std::size_t from_left = in.size();
  std::size_t to_left = out.size();
  const auto failed = iconv(converter, &from, &from_left, &to, &to_left) == static_cast<std::size_t>(-1);
  iconv_close(converter);
  out.resize(failed ? 0 : out.size() - to_left);
  if (failed) {
    for (const char c : text) out += static_cast<unsigned char>(c) < 0x80 ? c : '?';
  }
  return out;
}

std::string_view take_line(std::string_view& rest) noexcept {
  const auto end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::vector<std::string_view> split_line(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  std::size_t at = 0;
  const auto skip_blanks = [&] {
    while (at < line.size() && is_blank(line[at]) && (line[at] != separator || separator == ' ')) ++at;
  };
  while (true) {
    skip_blanks();
    if (separator == ' ' && at >= line.size()) break;
    std::size_t end = at;
    if (at < line.size() && line[at] == '"') {
      auto close = line.find('"', at + 1);
      while (close != std::string_view::npos && line.substr(close, 2) == "\"\"")
        close = line.find('"', close + 2);
      end = std::min(close, line.size());
      fields.push_back(line.substr(at + 1, end - at - 1));
      at = std::min(end + 1, line.size());
      skip_blanks();
    } else {
      while (end < line.size() && (separator == ' ' ? !is_blank(line[end]) : line[end] != separator)) ++end;
      fields.push_back(trimmed(line.substr(at, end - at)));
      at = end;
    }
    if (separator == ' ') continue;
    at = std::min(line.find(separator, at), line.size());
    if (at >= line.size()) break;
    ++at;
  }
  return fields;
}

TextLayout find_layout(std::string_view text, const std::string& name) {
  if (text.empty())
    throw std::invalid_argument(fmt::format("{}: the file is empty; expected lines of numbers", name));
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  if (rest.substr(0, std::size_t{1} << 16U).find('\0') != std::string_view::npos) {
    throw std::invalid_argument(fmt::format(
        "{}: a binary file (or UTF-16 text); expected text in UTF-8 or another 8-bit encoding", name));
  }

  if (rest.find('\n') == std::string_view::npos &&
      rest.substr(0, rest.size() - 1).find('\r') != std::string_view::npos) {
    throw std::invalid_argument(fmt::format(
        "{}: lines end in a carriage return alone; expected a line feed: tr '\\r' '\\n' <{} makes them", name,
        name));
  }

  // The reading is chosen on the first lines and on some from the middle, where a long preamble has ended.
  std::vector<std::string_view> lines;
  std::string_view head = rest;
  while (!head.empty() && lines.size() < max_preamble_lines) lines.push_back(take_line(head));
  std::vector<std::string_view> sample = lines;
  std::string_view middle = rest.substr(rest.size() / 2);
  (void)take_line(middle);
  for (std::size_t i = 0; i < sampled_data_lines && !middle.empty(); ++i) sample.push_back(take_line(middle));
  const Reading reading = best_reading(sample);

  TextLayout layout{.separator = reading.separator, .point = reading.point};
  const auto first = std::find_if(lines.begin(), lines.end(), [&](auto line) { return reading.reads(line); });
  if (first == lines.end()) {
    throw std::invalid_argument(fmt::format(
        "{}: no line of numbers in the first {} lines; expected columns of numbers separated by tabs, "
        "commas, semicolons or blanks",
        name, lines.size()));
  }
  layout.data_begin = static_cast<std::size_t>(first->data() - text.data());
  layout.preamble_lines = static_cast<std::size_t>(first - lines.begin());
  layout.quoted =
      std::any_of(first, lines.end(), [](auto line) { return line.find('"') != std::string_view::npos; });
  auto width = split_line(*first, layout.separator).size();
  if (split_line(*first, layout.separator).back().empty() && width > 1) --width;  // a separator ends the line
  const HeaderLine header = read_header(layout, {lines.data(), layout.preamble_lines}, width);
  find_stamps(layout, *first);
  for (auto line = first; line != lines.end(); ++line) {
    const auto number = static_cast<std::size_t>(line - lines.begin()) + 1;
    if (reading.reads(*line))
      require_names_for_numbers(header, layout, {.text = *line, .number = number}, name);
  }
  return layout;
}

}  // namespace kerf::bench

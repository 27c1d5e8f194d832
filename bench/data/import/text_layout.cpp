#include "import/text_layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>

#include <fmt/core.h>
#include <iconv.h>

#include "files/trimmed.h"
#include "import/decimal.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_preamble_lines = 1000;
constexpr std::size_t sampled_data_lines = 50;

bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r'; }

bool is_number(std::string_view field, char point) noexcept {
  double value = 0.0;
  return !field.empty() && parse_decimal(field.data(), field.data() + field.size(), point, value) ==
                               field.data() + field.size();
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
        std::count_if(fields.begin(), fields.end(), [&](auto f) { return is_number(f, point); });
    const auto filled = std::count_if(fields.begin(), fields.end(), [](auto f) { return !f.empty(); });
    return numbers >= 1 && 2 * numbers > filled && 2 * static_cast<std::size_t>(numbers) >= columns;
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
        if (is_number(field, reading.point)) {
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

/// "Time [ms]" -> {"Time", "ms"}; "t_s" -> {"t_s", "s"}: the name keeps what may be part of it.
TextColumn named_column(std::string_view field) {
  const std::string heading = to_utf8(trimmed(field));
  TextColumn column{.heading = heading, .name = heading, .unit = {}};
  const auto known = [](std::string_view text) {
    try {
      (void)parse_unit(text);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  for (const auto& brackets : {std::string_view("[]"), std::string_view("()")}) {
    const auto open = column.name.rfind(brackets[0]);
    if (open == std::string::npos || open == 0 || column.name.back() != brackets[1]) continue;
    const std::string unit = column.name.substr(open + 1, column.name.size() - open - 2);
    if (!known(unit)) continue;
    column.unit = unit;
    column.name = std::string(trimmed(std::string_view(column.name).substr(0, open)));
    return column;
  }
  const auto underscore = column.name.rfind('_');
  if (underscore != std::string::npos && underscore > 0) {
    const std::string unit = column.name.substr(underscore + 1);
    if (!unit.empty() && std::isalpha(static_cast<unsigned char>(unit[0])) && known(unit)) column.unit = unit;
  }
  return column;
}

/// The unit in a field of a units row, "(mm)" or "[N]" or "mm"; none if it does not look like one.
std::optional<std::string> unit_field(std::string_view field) {
  if (field.empty()) return std::string();
  const bool bracketed = field.size() > 2 && ((field.front() == '(' && field.back() == ')') ||
                                              (field.front() == '[' && field.back() == ']'));
  const std::string unit(bracketed ? field.substr(1, field.size() - 2) : field);
  try {
    (void)parse_unit(unit);
    return unit;
  } catch (const std::invalid_argument&) {
    if (bracketed) return std::string();  // a units row all the same, with a unit that is not known here
    return std::nullopt;
  }
}

bool is_units_row(const std::vector<std::string_view>& fields) {
  return std::any_of(fields.begin(), fields.end(), [](auto f) { return !f.empty(); }) &&
         std::all_of(fields.begin(), fields.end(), [](auto f) { return unit_field(f).has_value(); });
}

std::string_view without_comment_sign(std::string_view line) {
  line = trimmed(line);
  while (!line.empty() && (line.front() == '%' || line.front() == '#')) line.remove_prefix(1);
  return line;
}

/// Reads header and units out of the lines before the data.
void read_header(TextLayout& layout, const std::vector<std::string_view>& preamble, std::size_t width) {
  layout.columns.resize(width);
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < preamble.size(); ++i) {
    if (!trimmed(preamble[i]).empty()) filled.push_back(i);
  }
  if (filled.empty()) return;
  auto fields = split_line(without_comment_sign(preamble[filled.back()]), layout.separator);
  std::vector<std::string> units;
  if (is_units_row(fields)) {
    layout.units_line = filled.back() + 1;
    for (const auto field : fields) units.push_back(*unit_field(field));
    filled.pop_back();
    if (!filled.empty()) fields = split_line(without_comment_sign(preamble[filled.back()]), layout.separator);
  }
  // A header has a name for most columns; a sentence before the data does not.
  if (!filled.empty() && 2 * fields.size() > width && (fields.size() > 1 || width == 1)) {
    layout.header_line = filled.back() + 1;
    layout.columns.resize(std::max(width, fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i) layout.columns[i] = named_column(fields[i]);
  }
  for (std::size_t i = 0; i < std::min(units.size(), layout.columns.size()); ++i) {
    if (!units[i].empty()) layout.columns[i].unit = units[i];
  }
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
  read_header(layout, {lines.begin(), first}, width);
  return layout;
}

}  // namespace kerf::bench

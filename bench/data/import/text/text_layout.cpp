#include "import/text/text_layout.h"

#include <algorithm>
#include <charconv>
#include <span>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "files/trimmed.h"
#include "import/decimal.h"
#include "import/text/no_table.h"
#include "import/text/reading.h"
#include "import/text/text_header.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_preamble_lines = 1000;
constexpr std::size_t sampled_data_lines = 50;

bool is_blank(char c) noexcept { return c == ' ' || c == '\t' || c == '\r'; }

/// Which columns hold time stamps, by the first line of the data.
void find_stamps(TextLayout& layout, std::string_view line) {
  const auto fields = split_line(line, layout.separator);
  for (std::size_t i = 0; i < std::min(fields.size(), layout.columns.size()); ++i) {
    TimeStamp stamp;
    if (!is_time_stamp(fields[i], stamp)) continue;
    layout.columns[i].stamps = stamp;
    layout.columns[i].unit = "s";
    layout.columns[i].unknown_unit.clear();
  }
}

/// The lines in UTF-8: all together tell their encoding better than one name does.
std::vector<std::string> as_utf8(std::span<const std::string_view> lines) {
  const std::string text = to_utf8(fmt::format("{}", fmt::join(lines, "\n")));
  std::string_view rest = text;
  std::vector<std::string> converted;
  for (std::size_t i = 0; i < lines.size(); ++i) converted.emplace_back(take_line(rest));
  return converted;
}

}  // namespace

std::string_view take_line(std::string_view& rest) noexcept {
  const auto end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

bool is_comment(std::string_view line) noexcept {
  line = trimmed(line);
  if (line.starts_with('"')) line.remove_prefix(1);
  return line.starts_with('#') || line.starts_with('%');
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
      const std::size_t begin = at;
      at = std::min(end + 1, line.size());
      fields.push_back(line.substr(begin + 1, end - begin - 1));
      if (separator != ' ') skip_blanks();
      if (at < line.size() && !(separator == ' ' ? is_blank(line[at]) : line[at] == separator)) {
        // The field goes on behind its quotes, as all of a line does that has another separator.
        while (at < line.size() && !(separator == ' ' ? is_blank(line[at]) : line[at] == separator)) ++at;
        fields.back() = trimmed(line.substr(begin, at - begin));
      }
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

void count_from_first(TextLayout& layout, std::size_t column, std::string_view text) {
  constexpr std::int64_t least = 1'000'000'000;
  std::string_view rest = text.substr(layout.data_begin);
  const auto fields = split_line(take_line(rest), layout.separator);
  if (column >= fields.size() || layout.columns[column].stamps) return;
  const std::string_view field = fields[column];
  std::int64_t whole = 0;
  const auto read = std::from_chars(field.data(), field.data() + field.size(), whole);
  if (read.ec == std::errc{} && whole >= least) layout.columns[column].origin = whole;
}

bool names_all(const std::vector<std::string_view>& fields, std::size_t columns) {
  return fields.size() == columns && std::ranges::none_of(fields, [](std::string_view field) {
           return trimmed(field).empty() || is_decimal(field, '.') || is_decimal(field, ',');
         });
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
  std::vector<std::string_view> middle;
  std::string_view second_half = rest.substr(rest.size() / 2);
  (void)take_line(second_half);
  while (middle.size() < sampled_data_lines && !second_half.empty()) middle.push_back(take_line(second_half));
  std::vector<std::string_view> sample = lines;
  sample.insert(sample.end(), middle.begin(), middle.end());
  const Reading reading = best_reading(sample);

  TextLayout layout{.separator = reading.separator, .point = reading.point};
  const auto first = lines.begin() + static_cast<std::ptrdiff_t>(first_line_of_data(reading, lines, middle));
  if (first == lines.end() || is_json(lines)) {
    const std::string what = what_it_may_be(lines);
    throw std::invalid_argument(fmt::format(
        "{}: no line of numbers in the first {} lines; expected columns of numbers separated by tabs, "
        "commas, semicolons or blanks{}{}",
        name, lines.size(), what.empty() ? "" : "; ", what));
  }
  layout.data_begin = static_cast<std::size_t>(first->data() - text.data());
  layout.preamble_lines = static_cast<std::size_t>(first - lines.begin());
  layout.quoted =
      std::any_of(first, lines.end(), [](auto line) { return line.find('"') != std::string_view::npos; });
  auto width = split_line(*first, layout.separator).size();
  if (split_line(*first, layout.separator).back().empty() && width > 1) --width;  // a separator ends the line
  const std::vector<std::string> preamble = as_utf8({lines.data(), layout.preamble_lines});
  const std::vector<std::string_view> said(preamble.begin(), preamble.end());
  const HeaderLine header = read_header(layout, said, width);
  find_stamps(layout, *first);
  for (auto line = first; line != lines.end(); ++line) {
    const auto number = static_cast<std::size_t>(line - lines.begin()) + 1;
    if (reading.reads(*line))
      require_names_for_numbers(header, layout, {.text = *line, .number = number}, name);
  }
  return layout;
}

}  // namespace kerf::bench

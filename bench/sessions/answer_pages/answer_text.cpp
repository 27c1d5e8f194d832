#include "answer_pages/answer_text.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "import/decimal.h"
#include "import/text/text_layout.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

/// `key = "value"` after the #.
void take_remark(std::string_view line, std::size_t number, AnswerText& text) {
  const auto equals = line.find('=');
  if (equals == std::string_view::npos) return;
  const auto trimmed = [](std::string_view part) {
    const auto begin = part.find_first_not_of(" \t#\"");
    if (begin == std::string_view::npos) return std::string();
    return csv_unquoted(part.substr(begin, part.find_last_not_of(" \t\"") - begin + 1));
  };
  const std::string key = trimmed(line.substr(0, equals));
  if (key == "design" || key == "task" || key == "name" || key == "until" || key == "modulus" ||
      key == "points")
    text.remarks[key] = {trimmed(line.substr(equals + 1)), number};
}

char separator_of(std::string_view head) {
  for (const char separator : {'\t', ';'}) {
    if (head.find(separator) != std::string_view::npos) return separator;
  }
  return ',';
}

}  // namespace

AnswerText split_answers(std::string_view content, const std::string& file) {
  AnswerText text{.file = file};
  if (content.find('\0') != std::string_view::npos)
    text.refuse(1, "a binary file; expected a table of answers as text");
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  char separator = ',';
  for (std::size_t number = 1; !content.empty(); ++number) {
    const std::string_view line = take_line(content);
    const auto first = line.find_first_not_of(" \t");
    if (first == std::string_view::npos) continue;
    if (line[first] == '#') {
      take_remark(line.substr(first), number, text);
      continue;
    }
    if (text.head.empty()) separator = separator_of(line);
    std::vector<std::string> fields;
    for (const std::string_view field : split_line(line, separator))
      fields.push_back(csv_unquoted(to_utf8(field)));
    if (text.head.empty()) {
      text.head_line = number;
      text.head = std::move(fields);
      continue;
    }
    if (fields.size() != text.head.size()) {
      text.refuse(number, "{} fields, expected {} as in the first line ({})", fields.size(), text.head.size(),
                  fmt::join(text.head, ","));
    }
    text.rows.push_back({.line = number, .fields = std::move(fields)});
  }
  if (text.head.empty())
    text.refuse(1, "no line of column names; expected one such as subject,tissue,preferred");
  for (const std::string& name : text.head) {
    if (std::count(text.head.begin(), text.head.end(), name) > 1)
      text.refuse(text.head_line, "column '{}' is there twice", name);
  }
  return text;
}

std::string AnswerReader::field(const char* column) const {
  const auto at = text_.column(column);
  return at ? row_.fields[*at] : std::string();
}

std::string AnswerReader::needed(const char* column) const {
  std::string value = field(column);
  if (value.empty()) refuse("column '{}' is empty; expected a value", column);
  return value;
}

double AnswerReader::number(const char* column) const {
  const std::string value = field(column);
  if (value.empty()) return std::numeric_limits<double>::quiet_NaN();
  double result = 0.0;
  const char* end = value.data() + value.size();
  if (parse_decimal(value.data(), end, '.', result) != end || !std::isfinite(result))
    refuse("column '{}' is '{}', expected a number such as 0.1", column, value);
  return result;
}

std::size_t AnswerReader::whole(const char* column, std::size_t otherwise) const {
  const double value = number(column);
  if (std::isnan(value)) return otherwise;
  if (value < 0.0 || value > 1e9 || value != std::floor(value))
    refuse("column '{}' is {:g}, expected a whole number of 0 or more", column, value);
  return static_cast<std::size_t>(value);
}

bool AnswerReader::yes(const char* column) const {
  const std::string value = needed(column);
  for (const char* text : {"1", "yes", "true", "right"}) {
    if (value == text) return true;
  }
  for (const char* text : {"0", "no", "false", "wrong"}) {
    if (value == text) return false;
  }
  refuse("column '{}' is '{}', expected 1 or 0 (or yes, no, true, false, right, wrong)", column, value);
}

std::size_t AnswerReader::slot(const char* column, Design design) const {
  const std::string value = needed(column);
  std::string labels;
  for (std::size_t slot = 0; slot < answers_of(design); ++slot) {
    if (value == answer_label_of(design, slot)) return slot;
    labels += fmt::format("{}{}", slot == 0 ? "" : " or ", answer_label_of(design, slot));
  }
  refuse("column '{}' is '{}', expected {}", column, value, labels);
}

}  // namespace kerf::bench

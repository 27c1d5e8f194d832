#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace kerf::bench {

/// A text as a cell in quotes: those in it are doubled, and it stays in one line.
[[nodiscard]] inline std::string csv_quoted(std::string_view text) {
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += '"';
    cell += c == '\n' || c == '\r' ? ' ' : c;
  }
  return cell + '"';
}

/// The same, in quotes only where it must be: a comma or a quote, a line break, or what begins a remark.
[[nodiscard]] inline std::string csv_text(std::string_view text) {
  return text.find_first_of(",\"\r\n#") == std::string_view::npos ? std::string(text) : csv_quoted(text);
}

/// What csv_quoted() wrote between its quotes.
[[nodiscard]] inline std::string csv_unquoted(std::string_view cell) {
  std::string text;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    text += cell[i];
    if (cell.substr(i, 2) == "\"\"") ++i;
  }
  return text;
}

/// A number as a cell, to its last digit; nothing where there is none.
[[nodiscard]] inline std::string csv_number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : std::string();
}
/// With so many digits.
[[nodiscard]] inline std::string csv_number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : std::string();
}

}  // namespace kerf::bench

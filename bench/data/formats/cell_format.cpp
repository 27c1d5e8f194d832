#include "formats/cell_format.h"

#include <cctype>

namespace kerf::bench {
namespace {

bool is_known_date(std::size_t number) noexcept {
  const auto within = [&](std::size_t first, std::size_t last) { return number >= first && number <= last; };
  return within(14, 22) || within(27, 36) || within(45, 47) || within(50, 58);
}

bool is_duration(std::string_view bracketed) noexcept {
  if (bracketed.empty()) return false;
  for (const char c : bracketed) {
    const int letter = std::tolower(static_cast<unsigned char>(c));
    if (letter != 'h' && letter != 'm' && letter != 's') return false;
  }
  return true;
}

}  // namespace

bool is_date_format(std::size_t number, std::string_view code) noexcept {
  if (is_known_date(number)) return true;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '"') {
      i = code.find('"', i + 1);
    } else if (c == '[') {
      const std::size_t end = code.find(']', i);
      if (end == std::string_view::npos) return false;
      if (is_duration(code.substr(i + 1, end - i - 1))) return true;
      i = end;
    } else if (c == '\\' || c == '_' || c == '*') {
      ++i;
    } else if (std::string_view("ymdhsYMDHS").find(c) != std::string_view::npos) {
      return true;
    }
    if (i == std::string_view::npos) return false;
  }
  return false;
}

}  // namespace kerf::bench

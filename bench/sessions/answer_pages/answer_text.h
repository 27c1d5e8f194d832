#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "protocol/protocol.h"

namespace kerf::bench {

/// A line of answers.
struct AnswerRow {
  std::size_t line = 0;
  std::vector<std::string> fields;
};

/// Head, rows and the remarks of comment lines.
struct AnswerText {
  std::string file;
  std::size_t head_line = 0;
  std::vector<std::string> head;
  std::vector<AnswerRow> rows;
  std::map<std::string, std::pair<std::string, std::size_t>> remarks;  ///< value and line

  template <typename... Arguments>
  [[noreturn]] void refuse(std::size_t line, fmt::format_string<Arguments...> text,
                           Arguments&&... arguments) const {
    throw std::invalid_argument(
        fmt::format("{}:{}: {}", file, line, fmt::format(text, std::forward<Arguments>(arguments)...)));
  }

  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const {
    const auto found = std::find(head.begin(), head.end(), name);
    if (found == head.end()) return std::nullopt;
    return static_cast<std::size_t>(found - head.begin());
  }

  [[nodiscard]] std::string remark(const char* key) const {
    const auto found = remarks.find(key);
    return found == remarks.end() ? std::string() : found->second.first;
  }
};

/// @throws std::invalid_argument with file and line: no table, or a row with other fields than the first.
[[nodiscard]] AnswerText split_answers(std::string_view content, const std::string& file);

/// One row of a table, by the names of its columns; empty where the table has no such column.
/// @throws std::invalid_argument with file, line, found and expected.
class AnswerReader {
 public:
  AnswerReader(const AnswerText& text, const AnswerRow& row) : text_(text), row_(row) {}

  [[nodiscard]] std::string field(const char* column) const;
  [[nodiscard]] std::string needed(const char* column) const;
  /// NaN where it is empty.
  [[nodiscard]] double number(const char* column) const;
  [[nodiscard]] std::size_t whole(const char* column, std::size_t otherwise) const;
  [[nodiscard]] bool yes(const char* column) const;
  /// By its label: A, B or 1, 2, 3.
  [[nodiscard]] std::size_t slot(const char* column, Design design) const;

  template <typename... Arguments>
  [[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments) const {
    text_.refuse(row_.line, text, std::forward<Arguments>(arguments)...);
  }

 private:
  const AnswerText& text_;
  const AnswerRow& row_;
};

}  // namespace kerf::bench

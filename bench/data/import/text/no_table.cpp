#include "import/text/no_table.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include "files/trimmed.h"

namespace kerf::bench {
namespace {

constexpr std::size_t lines_judged = 50;

/// The first of those that are not empty, without the blanks around them.
std::vector<std::string_view> filled_lines(const std::vector<std::string_view>& lines) {
  std::vector<std::string_view> filled;
  for (const std::string_view line : lines) {
    if (filled.size() == lines_judged) break;
    if (!trimmed(line).empty()) filled.push_back(trimmed(line));
  }
  return filled;
}

/// Twice and more a line "=0.1" or "=(0.1".
bool is_log(std::string_view line) {
  std::size_t values = 0;
  for (auto at = line.find('='); at != std::string_view::npos; at = line.find('=', at + 1)) {
    std::string_view rest = trimmed(line.substr(at + 1));
    while (rest.starts_with('(') || rest.starts_with('[') || rest.starts_with('-')) rest.remove_prefix(1);
    if (!rest.empty() && std::isdigit(static_cast<unsigned char>(rest.front())) != 0) ++values;
  }
  return values >= 2;
}

bool has_lists(std::string_view line) {
  const auto open = line.find('[');
  const auto comma = open == std::string_view::npos ? open : line.find(',', open);
  return comma != std::string_view::npos && line.find(']', comma) != std::string_view::npos;
}

template <typename Is>
bool are_most(const std::vector<std::string_view>& lines, const Is& is) {
  return 2 * static_cast<std::size_t>(std::ranges::count_if(lines, is)) > lines.size();
}

}  // namespace

bool is_json(const std::vector<std::string_view>& lines) {
  const std::vector<std::string_view> filled = filled_lines(lines);
  if (filled.empty()) return false;
  const std::string_view first = filled.front();
  if (first.starts_with('{')) return true;
  if (!first.starts_with('[')) return false;
  const std::string_view next = trimmed(first.substr(1));
  const std::string_view begin = next.empty() && filled.size() > 1 ? filled[1] : next;
  return begin.starts_with('{') || begin.starts_with('[');
}

std::string what_it_may_be(const std::vector<std::string_view>& lines) {
  const std::vector<std::string_view> filled = filled_lines(lines);
  if (is_json(lines))
    return "it is JSON, which is not read: write its numbers as a table first, for example with pandas: "
           "json_normalize(...).to_csv('t.csv')";
  if (are_most(filled, is_log))
    return "it is a log of NAME=VALUE, which is not read: write its numbers as columns first, for example "
           "with sed";
  if (are_most(filled, [](std::string_view line) { return line.find("->") != std::string_view::npos; }))
    return "what stands before '->' is of the program that logged it: take it off first, for example by sed "
           "'s/.*-> //'";
  if (are_most(filled, has_lists))
    return "its fields hold lists [a, b], which are not read: write a column a number first";
  return "";
}

}  // namespace kerf::bench

#include "regress/renderers/number_table.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

#include "files/named_file.h"
#include "import/decimal.h"

namespace kerf::bench {
namespace {

std::string_view trim(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

void take_declaration(std::string_view line, NumberTable& table) {
  line.remove_prefix(1);
  const auto colon = line.find(':');
  if (colon == std::string_view::npos) return;
  table.declared.emplace_back(trim(line.substr(0, colon)), trim(line.substr(colon + 1)));
}

}  // namespace

std::size_t NumberTable::column(const std::string& name) const {
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

NumberTable read_number_table(const std::filesystem::path& file, std::uintmax_t at_most) {
  const std::string text = read_named_file(file, at_most);
  NumberTable table;
  std::size_t number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const auto end = rest.find('\n');
    const std::string_view line = trim(rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    ++number;
    if (line.empty()) continue;
    if (table.names.empty() && line.front() == '#') {
      take_declaration(line, table);
      continue;
    }
    const auto fields = fields_of(line);
    if (table.names.empty()) {
      for (const std::string_view field : fields) table.names.emplace_back(field);
      continue;
    }
    if (fields.size() != table.names.size()) {
      throw std::invalid_argument(fmt::format("{}:{}: found {} values, expected {} as in the head",
                                              file.string(), number, fields.size(), table.names.size()));
    }
    for (const std::string_view field : fields) {
      double value = 0.0;
      const char* const stop = field.data() + field.size();
      if (field.empty() || parse_decimal(field.data(), stop, '.', value) != stop) {
        throw std::invalid_argument(
            fmt::format("{}:{}: found '{}', expected a number", file.string(), number, field.substr(0, 40)));
      }
      table.values.push_back(value);
    }
  }
  if (table.names.empty())
    throw std::invalid_argument(
        fmt::format("{}: it is empty, expected a head and a row a tick", file.string()));
  return table;
}

}  // namespace kerf::bench

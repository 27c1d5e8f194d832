#include "import/column_map.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace kerf::bench {
namespace {

constexpr auto map_example = "time=1[ms],position=2[deg],force=3[N]";

[[noreturn]] void refuse_entry(std::string_view entry, std::string_view reason) {
  throw std::invalid_argument(fmt::format("--map: '{}' {}; expected CHANNEL=COLUMN[unit], for example {}",
                                          entry, reason, map_example));
}

/// Splits at commas that stand neither in quotes nor in brackets.
std::vector<std::string_view> split_entries(std::string_view text) {
  std::vector<std::string_view> entries;
  std::size_t begin = 0;
  bool in_quotes = false;
  int depth = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i == text.size() || (text[i] == ',' && !in_quotes && depth == 0)) {
      entries.push_back(text.substr(begin, i - begin));
      begin = i + 1;
    } else if (text[i] == '"') {
      in_quotes = !in_quotes;
    } else if (!in_quotes && text[i] == '[') {
      ++depth;
    } else if (!in_quotes && text[i] == ']') {
      --depth;
    }
  }
  return entries;
}

bool is_channel_name(std::string_view name) {
  return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

MapEntry parse_entry(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) refuse_entry(text, "has no '='");
  MapEntry entry{.channel = std::string(text.substr(0, equals)), .column = {}, .unit = {}};
  while (!entry.channel.empty() && entry.channel.front() == ' ') entry.channel.erase(0, 1);
  if (entry.channel == "force") entry.channel = "force_measured";
  if (!is_channel_name(entry.channel))
    refuse_entry(text, "has no channel name of letters, digits and _ before '='");
  std::string_view column = text.substr(equals + 1);
  if (column.ends_with(']')) {
    const auto open = column.rfind('[');
    if (open == std::string_view::npos) refuse_entry(text, "closes a bracket that is not open");
    entry.unit = column.substr(open + 1, column.size() - open - 2);
    if (entry.unit.empty()) refuse_entry(text, "has an empty unit; write [1] for a plain number");
    column = column.substr(0, open);
  }
  while (column.ends_with(' ')) column.remove_suffix(1);
  if (column.size() >= 2 && column.front() == '"' && column.back() == '"')
    column = column.substr(1, column.size() - 2);
  if (column.empty()) refuse_entry(text, "names no column");
  entry.column = column;
  return entry;
}

std::optional<std::size_t> column_number(const std::string& text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string column_list(const TextLayout& layout) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const auto& name = layout.columns[i].name;
    names.push_back(name.empty() ? fmt::format("{}", i + 1) : fmt::format("{} '{}'", i + 1, name));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::size_t find_column(const MapEntry& entry, const TextLayout& layout, const std::string& name) {
  const auto named = std::find_if(layout.columns.begin(), layout.columns.end(),
                                  [&](const TextColumn& column) { return column.name == entry.column; });
  if (named != layout.columns.end()) {
    if (std::any_of(named + 1, layout.columns.end(), [&](const auto& c) { return c.name == entry.column; })) {
      throw std::invalid_argument(fmt::format("{}: two columns are named '{}'; give a number: {}", name,
                                              entry.column, column_list(layout)));
    }
    return static_cast<std::size_t>(named - layout.columns.begin());
  }
  const auto number = column_number(entry.column);
  if (number && *number >= 1 && *number <= layout.columns.size()) return *number - 1;
  throw std::invalid_argument(fmt::format("{}: --map asks for column '{}' for {}, but the file has {}", name,
                                          entry.column, entry.channel, column_list(layout)));
}

/// The kinds of unit that a channel of the schema may have; empty for a channel of one's own.
std::vector<std::string_view> kinds_of(std::string_view channel) {
  if (channel == "time") return {"s"};
  if (channel == "position") return {"m", "rad"};
  if (channel == "velocity") return {"m/s", "rad/s"};
  if (channel == "force_measured" || channel == "force_commanded") return {"N", "N·m"};
  return {};
}

Unit unit_for(const MapEntry& entry, const TextColumn& column, const std::string& name) {
  const std::string& text = entry.unit.empty() ? column.unit : entry.unit;
  if (text.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: column '{}' for {} has no unit in the file; give one in brackets: {}={}[{}]", name,
                    entry.column, entry.channel, entry.channel, entry.column,
                    kinds_of(entry.channel).empty() ? "1" : kinds_of(entry.channel).front()));
  }
  Unit unit;
  try {
    unit = parse_unit(text);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--map: {}: {}", entry.channel, error.what()));
  }
  const auto kinds = kinds_of(entry.channel);
  if (!kinds.empty() && std::find(kinds.begin(), kinds.end(), unit.si) == kinds.end()) {
    throw std::invalid_argument(
        fmt::format("--map: {} in '{}' is not a unit of {}; expected one of the kind {}", entry.channel, text,
                    entry.channel, fmt::join(kinds, " or ")));
  }
  return unit;
}

}  // namespace

std::vector<MapEntry> parse_map(std::string_view text) {
  std::vector<MapEntry> entries;
  for (const auto entry : split_entries(text)) entries.push_back(parse_entry(entry));
  for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
    if (std::any_of(entries.begin(), entry,
                    [&](const auto& other) { return other.channel == entry->channel; })) {
      throw std::invalid_argument(fmt::format("--map: '{}' is mapped twice", entry->channel));
    }
  }
  return entries;
}

std::vector<MappedColumn> match_columns(const std::vector<MapEntry>& entries, const TextLayout& layout,
                                        const std::string& name) {
  std::vector<MappedColumn> columns;
  for (const MapEntry& entry : entries) {
    const std::size_t index = find_column(entry, layout, name);
    columns.push_back({.channel = entry.channel,
                       .index = index,
                       .unit = unit_for(entry, layout.columns[index], name),
                       .unit_from_file = entry.unit.empty()});
  }
  if (std::none_of(columns.begin(), columns.end(), [](const auto& c) { return c.channel == "position"; })) {
    throw std::invalid_argument(fmt::format("{}: --map maps no position; for example {}", name, map_example));
  }
  return columns;
}

std::string describe_columns(const TextLayout& layout, std::string_view text) {
  std::string_view rest = text.substr(layout.data_begin);
  const auto fields = split_line(take_line(rest), layout.separator);
  std::string description;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const TextColumn& column = layout.columns[i];
    description += fmt::format("  {}  {}{}{}\n", i + 1, column.name.empty() ? "(no name)" : column.name,
                               column.unit.empty() ? "" : fmt::format(" [{}]", column.unit),
                               i < fields.size() ? fmt::format("  first value {}", fields[i]) : "");
  }
  return description;
}

}  // namespace kerf::bench

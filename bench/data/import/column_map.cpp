#include "import/column_map.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "files/trimmed.h"
#include "import/spatial/spatial_columns.h"
#include "import/text/unit_words.h"

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
  MapEntry entry{.channel = std::string(trimmed(text.substr(0, equals))),
                 .column = {},
                 .unit = {},
                 .orientation = {},
                 .frame = {}};
  if (entry.channel == "force") entry.channel = "force_measured";
  if (!is_channel_name(entry.channel) && !is_spatial_part(entry.channel))
    refuse_entry(text, "has no channel name of letters, digits and _ before '='");
  std::string_view column = trimmed(text.substr(equals + 1));
  if (column.ends_with(']')) {
    const auto open = column.rfind('[');
    if (open == std::string_view::npos) refuse_entry(text, "closes a bracket that is not open");
    entry.unit = column.substr(open + 1, column.size() - open - 2);
    if (entry.unit.empty()) refuse_entry(text, "has an empty unit; write [1] for a plain number");
    column = trimmed(column.substr(0, open));
  }
  if (column.size() >= 2 && column.find('"', 1) == column.size() - 1 && column.front() == '"')
    column = column.substr(1, column.size() - 2);
  if (column.empty()) refuse_entry(text, "names no column");
  entry.column = column;
  take_spatial_words(entry);
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
    const auto& heading = layout.columns[i].heading;
    names.push_back(heading.empty() ? fmt::format("{}", i + 1) : fmt::format("{} '{}'", i + 1, heading));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

Unit unit_for(const MapEntry& entry, const TextColumn& column, const std::string& name) {
  const std::string& text = entry.unit.empty() ? column.unit : entry.unit;
  const auto kinds = kinds_of(entry.channel);
  if (text.empty() && !column.unknown_unit.empty()) {
    const bool is_raw = is_raw_unit(column.unknown_unit);
    const char* const what = has_factor(column.unknown_unit)
                                 ? "which may mean its numbers times or by a factor"
                                 : "which is no unit known here";
    throw std::invalid_argument(fmt::format(
        "{}: column '{}' for {} is in {} as the file says, {}; say {}: {}={}[{} {}]", name, entry.column,
        entry.channel, column.unknown_unit, what, is_raw ? "how many are one" : "what one of it is",
        entry.channel, entry.column, is_raw ? "counts/1000" : "0.001", kinds.empty() ? "1" : kinds.front()));
  }
  if (text.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: column '{}' for {} has no unit in the file; give one in brackets: {}={}[{}]{}", name,
        entry.column, entry.channel, entry.channel, entry.column, kinds.empty() ? "1" : kinds.front(),
        entry.channel == "time" ? "; moments are read as 2026-01-31T12:00:00.000 or 31.01.2026 12:00:00.000"
                                : ""));
  }
  Unit unit;
  try {
    unit = parse_unit(text);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--map: {}: {}", entry.channel, error.what()));
  }
  if (!kinds.empty() && std::find(kinds.begin(), kinds.end(), unit.si) == kinds.end()) {
    throw std::invalid_argument(
        fmt::format("--map: {} in '{}' is not a unit of {}; expected one of the kind {}{}", entry.channel,
                    text, entry.channel, fmt::join(kinds, " or "),
                    kinds.front() == "N" && unit.si == "kg" ? "; a weight is written gf, kgf or lbf" : ""));
  }
  return unit;
}

/// "M[2]" where that is a column, and no column M in units of 2.
void take_number_for_name(MapEntry& entry, const TextLayout& layout) {
  const std::string whole = fmt::format("{}[{}]", entry.column, entry.unit);
  if (entry.unit.empty() ||
      std::ranges::find(layout.columns, whole, &TextColumn::name) == layout.columns.end())
    return;
  entry.column = whole;
  entry.unit.clear();
}

/// Forces share one unit, and a velocity has that of the position by the second.
void check_units_agree(const std::vector<MappedColumn>& columns) {
  std::string position;
  std::string velocity;
  std::string force;
  for (const MappedColumn& column : columns) {
    if (column.channel == "position") position = column.unit.si;
    if (column.channel == "velocity") velocity = column.unit.si;
    if (column.channel != "force_measured" && column.channel != "force_commanded") continue;
    if (!force.empty() && force != column.unit.si) {
      throw std::invalid_argument(fmt::format(
          "--map: one force is in {} and the other in {}; expected the same", force, column.unit.si));
    }
    force = column.unit.si;
  }
  if (!velocity.empty() && !position.empty() && velocity != position + "/s") {
    throw std::invalid_argument(fmt::format(
        "--map: velocity in {} does not fit a position in {}; expected {}/s", velocity, position, position));
  }
}

}  // namespace

std::vector<std::string_view> kinds_of(std::string_view channel) {
  if (channel == "time") return {"s"};
  if (channel == "position") return {"m", "rad"};
  if (channel == "velocity") return {"m/s", "rad/s"};
  if (is_spatial_part(channel))
    return channel.starts_with("p")   ? std::vector<std::string_view>{"m"}
           : channel.starts_with("f") ? std::vector<std::string_view>{"N"}
                                      : std::vector<std::string_view>{"N·m"};
  if (is_spatial(channel)) return {"1", "rad"};
  if (channel == "force" || channel == "force_measured" || channel == "force_commanded") return {"N", "N·m"};
  return {};
}

std::vector<std::string> usual_units_of(std::string_view channel) {
  const auto kinds = kinds_of(channel);
  if (kinds.empty()) return all_symbols();
  std::vector<std::string> units;
  for (const std::string_view kind : kinds) {
    for (std::string& symbol : symbols_of(kind)) units.push_back(std::move(symbol));
  }
  return units;
}

std::size_t find_column(const MapEntry& entry, const TextLayout& layout, const std::string& name) {
  for (const auto part : {&TextColumn::heading, &TextColumn::name}) {
    const auto is_meant = [&](const TextColumn& column) { return column.*part == entry.column; };
    const auto named = std::find_if(layout.columns.begin(), layout.columns.end(), is_meant);
    if (named == layout.columns.end()) continue;
    if (std::any_of(named + 1, layout.columns.end(), is_meant)) {
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
  for (MapEntry& entry : entries_of_one_column(entries, layout, name)) {
    take_number_for_name(entry, layout);
    const std::size_t index = entry.number > 0 ? entry.number - 1 : find_column(entry, layout, name);
    const TextColumn& column = layout.columns[index];
    columns.push_back({.channel = entry.channel,
                       .index = index,
                       .unit = unit_for(entry, column, name),
                       .unit_text = entry.unit.empty() ? column.unit : entry.unit,
                       .unit_from_file = entry.unit.empty()});
  }
  if (std::none_of(columns.begin(), columns.end(),
                   [](const auto& c) { return c.channel == "position" || is_spatial(c.channel); })) {
    throw std::invalid_argument(fmt::format("{}: --map maps no position; for example {}", name, map_example));
  }
  check_units_agree(columns);
  return columns;
}

std::string describe_columns(const TextLayout& layout, std::string_view text) {
  constexpr std::size_t lines_shown = 3;
  std::string_view rest = text.substr(layout.data_begin);
  std::vector<std::vector<std::string_view>> lines;
  while (lines.size() < lines_shown && !rest.empty())
    lines.push_back(split_line(take_line(rest), layout.separator));
  std::string description;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const TextColumn& column = layout.columns[i];
    const std::string unit = !column.unknown_unit.empty() ? fmt::format(" [{}?]", column.unknown_unit)
                             : column.unit.empty()        ? ""
                                                          : fmt::format(" [{}]", column.unit);
    description += fmt::format("{}  {}  {}{}: ", i == 0 ? "" : "\n", i + 1,
                               column.name.empty() ? "(no name)" : column.name, unit);
    for (const auto& line : lines) {
      if (i < line.size()) description += fmt::format("{} ", to_utf8(line[i]));
    }
    description += "...";
  }
  return description;
}

}  // namespace kerf::bench

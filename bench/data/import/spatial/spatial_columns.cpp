#include "import/spatial/spatial_columns.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "files/trimmed.h"

namespace kerf::bench {
namespace {

constexpr std::array vectors{"position", "force", "torque"};
constexpr std::array letters{"x", "y", "z"};

[[noreturn]] void refuse_map(const std::string& reason) { throw std::invalid_argument("--map: " + reason); }

std::string as_written(const MapEntry& entry) {
  const std::string brackets = entry.unit.empty() ? std::string() : fmt::format("[{}]", entry.unit);
  return fmt::format("{}={}{}", entry.channel == "force_measured" ? "force" : entry.channel, entry.column,
                     brackets);
}

std::string unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

/// The two ends of FIRST:LAST; nothing if the text is a heading as it stands, or one column.
std::optional<std::pair<std::string, std::string>> ends_of(const std::string& column,
                                                           const TextLayout& layout) {
  const auto is_heading = [&](const TextColumn& c) { return c.heading == column || c.name == column; };
  if (std::ranges::any_of(layout.columns, is_heading)) return std::nullopt;
  bool in_quotes = false;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (column[i] == '"') in_quotes = !in_quotes;
    if (column[i] != ':' || in_quotes) continue;
    return std::pair(unquoted(column.substr(0, i)), unquoted(column.substr(i + 1)));
  }
  return std::nullopt;
}

/// "N N·m" as two units; one text for both where there is none.
std::array<std::string, 2> units_of_wrench(const MapEntry& entry) {
  if (entry.unit.empty()) return {};
  const auto is_of_kind = [](std::string_view text, std::string_view kind) {
    try {
      return parse_unit(text).si == kind;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  const std::string_view text = entry.unit;
  for (auto blank = text.find(' '); blank != std::string_view::npos; blank = text.find(' ', blank + 1)) {
    const auto force = trimmed(text.substr(0, blank));
    const auto torque = trimmed(text.substr(blank));
    if (is_of_kind(force, "N") && is_of_kind(torque, "N·m")) return {std::string(force), std::string(torque)};
  }
  refuse_map(
      fmt::format("wrench in '{}' has not a unit of force and one of torque; expected for example "
                  "wrench={}[N N·m sensor]",
                  entry.unit, entry.column));
}

/// The channels that an entry of several columns stands for, and their units.
struct OneColumn {
  std::string channel;
  std::string unit;
};
std::vector<OneColumn> parts_of(const MapEntry& entry) {
  std::vector<OneColumn> parts;
  const auto add_vector = [&](const std::string& vector, const std::string& unit) {
    for (const char* letter : letters) parts.push_back({fmt::format("{}.{}", vector, letter), unit});
  };
  if (entry.orientation) {
    for (std::size_t i = 1; i <= entry.orientation->columns(); ++i)
      parts.push_back({fmt::format("orientation.{}", i), entry.unit});
  } else if (entry.channel == "wrench") {
    const auto [force, torque] = units_of_wrench(entry);
    add_vector("force", force);
    add_vector("torque", torque);
  } else {
    add_vector(entry.channel == "force_measured" ? "force" : entry.channel, entry.unit);
  }
  return parts;
}

void add_entries(std::vector<MapEntry>& all, const MapEntry& entry,
                 const std::pair<std::string, std::string>& ends, const TextLayout& layout,
                 const std::string& name) {
  const auto index_of = [&](const std::string& column) {
    return find_column({.channel = entry.channel, .column = column, .unit = {}}, layout, name);
  };
  const std::size_t first = index_of(ends.first);
  const std::size_t last = index_of(ends.second);
  const std::vector<OneColumn> parts = parts_of(entry);
  if (last < first || last - first + 1 != parts.size()) {
    refuse_map(fmt::format("{}={} is from column {} to {}; expected {} columns side by side{}", entry.channel,
                           entry.column, first + 1, last + 1, parts.size(),
                           entry.orientation ? " for " + entry.orientation->text() : ""));
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    all.push_back({.channel = parts[i].channel,
                   .column = fmt::format("{}", first + i + 1),
                   .unit = parts[i].unit,
                   .number = first + i + 1,
                   .orientation = {},
                   .frame = entry.frame});
  }
}

bool has_channel(const std::vector<MappedColumn>& columns, const std::string& channel) {
  return std::ranges::find(columns, channel, &MappedColumn::channel) != columns.end();
}

/// Whether a vector is mapped. @throws std::invalid_argument if only a part of it is.
bool has_vector(const std::vector<MappedColumn>& columns, const std::string& vector) {
  std::string there;
  std::string missing;
  for (const char* letter : letters) {
    const std::string part = fmt::format("{}.{}", vector, letter);
    (has_channel(columns, part) ? there : missing) = part;
  }
  if (!there.empty() && !missing.empty())
    refuse_map(fmt::format("{} is mapped without {}; expected x, y and z", there, missing));
  return !there.empty();
}

/// The frame that all parts of the wrench say. @throws std::invalid_argument if one says another.
std::string frame_of(const std::vector<MapEntry>& entries) {
  std::string frame;
  for (const MapEntry& entry : entries) {
    if (entry.frame.empty()) continue;
    if (!frame.empty() && frame != entry.frame)
      refuse_map(fmt::format("one force is in the frame {} and another in {}; expected one for all", frame,
                             entry.frame));
    frame = entry.frame;
  }
  return frame;
}

void require_frame(const MapEntry& entry, bool has_several) {
  const bool is_vector = has_several && !entry.orientation && entry.channel != "position";
  const bool is_part = is_spatial_part(entry.channel) && !entry.channel.starts_with("position.");
  if (!entry.frame.empty() || (!is_vector && !is_part)) return;
  refuse_map(fmt::format(
      "{} does not say in which frame it is; end the brackets with sensor (axes that turn with the tool) or "
      "world",
      as_written(entry)));
}

void require_parts_that_fit(const SpatialMap& map, const std::vector<MappedColumn>& columns) {
  if (has_channel(columns, "position")) refuse_map("position is mapped both as one axis and as x, y, z");
  for (const char* channel : {"velocity", "force_measured", "force_commanded"}) {
    if (has_channel(columns, channel))
      refuse_map(fmt::format("{} is of one axis, and the position has x, y and z{}", channel,
                             std::string_view(channel) == "force_measured"
                                 ? "; map force=FIRST:LAST[N sensor], or force.x, force.y, force.z"
                                 : "; give it another name"));
  }
  if (map.has_torque && !map.has_force) refuse_map("a torque is mapped without its force");
  if (map.orientation) return;
  if (map.has_torque) refuse_map("a torque is mapped without an orientation, whose axes it would turn");
  if (map.frame == "sensor")
    refuse_map("a force in the frame sensor needs the sensor's orientation; map it, or say world");
}

}  // namespace

bool is_spatial_part(std::string_view channel) {
  return std::ranges::any_of(vectors, [&](std::string_view vector) {
    return channel.size() == vector.size() + 2 && channel.starts_with(vector) &&
           channel[vector.size()] == '.' && channel.back() >= 'x' && channel.back() <= 'z';
  });
}

bool is_spatial(std::string_view channel) {
  return is_spatial_part(channel) || channel.starts_with("orientation.");
}

void take_spatial_words(MapEntry& entry) {
  if (entry.channel == "orientation") {
    std::string_view rest = entry.unit;
    entry.orientation = take_orientation_form(rest);
    if (!entry.orientation || rest.empty() == entry.orientation->has_angles()) {
      throw std::invalid_argument(fmt::format(
          "--map: {} does not say how it is written; expected [quaternion xyzw], [quaternion "
          "wxyz], [rotvec rad], [euler xyz deg] (letters as SciPy has them), [matrix rows] or [matrix "
          "columns]",
          as_written(entry)));
    }
    entry.unit = entry.orientation->has_angles() ? std::string(rest) : "1";
    return;
  }
  const bool has_frame = entry.channel == "wrench" || entry.channel == "force_measured" ||
                         entry.channel == "torque" || is_spatial_part(entry.channel);
  if (!has_frame || entry.channel.starts_with("position")) return;
  for (const std::string_view frame : {"sensor", "world"}) {
    const std::string_view unit = entry.unit;
    if (unit != frame && !unit.ends_with(" " + std::string(frame))) continue;
    entry.frame = frame;
    entry.unit = trimmed(unit.substr(0, unit.size() - frame.size()));
    return;
  }
}

std::vector<MapEntry> entries_of_one_column(const std::vector<MapEntry>& entries, const TextLayout& layout,
                                            const std::string& name) {
  std::vector<MapEntry> all;
  for (const MapEntry& entry : entries) {
    const bool has_several = entry.orientation || entry.channel == "wrench";
    const bool may_have_several = has_several || entry.channel == "position" ||
                                  entry.channel == "force_measured" || entry.channel == "torque";
    const auto ends = may_have_several ? ends_of(entry.column, layout) : std::nullopt;
    if (has_several && !ends)
      refuse_map(fmt::format("{}={} is one column; expected FIRST:LAST", entry.channel, entry.column));
    if (!ends && !entry.frame.empty() && !is_spatial_part(entry.channel))
      refuse_map(fmt::format("{}={} has a frame and is one column; expected FIRST:LAST", entry.channel,
                             entry.column));
    require_frame(entry, ends.has_value());
    if (ends) {
      add_entries(all, entry, *ends, layout, name);
    } else {
      all.push_back(entry);
    }
  }
  for (auto entry = all.begin(); entry != all.end(); ++entry) {
    if (std::ranges::any_of(all.begin(), entry, [&](const auto& c) { return c.channel == entry->channel; }))
      refuse_map(fmt::format("'{}' is mapped twice", entry->channel));
  }
  return all;
}

std::optional<SpatialMap> spatial_map_of(const std::vector<MapEntry>& entries,
                                         const std::vector<MappedColumn>& columns) {
  const bool has_position = has_vector(columns, "position");
  if (!has_position) {
    const auto found = std::ranges::find_if(columns, [](const auto& c) { return is_spatial(c.channel); });
    if (found == columns.end()) return std::nullopt;
    refuse_map(fmt::format("{} is mapped without position.x, position.y and position.z", found->channel));
  }
  SpatialMap map{.orientation = {},
                 .frame = frame_of(entries),
                 .has_force = has_vector(columns, "force"),
                 .has_torque = has_vector(columns, "torque")};
  for (const MapEntry& entry : entries) {
    if (entry.orientation) map.orientation = entry.orientation;
  }
  require_parts_that_fit(map, columns);
  return map;
}

}  // namespace kerf::bench

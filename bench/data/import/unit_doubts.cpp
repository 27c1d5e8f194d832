#include "import/unit_doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double largest_force_n = 200.0;
constexpr double largest_torque_nm = 20.0;
constexpr double longest_way_m = 2.0;
constexpr double widest_way_rad = 2.0 * std::numbers::pi;
constexpr double longest_s = 4.0 * 3600.0;
constexpr double slowest_hz = 5.0;

std::optional<Unit> unit_of_heading(const std::string& text) {
  if (text.empty()) return std::nullopt;
  try {
    return parse_unit(text);
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // counts, or what is none of ours
  }
}

bool are_the_same(const Unit& a, const Unit& b) {
  constexpr double rounding = 1e-9;
  return a.si == b.si && std::abs(a.factor - b.factor) <= rounding * std::abs(b.factor);
}

/// What weighs a mass: "g" as "gf".
bool is_weight_of(const Unit& mass, const Unit& force) {
  constexpr double standard_gravity = 9.80665;
  return mass.si == "kg" && force.si == "N" &&
         are_the_same({.factor = mass.factor * standard_gravity, .si = "N", .offset = 0.0}, force);
}

/// Whether a map has the unit that the file says. A sign or a factor before it is a scale that somebody
/// chose.
bool fits(const Unit& said, const std::string& text_said, const MappedColumn& column) {
  if (are_the_same(said, column.unit)) return true;
  const Unit of_map = parse_unit(without_factor(column.unit_text));
  return are_the_same(parse_unit(without_factor(text_said)), of_map) || is_weight_of(said, of_map);
}

/// A unit alone, without how many numbers are one.
bool is_symbol(const std::string& text) {
  const std::vector<std::string> symbols = all_symbols();
  return text != "1" && std::ranges::find(symbols, text) != symbols.end();
}

std::string unit_text_of(const Imported& imported, const std::string& channel) {
  const auto found = std::ranges::find(imported.columns, channel, &MappedColumn::channel);
  return found == imported.columns.end() ? std::string() : found->unit_text;
}

struct Range {
  double least = 0.0;
  double most = 0.0;
};
/// Of one axis of rows that have several.
Range range_of_finite(const std::vector<double>& values, std::size_t axis, std::size_t axes) {
  std::optional<Range> range;
  for (std::size_t at = axis; at < values.size(); at += axes) {
    const double value = values[at];
    if (!std::isfinite(value)) continue;
    if (!range) range = Range{.least = value, .most = value};
    range->least = std::min(range->least, value);
    range->most = std::max(range->most, value);
  }
  return range.value_or(Range{});
}

void doubt_force(const Imported& imported, const std::string& channel, const std::vector<double>& values,
                 std::size_t axis, std::vector<std::string>& doubts) {
  const std::string& unit = imported.recording.axes[axis].force_unit;
  const auto [least, most] = range_of_finite(values, axis, imported.recording.dimensions());
  const double largest = std::max(std::abs(least), std::abs(most));
  if (largest <= (unit == "N" ? largest_force_n : largest_torque_nm)) return;
  doubts.push_back(fmt::format("{} reaches {:.4g} {} with its column in {}; is that unit right?", channel,
                               largest, unit, unit_text_of(imported, channel)));
}

void doubt_position(const Imported& imported, const std::string& channel, std::size_t axis,
                    std::vector<std::string>& doubts) {
  const std::string& unit = imported.recording.axes[axis].position_unit;
  const auto [least, most] =
      range_of_finite(imported.recording.position, axis, imported.recording.dimensions());
  if (most - least <= (unit == "m" ? longest_way_m : widest_way_rad)) return;
  doubts.push_back(fmt::format("{} goes over {:.4g} {} with its column in {}; is that unit right?", channel,
                               most - least, unit, unit_text_of(imported, channel)));
}

void doubt_time(const Imported& imported, std::vector<std::string>& doubts) {
  const std::vector<double>& time_s = imported.recording.time;
  const std::string unit = unit_text_of(imported, "time");
  const double span_s = time_s.empty() ? 0.0 : time_s.back() - time_s.front();
  const double rate_hz = span_s > 0.0 ? static_cast<double>(time_s.size() - 1) / span_s : 0.0;
  if (imported.recording.header.start_ns || unit.empty() || span_s < longest_s || rate_hz >= slowest_hz)
    return;
  doubts.push_back(
      fmt::format("the recording takes {:.1f} hours at {:.3g} Hz with its time in {}; is that unit right?",
                  span_s / 3600.0, rate_hz, unit));
}

}  // namespace

std::vector<std::string> unit_doubts(const Imported& imported) {
  std::vector<std::string> doubts;
  for (const MappedColumn& column : imported.columns) {
    const TextColumn& heading = imported.layout.columns[column.index];
    const std::string& unknown = heading.unknown_unit;
    if (!unknown.empty() && unknown != column.unit_text && is_symbol(column.unit_text)) {
      doubts.push_back(fmt::format(
          "column {} '{}' is in {} as the file says, and mapped to {} in {} one to one; how many "
          "are one {}?",
          column.index + 1, heading.heading, unknown, column.channel, column.unit_text, column.unit_text));
    }
    const auto said = unit_of_heading(heading.unit);
    if (column.unit_from_file || column.unit.si == "1" || !said || fits(*said, heading.unit, column))
      continue;
    doubts.push_back(
        fmt::format("column {} '{}' is in {} as the file says, and mapped to {} in {}; which is right?",
                    column.index + 1, heading.heading, heading.unit, column.channel, column.unit_text));
  }
  doubt_time(imported, doubts);
  const schema::Recording& recording = imported.recording;
  if (!imported.spatial) {
    doubt_position(imported, "position", 0, doubts);
    doubt_force(imported, "force_measured", recording.force_measured, 0, doubts);
    doubt_force(imported, "force_commanded", recording.force_commanded, 0, doubts);
    return doubts;
  }
  constexpr std::array letters_of_axes{"x", "y", "z"};
  for (std::size_t axis = 0; axis < recording.dimensions(); ++axis) {
    const bool turns = axis >= letters_of_axes.size();
    const char* const letter = letters_of_axes.at(axis % letters_of_axes.size());
    if (!turns) doubt_position(imported, fmt::format("position.{}", letter), axis, doubts);
    doubt_force(imported, fmt::format("{}.{}", turns ? "torque" : "force", letter), recording.force_measured,
                axis, doubts);
  }
  return doubts;
}

}  // namespace kerf::bench

#include "scene/read_motion.h"

#include <algorithm>

#include "laws/placement.h"

namespace kerf::bench {
StrokesToAndFro read_strokes(const Place& place, const toml::table& table, const StrokeFormat& format) {
  const auto position = [&](std::string_view key) {
    return read_number(
        place, table,
        {.key = key, .unit = format.unit, .lower = format.lower, .upper = format.upper, .required = true});
  };
  return {
      .from = position("from"),
      .to = position("to"),
      .stroke_s =
          read_seconds(place, table, "stroke", format.standard.stroke_s, format.shortest_s, format.longest_s),
      .pause_s = read_seconds(place, table, "pause", format.standard.pause_s, 0.0, format.longest_pause_s)};
}

ScriptedAxis read_scripted_axis(const Place& place, const toml::table& table,
                                const std::vector<models::LawAxis>& axes) {
  const std::string name = place.text(table, "axis", axes.front().name);
  const auto axis = std::ranges::find(axes, name, &models::LawAxis::name);
  if (axis == axes.end()) {
    place.refuse(*table.get("axis"), "'axis' is \"{}\", and the law has {}", name, names_in(axes));
  }
  const auto position = [&](std::string_view key) {
    return read_number(place, table, {.key = key, .unit = axis->position_unit, .required = true});
  };
  ScriptedAxis motion{.axis = static_cast<std::size_t>(axis - axes.begin()), .script = Rest{}};
  const std::string kind = place.text(table, "kind", "");
  if (kind == "rest") {
    place.allow_only(table, {"kind", "axis", "at"}, "a motion of the kind \"rest\"");
    motion.script = Rest{.at = position("at")};
  } else if (kind == "strokes") {
    place.allow_only(table, {"kind", "axis", "from", "to", "stroke", "pause"}, "a motion of strokes");
    motion.script = read_strokes(place, table, {.unit = axis->position_unit});
  } else if (kind == "sine") {
    place.allow_only(table, {"kind", "axis", "centre", "amplitude", "frequency", "phase"},
                     "a motion of the kind \"sine\"");
    motion.script = Sine{
        .centre = position("centre"),
        .amplitude = position("amplitude"),
        .frequency_hz = read_number(
            place, table,
            {.key = "frequency", .unit = "Hz", .standard = Sine{}.frequency_hz, .lower = 0.0, .upper = 1e4}),
        .phase_rad = read_number(place, table, {.key = "phase", .unit = "rad"})};
  } else if (kind == "ramp-and-hold") {
    place.allow_only(table, {"kind", "axis", "from", "to", "start", "ramp", "hold"},
                     "a motion of the kind \"ramp-and-hold\"");
    motion.script = RampAndHold{.from = position("from"),
                                .to = position("to"),
                                .start_s = read_seconds(place, table, "start", RampAndHold{}.start_s, 0.0),
                                .ramp_s = read_seconds(place, table, "ramp", RampAndHold{}.ramp_s, 0.001),
                                .hold_s = read_seconds(place, table, "hold", RampAndHold{}.hold_s, 0.0)};
  } else {
    const toml::node* node = table.get("kind");
    place.refuse(node != nullptr ? *node : table,
                 "'kind' is \"{}\", expected \"rest\", \"strokes\", \"sine\" or \"ramp-and-hold\"", kind);
  }
  return motion;
}

}  // namespace kerf::bench

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include "protocol/protocol_parts.h"
#include "scene/read_motion.h"

namespace kerf::bench {
namespace {

constexpr double least_beat_s = 0.2;  ///< 300 beats a minute
constexpr double longest_beat_s = 60.0;
constexpr double least_stroke_s = 0.1;
constexpr double slowest_hz = 0.02;
constexpr double fastest_hz = 5.0;
constexpr double most_felt_n = 100.0;
constexpr double stiffest = 1e6;
constexpr double felt_motion_s = 4.0;  ///< as long as a [motion], at least

/// The one axis on which every law lies, as the first sample has it.
const LawFile& law_of_guide(const Place& place, const toml::table& table, const Protocol& protocol) {
  const LawFile& first = protocol.samples.front().law;
  for (const SessionSample& sample : protocol.samples) {
    if (sample.law.law.is_spatial())
      place.refuse(table, "the law of sample '{}' acts on several axes; a target leads along one",
                   sample.name);
    if (sample.law.axis == first.axis && sample.law.position_unit == first.position_unit &&
        sample.law.force_unit == first.force_unit)
      continue;
    place.refuse(table,
                 "samples '{}' and '{}' lie on other axes or have other units; one target cannot lead along "
                 "both",
                 protocol.samples.front().name, sample.name);
  }
  return first;
}

void read_metronome(const Place& place, const toml::table& table, GuidedMotion& guide) {
  place.allow_only(table, {"kind", "period", "click", "when"}, "a [guide] of the kind \"metronome\"");
  if (!table.contains("period"))
    place.refuse(table, "a metronome needs its 'period', such as period = {{ value = 1, unit = \"s\" }}");
  guide.beat_s = read_seconds(place, table, "period", guide.beat_s, least_beat_s, longest_beat_s);
  guide.clicks = place.flag(table, "click", true);
}

FeltGuide read_felt(const Place& place, const toml::table& table, const GuidedMotion& guide) {
  const toml::table& given = place.table(table, "felt");
  place.allow_only(given, {"stiffness", "damping", "limit"}, "'felt' of [guide]");
  for (const char* key : {"stiffness", "limit"}) {
    if (!given.contains(key)) place.refuse(given, "'felt' of [guide] needs '{}', with its unit", key);
  }
  const std::string per_place = fmt::format("{}/{}", guide.force_unit, guide.position_unit);
  const std::string per_speed = fmt::format("{}·s/{}", guide.force_unit, guide.position_unit);
  const FeltGuide felt{
      .stiffness =
          read_number(place, given, {.key = "stiffness", .unit = per_place, .lower = 0.0, .upper = stiffest}),
      .damping =
          read_number(place, given, {.key = "damping", .unit = per_speed, .lower = 0.0, .upper = stiffest}),
      .limit = read_number(place, given,
                           {.key = "limit", .unit = guide.force_unit, .lower = 0.0, .upper = most_felt_n})};
  for (const auto& [key, value] : {std::pair{"stiffness", felt.stiffness}, {"limit", felt.limit}}) {
    if (value == 0.0)
      place.refuse(*given.get(key), "'{}' of [guide] is 0: nothing is felt; leave 'felt' out", key);
  }
  return felt;
}

void read_target(const Place& place, const toml::table& table, const Protocol& protocol,
                 GuidedMotion& guide) {
  place.allow_only(table, {"kind", "from", "to", "stroke", "pause", "frequency", "tool", "felt", "when"},
                   "a [guide] of the kind \"target\"");
  const LawFile& law = law_of_guide(place, table, protocol);
  guide.position_unit = law.position_unit;
  guide.force_unit = law.force_unit;
  const StrokesToAndFro strokes = read_strokes(place, table,
                                               {.unit = guide.position_unit,
                                                .standard = {.stroke_s = 0.8, .pause_s = 0.25},
                                                .shortest_s = least_stroke_s,
                                                .longest_s = 60.0,
                                                .longest_pause_s = 60.0});
  guide.from = strokes.from;
  guide.to = strokes.to;
  guide.stroke_s = strokes.stroke_s;
  guide.pause_s = strokes.pause_s;
  if (guide.from == guide.to) place.refuse(*table.get("to"), "'to' is where 'from' is: the target stands");
  guide.kind = GuideKind::strokes;
  if (table.contains("frequency")) {
    for (const char* key : {"stroke", "pause"}) {
      if (table.contains(key))
        place.refuse(*table.get(key), "'{}' is of strokes, and with 'frequency' the target is a sine", key);
    }
    guide.kind = GuideKind::sine;
    guide.frequency_hz = read_number(
        place, table, {.key = "frequency", .unit = "Hz", .lower = slowest_hz, .upper = fastest_hz});
  }
  guide.shows_tool = place.flag(table, "tool", true);
  if (table.contains("felt")) guide.felt = read_felt(place, table, guide);
}

}  // namespace

void read_guide(const Place& place, const toml::table& root, Protocol& protocol) {
  if (!root.contains("guide")) return;
  const toml::table& table = place.table(root, "guide");
  if (!table.contains("kind")) place.refuse(table, "[guide] needs a 'kind': \"metronome\" or \"target\"");
  GuidedMotion guide;
  const bool is_target = read_choice(place, table, "kind", false, {{"metronome", false}, {"target", true}});
  guide.when = read_choice(
      place, table, "when", GuideWhen::both,
      {{"both", GuideWhen::both}, {"practice", GuideWhen::practice}, {"trials", GuideWhen::trials}});
  if (guide.when == GuideWhen::practice && protocol.practice == 0)
    place.refuse(*table.get("when"),
                 "the guide leads in practice alone, and there is none; expected "
                 "'practice' above 0");
  if (is_target) {
    read_target(place, table, protocol, guide);
  } else {
    read_metronome(place, table, guide);
  }
  protocol.guide = guide;
}

MotionSource motion_of(const GuidedMotion& guide) {
  MotionSource motion;
  motion.seconds = guide.cycle_s() * std::ceil(felt_motion_s / guide.cycle_s());
  if (guide.kind == GuideKind::sine) {
    motion.axes = {{.axis = 0,
                    .script = Sine{.centre = 0.5 * (guide.from + guide.to),
                                   .amplitude = 0.5 * (guide.from - guide.to),
                                   .frequency_hz = guide.frequency_hz,
                                   .phase_rad = 0.5 * std::numbers::pi}}};
  } else {
    motion.axes = {
        {.axis = 0,
         .script = StrokesToAndFro{
             .from = guide.from, .to = guide.to, .stroke_s = guide.stroke_s, .pause_s = guide.pause_s}}};
  }
  return motion;
}

}  // namespace kerf::bench

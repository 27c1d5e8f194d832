#include "layout/layout.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace kerf::schema::layout {
namespace {

constexpr std::array<std::uint32_t, 1> version{schema_version};
constexpr auto flag_masks = [] {
  std::array<std::uint32_t, flag_table.size()> masks{};
  std::ranges::transform(flag_table, masks.begin(), &FlagInfo::flag);
  return masks;
}();
const std::string flag_meanings = [] {
  std::string names;
  for (const auto& flag : flag_table) names.append(names.empty() ? "" : " ").append(flag.name);
  return names;
}();
constexpr std::array<std::uint8_t, 4> phase_values{1, 2, 3, 4};

constexpr bool required = true;
constexpr bool optional = false;

constexpr std::array group_table{
    Group{"/", required, false, "The recording"},
    Group{"/samples", required, false, "One row a tick"},
    Group{"/samples/channels", optional, true,
          "Further measured channels: float64, N values each, with `units`"},
    Group{"/device", optional, true, "The device, with any further numbers and texts as attributes"},
    Group{"/scene", optional, true,
          "What was simulated or cut, with any further numbers and texts as attributes"},
    Group{"/cycles", optional, false, "What `kerf segment` found"},
    Group{"/cycle_flags", optional, false,
          "What is wrong with cycles, as `kerf segment` found it and as a person said since"},
    Group{"/cycle_edits", optional, false, "What a person changed of the cycles by hand"},
};

const std::array attribute_table{
    Attribute{"/", "schema", "text", "", required, "Always this text", schema_name},
    Attribute{"/", "schema_version", "uint32", "", required, "Always this number", std::span(version)},
    Attribute{"/", "created", "text", "", required, "When it began: ISO 8601, UTC, `2026-01-31T12:00:00Z`",
              &Header::created},
    Attribute{"/", "software", "text", "", required, "What wrote it, `kerf 0.1.0`", &Header::software},
    Attribute{"/", "uuid", "text", "", required, "Its identity: RFC 9562, lower case", &Header::uuid},
    Attribute{"/", "status", "text", "", required, "`recording`, `complete` or `aborted: WHY`",
              &Header::status},
    Attribute{"/", "source", "text", "", optional, "Imports: file name and SHA-256 of the data",
              &Header::source},
    Attribute{
        "/", "start_ns", "int64", "", optional,
        "When `time` was 0, in nanoseconds since 1970-01-01T00:00:00 of the `start_clock`, leap seconds not "
        "counted; absent if unknown",
        &Header::start_ns},
    Attribute{"/", "start_clock", "text", "", optional,
              "`UTC`, or `local`: the clock of a zone that nobody named; stands beside `start_ns`",
              &Header::start_clock},
    Attribute{"/", "history", "text", "", optional,
              "What was done to it since: one line a step, in order, each with its time and program",
              &Header::history},
    Attribute{"/samples", "axes", "text", "D", required, "Names of the axes: `theta`, `x_s`, `position`, ...",
              &Axis::name},
    Attribute{"/samples", "force_units", "text", "D", required, "`N` or `N·m`, one an axis",
              &Axis::force_unit},
    Attribute{"/samples", "levers", "float64", "D", required,
              "Travel of the point where the force acts, per unit of position", &Axis::lever},
    Attribute{"/samples", "contact_positions", "float64", "D", optional,
              "Where contact begins, as `kerf prepare --onset` found it; NaN where unknown",
              &Axis::contact_position},
    Attribute{"/samples", "contact_directions", "float64", "D", optional,
              "+1 if the position grows into the tissue, -1 if it shrinks; NaN where unknown",
              &Axis::contact_direction},
    Attribute{"/samples", "contact_errors", "float64", "D", optional,
              "Standard error of `contact_positions`; NaN where unknown", &Axis::contact_error},
    Attribute{"/samples/velocity", "derived", "text", "", optional,
              "How it was derived from the position; absent if it was measured", &Header::velocity_derived},
    Attribute{"/samples/flags", "flag_masks", "uint32", "B", required, "The bits", std::span(flag_masks)},
    Attribute{"/samples/flags", "flag_meanings", "text", "", required,
              "Their meanings in the same order, as in the CF conventions", std::string_view(flag_meanings)},
    Attribute{"/device", "uri", "text", "", optional, "The device's URI, `sim:scissors?seed=3`",
              &Header::device_uri},
    Attribute{"/device", "toml", "text", "", optional, "Its configuration", &Header::device_toml},
    Attribute{"/scene", "toml", "text", "", optional, "The scene's description", &Header::scene_toml},
    Attribute{"/cycles", "axis", "uint64", "", required, "The axis that opens and closes, counted from 0",
              &Cycles::axis},
    Attribute{"/cycles", "closing_direction", "float64", "", required,
              "+1 if the position grows while closing, -1 if it shrinks", &Cycles::closing_direction},
    Attribute{"/cycles", "contact_position", "float64", "", required,
              "Least engaged position, where penetration is zero", &Cycles::contact_position},
    Attribute{"/cycles", "filter_corner_hz", "float64", "", required,
              "Zero-phase low-pass before averaging [Hz]; 0 for none", &Cycles::filter_corner_hz},
    Attribute{"/cycles/phases", "flag_values", "uint8", "F", required, "The values of `phase`",
              std::span(phase_values)},
    Attribute{"/cycles/phases", "flag_meanings", "text", "", required, "Their meanings in the same order",
              std::string_view("opening open_to_close closing close_to_open")},
    Attribute{"/cycle_flags", "created", "text", "", required, "When it was looked at: ISO 8601, UTC",
              &CycleFlags::created},
    Attribute{"/cycle_flags", "software", "text", "", required, "By what, `kerf 0.1.0`",
              &CycleFlags::software},
    Attribute{"/cycle_flags", "felt", "float64", "", required,
              "Force beyond which contact was told, in the unit of the force of the cycles' axis",
              &CycleFlags::felt},
};

const std::array dataset_table{
    Dataset{"/samples/time", "float64", "N", Units::second, required,
            "Time from the start; the scale of dimension 0", &Recording::time, &Row::time_s},
    Dataset{"/samples/tick", "uint64", "N", Units::one, required, "Number of the tick; a jump is a gap",
            &Recording::tick, &Row::tick},
    Dataset{"/samples/position", "float64", "ND", Units::axis_position, required, "Position of the tool",
            &Recording::position, &Row::position},
    Dataset{"/samples/velocity", "float64", "ND", Units::axis_velocity, required, "Velocity of the tool",
            &Recording::velocity, &Row::velocity},
    Dataset{"/samples/force_commanded", "float64", "ND", Units::axis_force, optional,
            "Force that the device was told to exert; absent if none was", &Recording::force_commanded,
            &Row::force_commanded},
    Dataset{"/samples/force_measured", "float64", "ND", Units::axis_force, optional,
            "Force that a sensor measured; NaN where it had none, absent without a sensor",
            &Recording::force_measured, &Row::force_measured},
    Dataset{"/samples/wake_latency", "float32", "N", Units::second, optional,
            "From the deadline to the wake-up", &Recording::wake_latency, &Row::wake_latency_s},
    Dataset{"/samples/read_time", "float32", "N", Units::second, optional, "Reading the device",
            &Recording::read_time, &Row::read_time_s},
    Dataset{"/samples/compute_time", "float32", "N", Units::second, optional, "Computing the law",
            &Recording::compute_time, &Row::compute_time_s},
    Dataset{"/samples/write_time", "float32", "N", Units::second, optional, "Writing the force",
            &Recording::write_time, &Row::write_time_s},
    Dataset{"/samples/flags", "uint32", "N", Units::one, optional, "What happened in the tick, bit by bit",
            &Recording::flags, &Row::flags},
    Dataset{
        "/events",
        "{time float64, kind text, text text}",
        "E",
        Units::event,
        required,
        "What happened during the recording: `stop`, `gap`, `fault`, `contact`, `release`, `law` (what is "
        "rendered from then on), `zero`, `resume` (force taken away and let in by hand), `device`, "
        "`output` (a line that could not be printed), or the "
        "name of a flag",
        {},
        {}},
    Dataset{"/cycles/phases",
            "{cycle uint32, phase uint8, begin uint64, end uint64}",
            "P",
            Units::one,
            required,
            "Phases of each cycle: rows [begin, end) of /samples",
            {},
            {}},
    Dataset{"/cycles/grid",
            "float64",
            "G",
            Units::cycle_position,
            required,
            "Uniform positions; the scale of the branches",
            &Cycles::grid,
            {}},
    Dataset{"/cycles/closing",
            "float64",
            "CG",
            Units::cycle_force,
            required,
            "Force while closing; NaN where a cycle did not reach",
            &Cycles::closing,
            {}},
    Dataset{"/cycles/opening",
            "float64",
            "CG",
            Units::cycle_force,
            required,
            "Force while opening",
            &Cycles::opening,
            {}},
    Dataset{"/cycles/closing_mean",
            "float64",
            "G",
            Units::cycle_force,
            required,
            "Mean over the cycles",
            &Cycles::closing_mean,
            {}},
    Dataset{"/cycles/opening_mean",
            "float64",
            "G",
            Units::cycle_force,
            required,
            "Mean over the cycles",
            &Cycles::opening_mean,
            {}},
    Dataset{
        "/cycle_flags/flags",
        "{cycle uint32, fault text, reason text}",
        "K",
        Units::one,
        required,
        "One thing that is said of a cycle: `put_down`, `under_force`, `clipped`, `interrupted`, `outlier`, "
        "`by_hand`, or `accepted` (it is good whatever else is said of it), and why",
        {},
        {}},
    Dataset{
        "/cycle_edits/changes",
        "{edit uint32, cycle uint32, phase uint8, row_before int64, row_after int64, time text, author text, "
        "kind text, text text}",
        "H",
        Units::one,
        required,
        "One change: `found` (anew), `begin` or `end` of a phase moved, `split`, `merged`, `divided` "
        "(several cycles made several), `left_out`, `taken`, `as_found` (neither any more). Changes that "
        "were saved together share number, time and author. `phase` as in `/cycles/phases`, 0 for none; "
        "rows and cycles as they were numbered then, -1 for no row, 0 for no cycle; `text` says it in a "
        "sentence",
        {},
        {}},
};

std::vector<std::string> per_axis(std::span<const Axis> axes, std::string Axis::*unit,
                                  const char* suffix = "") {
  std::vector<std::string> units;
  for (const auto& axis : axes) units.push_back(axis.*unit + suffix);
  return units;
}

}  // namespace

std::span<const Group> groups() { return group_table; }

std::span<const Dataset> datasets() { return dataset_table; }

std::span<const Attribute> attributes() { return attribute_table; }

const Dataset& dataset(std::string_view path) {
  const auto found = std::ranges::find(dataset_table, path, &Dataset::path);
  if (found == dataset_table.end()) throw std::logic_error(std::string(path) + " is not in the schema");
  return *found;
}

std::string_view parent(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string_view last_name(std::string_view path) { return path.substr(path.rfind('/') + 1); }

std::vector<std::string> units_of(Units units, std::span<const Axis> axes, std::size_t cycle_axis) {
  switch (units) {
    case Units::one:
      return {"1"};
    case Units::second:
      return {"s"};
    case Units::axis_position:
      return per_axis(axes, &Axis::position_unit);
    case Units::axis_velocity:
      return per_axis(axes, &Axis::position_unit, "/s");
    case Units::axis_force:
      return per_axis(axes, &Axis::force_unit);
    case Units::cycle_position:
      return {cycle_axis < axes.size() ? axes[cycle_axis].position_unit : ""};
    case Units::cycle_force:
      return {cycle_axis < axes.size() ? axes[cycle_axis].force_unit : ""};
    case Units::event:
      return {"s", "1", "1"};
    case Units::any:
      return {};
  }
  return {};
}

bool is_list(Units units) {
  return units == Units::axis_position || units == Units::axis_velocity || units == Units::axis_force ||
         units == Units::event;
}

std::string_view describe(Units units) {
  switch (units) {
    case Units::one:
      return "`1`";
    case Units::second:
      return "`s`";
    case Units::axis_position:
      return "list of D: `m` or `rad`";
    case Units::axis_velocity:
      return "list of D: `m/s` or `rad/s`";
    case Units::axis_force:
      return "list of D: as `force_units`";
    case Units::cycle_position:
      return "that of the axis' position";
    case Units::cycle_force:
      return "that of the axis' force";
    case Units::event:
      return "list of 3: `s`, `1`, `1`";
    case Units::any:
      return "any";
  }
  return "";
}

}  // namespace kerf::schema::layout

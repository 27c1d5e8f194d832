#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <kerf/schema/final_name.h>

namespace kerf::schema {

inline constexpr std::string_view schema_name = "kerf.recording";
inline constexpr std::uint32_t schema_version = 1;
inline constexpr std::size_t max_axes = 6;
inline constexpr std::size_t max_channels = 16;  ///< of a live recording; an import has as many as it likes

/// Thrown when a file is not what the schema says, in one line: file, dataset, found, expected, mend.
struct FormatError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One axis of a recording.
struct Axis {
  std::string name = "position";    ///< "theta", "x_s", "position", ...
  std::string position_unit = "m";  ///< "m" or "rad"
  std::string force_unit = "N";     ///< "N" or "N·m"
  double lever = 1.0;               ///< travel of the point where the force acts, per unit of position
  double contact_position = std::numeric_limits<double>::quiet_NaN();  ///< where contact begins; NaN: unknown
  double contact_direction = std::numeric_limits<double>::quiet_NaN();  ///< +1 or -1: into the tissue
  double contact_error =
      std::numeric_limits<double>::quiet_NaN();  ///< standard error of the contact position
};

/// Something that happened during a recording.
struct Event {
  double time_s = 0.0;
  std::string kind;  ///< "start", "stop", "gap", "fault", ...
  std::string text;
};

/// A further measured channel, one value a row.
struct Channel {
  std::string name;
  std::string unit;
  std::vector<double> values;
};

/// Bits of `/samples/flags`.
enum Flag : std::uint32_t {
  flag_missed_deadline = 1U << 0U,
  flag_force_limited = 1U << 1U,
  flag_slew_limited = 1U << 2U,
  flag_soft_start = 1U << 3U,
  flag_law_fault = 1U << 4U,
  flag_device_fault = 1U << 5U,
  flag_resampled = 1U << 6U,
  flag_rows_lost = 1U << 7U,
  flag_position_jump = 1U << 8U,
  flag_watchdog = 1U << 9U,
  flag_soft_switch = 1U << 10U,
  flag_passivity_control = 1U << 11U,
  flag_zero_held = 1U << 12U,
  flag_sensor_fault = 1U << 13U,
};

/// What a flag is called in the file, and what it says of its row.
struct FlagInfo {
  Flag flag;
  std::string_view name;
  std::string_view meaning;
};

/// Every flag, in the order of its bit. New ones come at the end: a file of an earlier version has the first
/// of them, first_flags or more.
inline constexpr std::array<FlagInfo, 14> flag_table{{
    {flag_missed_deadline, "missed_deadline", "deadlines were missed before this tick"},
    {flag_force_limited, "force_limited", "the force was cut to what the device may exert"},
    {flag_slew_limited, "slew_limited", "the force changed more slowly than was asked for"},
    {flag_soft_start, "soft_start", "the force is let in along a ramp"},
    {flag_law_fault, "law_fault", "the law gave no finite force: zero force"},
    {flag_device_fault, "device_fault", "the device did not answer with finite numbers: zero force"},
    {flag_resampled, "resampled", "the row was interpolated"},
    {flag_rows_lost, "rows_lost", "rows before this one were lost, because the writer did not keep up"},
    {flag_position_jump, "position_jump", "the position moved farther than the device can: zero force"},
    {flag_watchdog, "watchdog", "the loop had stalled and the watchdog released the device: zero force"},
    {flag_soft_switch, "soft_switch", "two laws are blended"},
    {flag_passivity_control, "passivity_control", "damping was added to keep the rendering passive"},
    {flag_zero_held, "zero_held", "the position had jumped, and nobody has confirmed it: zero force"},
    {flag_sensor_fault, "sensor_fault",
     "the force sensor was overloaded, doubted itself or was silent: no measured force"},
}};

inline constexpr std::size_t first_flags = 12;

/// Further numbers and texts about a device or a scene, by name.
using Properties = std::map<std::string, std::variant<double, std::string>>;

/// Root attributes, and the texts that a recording came from.
struct Header {
  std::string created;              ///< ISO 8601, UTC: "2026-01-31T12:00:00Z"
  std::string software;             ///< "kerf 0.1.0"
  std::string uuid;                 ///< RFC 9562, lower case
  std::string status = "complete";  ///< "recording", "complete" or "aborted: WHY"
  std::string velocity_derived;     ///< how the velocity was derived from the position; empty if measured
  std::string source;               ///< file name and SHA-256 of the imported data; empty if recorded
  std::optional<std::int64_t> start_ns;  ///< when time was 0: nanoseconds since 1970 of start_clock
  std::string start_clock;       ///< "UTC", or "local" of a zone that nobody named; empty without start_ns
  std::string history;           ///< what was done to it since, one line a step; empty if nothing was
  std::string device_uri;        ///< empty if imported
  std::string device_toml;       ///< the device's configuration
  std::string scene_toml;        ///< what was simulated or cut, and with which known parameters
  Properties device_properties;  ///< attributes of /device beside its URI and TOML
  Properties scene_properties;   ///< attributes of /scene beside its TOML
};

/// A header of a recording that begins now: created, software and a new random uuid.
[[nodiscard]] Header new_header(std::string software);

/// One phase of a cycle: rows [begin, end).
enum class Phase : std::uint8_t { opening = 1, open_to_close = 2, closing = 3, close_to_open = 4 };
struct PhaseSpan {
  std::uint32_t cycle = 0;
  Phase phase = Phase::opening;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// What `kerf segment` finds and stores in `/cycles`.
struct Cycles {
  std::size_t axis = 0;            ///< the axis that opens and closes
  double closing_direction = 1.0;  ///< +1 if the position grows while closing, -1 if it shrinks
  double contact_position = 0.0;   ///< least engaged position, where penetration is zero
  double filter_corner_hz = 0.0;   ///< zero-phase low-pass applied before averaging
  std::vector<PhaseSpan> phases;
  std::vector<double> grid;                  ///< uniform positions, G
  std::vector<std::vector<double>> closing;  ///< cycles x G force; NaN where a cycle did not reach
  std::vector<std::vector<double>> opening;  ///< cycles x G
  std::vector<double> closing_mean;          ///< G
  std::vector<double> opening_mean;          ///< G
};

/// One thing that is said of a cycle.
struct CycleFlag {
  std::uint32_t cycle = 0;
  std::string fault;   ///< "put_down", ..., "by_hand"; "accepted": it is good whatever else is said of it
  std::string reason;  ///< in a sentence, with its numbers
};

/// What is wrong with the cycles, in `/cycle_flags`: as `kerf segment` found it, and as a person said since.
struct CycleFlags {
  std::string created;   ///< when it was looked at: ISO 8601, UTC
  std::string software;  ///< by what
  double felt = 0.0;     ///< force beyond which contact was told, in the unit of the cycles' axis
  std::vector<CycleFlag> flags;
};

/// One change that a person made to the cycles by hand; those that were saved together have one number.
/// Rows and cycles are numbered as they were when it was saved.
struct CycleChange {
  std::uint32_t edit = 1;        ///< number of the edit that it is part of, from 1
  std::uint32_t cycle = 0;       ///< 0: of all of them
  std::uint8_t phase = 0;        ///< whose boundary it is, as Phase has it; 0: of none
  std::int64_t row_before = -1;  ///< where the boundary was; -1: there was none
  std::int64_t row_after = -1;   ///< where it is since; -1: there is none
  std::string time;              ///< when it was saved: ISO 8601, UTC
  std::string author;            ///< who edited
  std::string kind;              ///< one of cycle_change_kinds
  std::string text;              ///< in a sentence, with times and reasons
};

/// Found anew by other settings; a boundary moved; one cycle made two, two made one, several made several;
/// left out, taken whatever is wrong with it, and neither any more.
inline constexpr std::array<std::string_view, 9> cycle_change_kinds{
    "found", "begin", "end", "split", "merged", "divided", "left_out", "taken", "as_found"};

/// A whole recording in memory, one vector a dataset. Arrays of N x D are row-major. Time, tick, position and
/// velocity have N rows; any other may be empty and is then left out of the file.
struct Recording {
  Header header;
  std::vector<Axis> axes;
  std::vector<double> time;             ///< [s] from the start
  std::vector<std::uint64_t> tick;      ///< a jump is a gap
  std::vector<double> position;         ///< N x D
  std::vector<double> velocity;         ///< N x D
  std::vector<double> force_commanded;  ///< N x D; empty if nothing was commanded
  std::vector<double> force_measured;   ///< N x D; empty without a sensor
  std::vector<float> wake_latency;      ///< [s]; these four are empty in an import
  std::vector<float> read_time;
  std::vector<float> compute_time;
  std::vector<float> write_time;
  std::vector<std::uint32_t> flags;
  std::vector<Channel> channels;  ///< further channels by name
  std::vector<Event> events;
  std::optional<Cycles> cycles;
  std::optional<CycleFlags> cycle_flags;  ///< none: nobody has looked
  std::vector<CycleChange> cycle_edits;   ///< in `/cycle_edits`, the oldest first; empty: nobody edited them

  [[nodiscard]] std::size_t rows() const noexcept { return time.size(); }
  [[nodiscard]] std::size_t dimensions() const noexcept { return axes.size(); }
};

/// One row as the tick hands it to a recorder: trivially copyable, axes and channels beyond the device's
/// unused.
struct Row {
  std::uint64_t tick = 0;
  double time_s = 0.0;
  std::array<double, max_axes> position{};
  std::array<double, max_axes> velocity{};
  std::array<double, max_axes> force_commanded{};
  std::array<double, max_axes> force_measured{};
  std::array<double, max_channels> channels{};
  float wake_latency_s = 0.0F;
  float read_time_s = 0.0F;
  float compute_time_s = 0.0F;
  float write_time_s = 0.0F;
  std::uint32_t flags = 0;
};

/// Reads a whole recording, also the `NAME.partial` of a writer that is still at work or has died: then the
/// rows are those that reached every dataset.
/// @throws FormatError; std::invalid_argument (the caller named it wrongly: there is no such file, or it may
/// not be read).
[[nodiscard]] Recording read_recording(const std::filesystem::path& file);

/// Writes a whole recording: to a temporary name beside `file`, then renamed, so that a half-written file
/// never stands under the final name.
/// @throws std::invalid_argument (a column whose length does not fit), std::system_error (no space, ...), and
/// as take_name() does.
void write_recording(const std::filesystem::path& file, const Recording& recording,
                     Existing existing = Existing::replace);

}  // namespace kerf::schema

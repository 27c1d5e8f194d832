#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording_file.h>

#include "segment/cycle_edit.h"
#include "views/recording_view.h"

namespace kerf::bench {

/// Cycles are found and mended while somebody waits: of recordings of up to so many rows.
inline constexpr std::uint64_t max_rows_mended = 5'000'000;

/// What a page asks to see of the cycles of a recording.
struct CycleQuestion {
  std::size_t axis = 0;
  CycleEdit edit;
  std::optional<CycleStep> step;  ///< to be put on top of the edit
  std::uint32_t loop = 0;         ///< the cycle whose force over position is wanted; 0: none
};

/// {"axis", "settings": null or {"prominence", "corner_hz", "dwell", "closing"}, "phases": [[cycle, phase,
/// begin, end], ...], "said": [{"cycle", "kind", "reason"}], "step": {"kind": "split" or "merge", "cycle",
/// "row"}, "loop"}; all but the axis may be left out.
/// Without settings the cycles are those stored; where there are none, those that are found by themselves.
/// @throws RequestError 400.
[[nodiscard]] CycleQuestion cycle_question(const nlohmann::json& given, const schema::Recording& about);

/// Which cycles a recording has now: changes with whatever is said of them, and with the recording.
[[nodiscard]] std::string cycles_version(const schema::RecordingFile& file);

/// Why its cycles cannot be kept in it; empty where they can.
[[nodiscard]] std::string why_not_mended(const schema::RecordingFile& file,
                                         const std::filesystem::path& path);

/// The force from which contact is told along an axis.
[[nodiscard]] double felt_along(const schema::Recording& about, std::size_t axis);

/// Cycles as asked for:
///
///     {"version", "stored": they are those in the file, "locked": why_not_mended(), "axis", "rows",
///      "settings", "closing_direction", "contact_position", "why_none",
///      "phases": [[cycle, phase, begin, end, begin_s, end_s], ...]: rows [begin, end) and their times,
///      "cycles": [{"number", "good", "accepted", "flags": [{"kind", "reason"}], "peak", "work"}],
///      "said": [{"cycle", "kind", "reason"}], "average": {"position", "closing", "opening"},
///      "loop": {"cycle", "position", "force"} or null, "edits": [{"time", "author", "what"}]}
///
/// @throws as edited_cycles(), but for a recording without any cycle, which "why_none" tells.
[[nodiscard]] nlohmann::ordered_json cycle_view(RecordingView& recording, const std::filesystem::path& path,
                                                const CycleQuestion& question);

}  // namespace kerf::bench

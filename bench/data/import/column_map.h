#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/text/text_layout.h"
#include "poses/orientation_form.h"
#include "units/units.h"

namespace kerf::bench {

/// One entry of `--map`: which column of a text file becomes which channel.
struct MapEntry {
  std::string
      channel;         ///< "time", "position", "force", "velocity", "force_commanded", or a name of one's own
  std::string column;  ///< 1-based number or header name, or FIRST:LAST of an entry of several columns
  std::string unit;    ///< as given in brackets; empty if not given
  std::size_t number = 0;                      ///< of the column where it is known, from 1
  std::optional<OrientationForm> orientation;  ///< of the channel "orientation"
  std::string frame;                           ///< "sensor" or "world", of a wrench
};

/// Reads `time=5[ms],position=4[deg],force=2[gf]`. Header names may stand in double quotes, and must if they
/// hold a comma or stand in FIRST:LAST with a colon; the last pair of square brackets outside quotes is the
/// unit. In space: `position=2:4[mm],orientation=5:8[quaternion xyzw],wrench=9:14[N N·m sensor]`, or
/// `position.x=2[mm]`, `force.x=9[N sensor]`, `torque.x=12[N·m sensor]`.
/// @throws std::invalid_argument that quotes the entry and shows how one is written.
[[nodiscard]] std::vector<MapEntry> parse_map(std::string_view text);

/// An entry matched with a file.
struct MappedColumn {
  std::string channel;
  std::size_t index = 0;  ///< column, from 0
  Unit unit;
  std::string unit_text;  ///< the unit as the map or the file writes it
  bool unit_from_file = false;
};

/// The kinds of unit, in SI, that a channel of the schema may have; empty for a channel of one's own.
[[nodiscard]] std::vector<std::string_view> kinds_of(std::string_view channel);

/// Units to choose from for a channel; all there are for one of one's own.
[[nodiscard]] std::vector<std::string> usual_units_of(std::string_view channel);

/// The place of the column that an entry names, from 0. @throws std::invalid_argument if there is none, or
/// two have its name.
[[nodiscard]] std::size_t find_column(const MapEntry& entry, const TextLayout& layout,
                                      const std::string& name);

/// Matches the entries with the columns that a file has, one or several an entry.
/// @throws std::invalid_argument for a column that does not exist, a unit that is neither given nor in the
///         file, a unit of the wrong kind, forces in units that do not fit each other, or no position.
[[nodiscard]] std::vector<MappedColumn> match_columns(const std::vector<MapEntry>& entries,
                                                      const TextLayout& layout, const std::string& name);

/// The columns of a file, one a line: number, heading, unit and first values.
[[nodiscard]] std::string describe_columns(const TextLayout& layout, std::string_view text);

}  // namespace kerf::bench

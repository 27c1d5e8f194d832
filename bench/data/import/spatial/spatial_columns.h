#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/column_map.h"
#include "import/text/text_layout.h"
#include "poses/orientation_form.h"

namespace kerf::bench {

/// What a map says of axes in space beside their columns.
struct SpatialMap {
  std::optional<OrientationForm> orientation;  ///< none: the axes are x, y, z alone
  std::string frame;                           ///< "sensor" or "world" of the wrench; empty without one
  bool has_force = false;
  bool has_torque = false;
};

/// "position.x", "force.z" or "torque.y": one of a vector.
[[nodiscard]] bool is_spatial_part(std::string_view channel);

/// Whether a column of the file goes into the axes x to rz, and not into a channel of its own.
[[nodiscard]] bool is_spatial(std::string_view channel);

/// Takes what is no unit off the brackets of an entry: the form of an orientation, the frame of a wrench.
/// @throws std::invalid_argument for an orientation without its form.
void take_spatial_words(MapEntry& entry);

/// Entries of one column each for those of several: `orientation=5:8` becomes orientation.1 to .4,
/// `wrench=9:14` force.x to torque.z, `position=2:4` position.x to .z; others stay.
/// @throws std::invalid_argument for columns that are not as many as it takes.
[[nodiscard]] std::vector<MapEntry> entries_of_one_column(const std::vector<MapEntry>& entries,
                                                          const TextLayout& layout, const std::string& name);

/// What the map says of axes in space; nothing if it maps one axis.
/// @throws std::invalid_argument for a wrench without its frame, a part of a vector without the others, or
///         what does not go together with axes in space.
[[nodiscard]] std::optional<SpatialMap> spatial_map_of(const std::vector<MapEntry>& entries,
                                                       const std::vector<MappedColumn>& columns);

}  // namespace kerf::bench

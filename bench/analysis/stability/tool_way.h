#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/models/motion.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// Straight way of a tool through the axes of a law that acts on several:
///
///     p_i = from_i + direction_i s,   F = sum of force_share_i f_i
///
/// s is the travel [m] and F the force along it, so that F s' is the power of all axes: direction_i is the
/// share of the axis over its lever, force_share_i the share, and the squares of the shares add up to 1.
struct ToolWay {
  models::AxisValues from{};
  models::AxisValues direction{};
  models::AxisValues force_share{};
};

/// A way as somebody asks for it.
struct WayRequest {
  std::vector<std::string> along;  ///< AXIS=SHARE, of the law's axes
  std::vector<std::string> from;   ///< AXIS=POSITION; zero where nothing is said
};

/// Of whom axis_values() speaks where it refuses.
struct AxisValuesIn {
  const char* option;
  const char* whose;
};
/// Numbers given as AXIS=NUMBER, one for each name; zero where nothing is said.
/// @throws std::invalid_argument for a text that is not AXIS=NUMBER, or another axis.
[[nodiscard]] std::vector<double> axis_values(const std::vector<std::string>& names,
                                              const std::vector<std::string>& given, const AxisValuesIn& in);

/// A way, and the axis of the device that has most of it: its mass, friction and encoder are taken for those
/// along the way.
struct PlacedWay {
  ToolWay way;
  std::size_t device_axis = 0;
};

/// @throws std::invalid_argument: no direction, a text that is not AXIS=NUMBER, an axis that the law or the
///         device has not, lengths and angles in one direction.
[[nodiscard]] PlacedWay place_way(const WayRequest& request, const LawFile& law,
                                  const drivers::DeviceInfo& device);

}  // namespace kerf::bench

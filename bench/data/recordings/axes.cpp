#include "recordings/axes.h"

#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {

std::size_t find_axis(const schema::Recording& recording, const std::string& name) {
  if (name.empty()) return 0;
  std::string known;
  for (std::size_t axis = 0; axis < recording.dimensions(); ++axis) {
    if (recording.axes[axis].name == name) return axis;
    known += (axis > 0 ? ", " : "") + recording.axes[axis].name;
  }
  throw std::invalid_argument(fmt::format("the recording has no axis '{}'; it has {}", name, known));
}

std::size_t find_cut_axis(const schema::Recording& recording, const std::string& name) {
  return name.empty() && recording.cycles ? recording.cycles->axis : find_axis(recording, name);
}

std::vector<schema::Axis> axes_of(const drivers::DeviceInfo& device) {
  std::vector<schema::Axis> axes;
  for (const drivers::AxisInfo& axis : device.axes) {
    axes.push_back({.name = axis.name,
                    .position_unit = axis.position_unit,
                    .force_unit = axis.force_unit,
                    .lever = axis.lever});
  }
  return axes;
}

}  // namespace kerf::bench

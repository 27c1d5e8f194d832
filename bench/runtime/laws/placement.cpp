#include "laws/placement.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

/// Before what does not fit.
std::string file_of(const LawFile& law) { return law.name.empty() ? std::string() : law.name + ": "; }

}  // namespace

std::size_t axis_for(const LawFile& law, const drivers::DeviceInfo& device) {
  const auto fits = [&](const drivers::AxisInfo& axis) {
    return axis.position_unit == law.position_unit && axis.force_unit == law.force_unit;
  };
  for (std::size_t axis = 0; axis < device.axes.size(); ++axis) {
    if (device.axes[axis].name != law.axis) continue;
    if (fits(device.axes[axis])) return axis;
    throw std::invalid_argument(fmt::format("{}the law gives {} over {}, but axis '{}' of {} has {} over {}",
                                            file_of(law), law.force_unit, law.position_unit, law.axis,
                                            device.model, device.axes[axis].force_unit,
                                            device.axes[axis].position_unit));
  }
  for (std::size_t axis = 0; axis < device.axes.size(); ++axis) {
    if (fits(device.axes[axis])) return axis;
  }
  throw std::invalid_argument(fmt::format("{}the law gives {} over {}, and no axis of {} has these units",
                                          file_of(law), law.force_unit, law.position_unit, device.model));
}

std::vector<std::size_t> axes_for(const LawFile& law, const drivers::DeviceInfo& device) {
  if (!law.law.is_spatial()) return {axis_for(law, device)};
  std::vector<std::size_t> axes;
  for (const models::LawAxis& wanted : law.law.axes()) {
    std::size_t axis = 0;
    while (axis < device.axes.size() && device.axes[axis].name != wanted.name) ++axis;
    if (axis == device.axes.size()) {
      throw std::invalid_argument(fmt::format("{}law '{}' acts on axis '{}', and {} has none of that name",
                                              file_of(law), law.law.model(), wanted.name, device.model));
    }
    const drivers::AxisInfo& found = device.axes[axis];
    if (found.position_unit != wanted.position_unit || found.force_unit != wanted.force_unit) {
      throw std::invalid_argument(
          fmt::format("{}law '{}' gives {} over {} on axis '{}', but {} has {} over {} there", file_of(law),
                      law.law.model(), wanted.force_unit, wanted.position_unit, wanted.name, device.model,
                      found.force_unit, found.position_unit));
    }
    axes.push_back(axis);
  }
  return axes;
}

std::vector<std::size_t> named_axes_for(const LawFile& law, const drivers::DeviceInfo& device) {
  const auto is_its_own = [&](const drivers::AxisInfo& axis) { return axis.name == law.axis; };
  if (law.law.is_spatial() || std::ranges::any_of(device.axes, is_its_own)) return axes_for(law, device);
  std::string all;
  for (const drivers::AxisInfo& axis : device.axes)
    all += fmt::format("{}'{}' ({} over {})", all.empty() ? "" : ", ", axis.name, axis.force_unit,
                       axis.position_unit);
  throw std::invalid_argument(fmt::format(
      "{}the law is for axis '{}' ({} over {}), and {} has {}; a law for another axis has its name "
      "as 'axis' in its file",
      file_of(law), law.axis, law.force_unit, law.position_unit, device.model, all));
}

std::vector<models::LawAxis> axes_of(const LawFile& law) {
  if (law.law.is_spatial()) return law.law.axes();
  return {{law.axis.empty() ? "position" : law.axis, law.position_unit, law.force_unit}};
}

std::vector<std::size_t> own_axes(const LawFile& law) {
  std::vector<std::size_t> axes(axes_of(law).size());
  std::iota(axes.begin(), axes.end(), 0);
  return axes;
}

}  // namespace kerf::bench

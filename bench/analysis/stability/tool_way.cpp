#include "stability/tool_way.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

#include "laws/placement.h"

namespace kerf::bench {
namespace {

/// Numbers given as AXIS=NUMBER, on the law's axes.
models::AxisValues values_on(const std::vector<models::LawAxis>& axes, const std::vector<std::string>& given,
                             const char* option) {
  models::AxisValues values{};
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const std::string_view digits =
        std::string_view(text).substr(equals == std::string::npos ? 0 : equals + 1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (equals == std::string::npos || error != std::errc{} || end != digits.data() + digits.size() ||
        !std::isfinite(number)) {
      throw std::invalid_argument(fmt::format("{} '{}': expected AXIS=NUMBER, such as z=-1", option, text));
    }
    std::size_t axis = 0;
    while (axis < axes.size() && axes[axis].name != text.substr(0, equals)) ++axis;
    if (axis == axes.size()) {
      throw std::invalid_argument(
          fmt::format("{} '{}': the law has no such axis; it has {}", option, text, names_in(axes)));
    }
    values[axis] = number;
  }
  return values;
}

void check_units(const models::AxisValues& share, const std::vector<models::LawAxis>& axes,
                 std::size_t most) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (share[i] == 0.0 || axes[i].position_unit == axes[most].position_unit) continue;
    throw std::invalid_argument(fmt::format("--along: '{}' is in {} and '{}' in {}; a direction has one unit",
                                            axes[most].name, axes[most].position_unit, axes[i].name,
                                            axes[i].position_unit));
  }
}

}  // namespace

PlacedWay place_way(const WayRequest& request, const LawFile& law, const drivers::DeviceInfo& device) {
  const std::vector<models::LawAxis> axes = law.law.axes();
  const std::vector<std::size_t> places = axes_for(law, device);
  const models::AxisValues share = values_on(axes, request.along, "--along");
  std::size_t most = 0;
  double square = 0.0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    square += share[i] * share[i];
    if (std::abs(share[i]) > std::abs(share[most])) most = i;
  }
  if (!(square > 0.0)) {
    throw std::invalid_argument(
        fmt::format("law '{}' acts on several axes at once; give a direction, --along AXIS=SHARE, of {}",
                    law.law.model(), names_in(axes)));
  }
  check_units(share, axes, most);
  PlacedWay placed{.way = {.from = values_on(axes, request.from, "--from")}, .device_axis = places[most]};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    placed.way.force_share[i] = share[i] / std::sqrt(square);
    placed.way.direction[i] = placed.way.force_share[i] / device.axes[places[i]].lever;
  }
  return placed;
}

}  // namespace kerf::bench

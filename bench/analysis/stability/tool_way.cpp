#include "stability/tool_way.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "laws/placement.h"

namespace kerf::bench {
namespace {

models::AxisValues values_on(const std::vector<models::LawAxis>& axes, const std::vector<std::string>& given,
                             const char* option) {
  std::vector<std::string> names;
  for (const models::LawAxis& axis : axes) names.push_back(axis.name);
  models::AxisValues values{};
  std::ranges::copy(axis_values(names, given, {.option = option, .whose = "the law"}), values.begin());
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

std::vector<double> axis_values(const std::vector<std::string>& names, const std::vector<std::string>& given,
                                const AxisValuesIn& in) {
  std::vector<double> values(names.size(), 0.0);
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const std::string_view digits =
        std::string_view(text).substr(equals == std::string::npos ? 0 : equals + 1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (equals == std::string::npos || error != std::errc{} || end != digits.data() + digits.size() ||
        !std::isfinite(number)) {
      throw std::invalid_argument(
          fmt::format("{} '{}': expected AXIS=NUMBER, such as z=-1", in.option, text));
    }
    const auto named = std::ranges::find(names, text.substr(0, equals));
    if (named == names.end()) {
      throw std::invalid_argument(fmt::format("{} '{}': {} has no such axis; it has {}", in.option, text,
                                              in.whose, fmt::join(names, ", ")));
    }
    values[static_cast<std::size_t>(named - names.begin())] = number;
  }
  return values;
}

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

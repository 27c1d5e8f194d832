#include "stability/several/several_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "files/json_number.h"
#include "html/html.h"
#include "stability/conditions.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json rows_of(const Eigen::MatrixXd& matrix) {
  json rows = json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    json numbers = json::array();
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) numbers.push_back(matrix(row, column));
    rows.push_back(std::move(numbers));
  }
  return rows;
}

json device_of(const DirectionMap& map) {
  const SampledAxes& device = map.axes.device;
  return {{"mass_kg", rows_of(device.mass)},
          {"viscous_n_s_per_m", rows_of(device.damping)},
          {"period_s", device.period_s},
          {"delay_s", device.delay_s},
          {"velocity_corner_rad_s", device.velocity_corner_rad_s},
          {"hand",
           {{"mass_kg", rows_of(map.axes.hand_mass)},
            {"damping_n_s_per_m", rows_of(map.axes.hand_damping)},
            {"stiffness_n_per_m", rows_of(map.axes.hand_stiffness)}}}};
}

std::string stiffness_in_words(double stiffness, const Range& searched) {
  if (stiffness <= 0.0) return fmt::format("at none from {:.4g} N/m on", searched.begin);
  if (stiffness >= searched.end) return fmt::format("to {:.4g} N/m, all that was tried", searched.end);
  return fmt::format("to {:.4g} N/m", stiffness);
}

std::string degrees(double angle_rad) {
  return fmt::format("{:.0f} deg", angle_rad * 180.0 / std::numbers::pi);
}

std::vector<std::string> lines_of(const DirectionMap& map) {
  const auto by = [](double DirectionBoundary::*value) {
    return [value](const DirectionBoundary& a, const DirectionBoundary& b) { return a.*value < b.*value; };
  };
  const auto [weakest, stiffest] =
      std::ranges::minmax_element(map.boundaries, by(&DirectionBoundary::eigenvalues));
  std::vector<std::string> lines;
  const std::size_t turn = ticks_of_a_turn(map.shape, map.axes.device.period_s);
  if (map.shape.turns()) {
    lines.push_back(fmt::format("turning, {} ticks a turn: stable {}", turn,
                                stiffness_in_words(weakest->eigenvalues, map.searched)));
  } else {
    lines.push_back(fmt::format("least stable at {}: {}; most at {}: {}", degrees(weakest->angle_rad),
                                stiffness_in_words(weakest->eigenvalues, map.searched),
                                degrees(stiffest->angle_rad),
                                stiffness_in_words(stiffest->eigenvalues, map.searched)));
  }
  const auto least_sufficient = std::ranges::min_element(map.boundaries, by(&DirectionBoundary::sufficient));
  const auto least_passive = std::ranges::min_element(map.boundaries, by(&DirectionBoundary::passive));
  lines.push_back(fmt::format(
      "in every direction the sufficient condition holds in this hand {}; {}",
      stiffness_in_words(least_sufficient->sufficient, map.searched),
      map.shape.turns() ? "what turns is passive at no stiffness: the motor of the tool may give energy"
                        : fmt::format("passive, in any hand, {}",
                                      stiffness_in_words(least_passive->passive, map.searched))));
  double lowest = std::numeric_limits<double>::infinity();
  double highest = 0.0;
  for (const DirectionBoundary& at : map.boundaries) {
    if (!(at.eigenvalues > 0.0) || at.eigenvalues >= map.searched.end) continue;
    lowest = std::min(lowest, at.one_axis / at.eigenvalues);
    highest = std::max(highest, at.one_axis / at.eigenvalues);
  }
  if (highest > 0.0) {
    lines.push_back(fmt::format("one axis alone, along the direction, says {:.3g} to {:.3g} times as much",
                                lowest, highest));
  }
  lines.push_back(fmt::format("the simulated boundary is within {:.1e} of the eigenvalues, as a share",
                              map.boundary_error()));
  for (std::string& line : in_words(several_conditions)) lines.push_back(std::move(line));
  return lines;
}

/// Distance from the middle of a stiffness.
struct Radius {
  bool logarithmic = false;
  double unit = 1.0;  ///< stiffness at the middle of a logarithmic picture, else 1
  [[nodiscard]] double of(double stiffness) const {
    if (!(stiffness > 0.0)) return line_break;
    if (!logarithmic) return stiffness;
    return stiffness > unit ? std::log10(stiffness / unit) : 0.0;
  }
};

struct DirectionCurve {
  const char* key;
  const char* label;
  Colour colour;
  Mark mark;
  bool dashed;
};
constexpr std::array direction_curves{
    DirectionCurve{"eigenvalues", "eigenvalues, all axes", Colour::black, Mark::line, false},
    DirectionCurve{"simulated", "simulated", Colour::vermillion, Mark::points, false},
    DirectionCurve{"one_axis", "one axis alone", Colour::blue, Mark::line, true},
    DirectionCurve{"sufficient", "sufficient, in this hand", Colour::green, Mark::line, false},
    DirectionCurve{"passive", "passive, in any hand", Colour::purple, Mark::line, false}};

Radius radius_of(const json& boundaries) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const json& at : boundaries) {
    for (const DirectionCurve& curve : direction_curves) {
      const double value = number_from(at.at(curve.key));
      if (value > 0.0) least = std::min(least, value);
      if (value > 0.0) most = std::max(most, value);
    }
  }
  if (!(most > 10.0 * least)) return {};
  return {.logarithmic = true, .unit = std::pow(10.0, std::floor(std::log10(least)) - 0.5)};
}

}  // namespace

Findings findings_of(const DirectionMap& map, const StudiedAxis& on) {
  Findings found;
  json boundaries = json::array();
  found.csv =
      "angle_rad,eigenvalues_n_per_m,simulated_n_per_m,sufficient_n_per_m,passive_n_per_m,one_axis_n_per_m\n";
  std::vector<std::vector<std::string>> table{{"direction", "eigenvalues [N/m]", "simulated",
                                               "sufficient, this hand", "passive, any hand",
                                               "one axis alone"}};
  const std::size_t every = std::max<std::size_t>(1, map.boundaries.size() / 12);
  for (const DirectionBoundary& at : map.boundaries) {
    boundaries.push_back({{"angle_rad", at.angle_rad},
                          {"eigenvalues", at.eigenvalues},
                          {"simulated", at.simulated},
                          {"sufficient", at.sufficient},
                          {"passive", at.passive},
                          {"one_axis", at.one_axis}});
    found.csv += fmt::format("{:.8g},{:.10g},{:.10g},{:.8g},{:.8g},{:.8g}\n", at.angle_rad, at.eigenvalues,
                             at.simulated, at.sufficient, at.passive, at.one_axis);
    if (static_cast<std::size_t>(&at - map.boundaries.data()) % every != 0) continue;
    std::vector<std::string> row{degrees(at.angle_rad)};
    for (const double value : {at.eigenvalues, at.simulated, at.sufficient, at.passive, at.one_axis})
      row.push_back(value > 0.0 ? fmt::format("{:.4g}", value) : "none");
    table.push_back(std::move(row));
  }
  const auto name = [&](Eigen::Index axis) { return map.axes.names[static_cast<std::size_t>(axis)]; };
  found.json = {
      {"study", "several"},
      {"on", {{"device", on.device_uri}, {"axes", map.axes.names}, {"grip", on.grip}, {"from", on.way.from}}},
      {"device", device_of(map)},
      {"wall",
       {{"shape", rows_of(map.shape.wall.stiffness)},
        {"damping_n_s_per_m", rows_of(map.shape.wall.damping)},
        {"plane", {name(map.shape.first_axis), name(map.shape.second_axis)}},
        {"rotation_rad_s", map.shape.rate_rad_s},
        {"drags", map.shape.drags},
        {"ticks_of_a_turn", ticks_of_a_turn(map.shape, map.axes.device.period_s)}}},
      {"searched", {map.searched.begin, map.searched.end}},
      {"boundary_error", map.boundary_error()},
      {"conditions", to_json(several_conditions)},
      {"boundaries", std::move(boundaries)}};
  found.lines = lines_of(map);
  found.json["in_words"] = found.lines;
  found.figures.push_back({"directions", direction_picture(found.json)});
  found.html = "<h2>Boundaries</h2>\n" + html_table(table);
  return found;
}

Chart direction_picture(const json& study) {
  const json& boundaries = study.at("boundaries");
  const json& plane = study.at("wall").at("plane");
  const Radius radius = radius_of(boundaries);
  const auto axis_label = [&](std::size_t at) {
    return fmt::format("stiffness along {} [N/m]{}", plane.at(at).get<std::string>(),
                       radius.logarithmic ? ", logarithm of the distance" : "");
  };
  Chart chart{.title = "Stiffest stable wall by its direction",
              .x_label = axis_label(0),
              .y_label = axis_label(1),
              .legend_below = true,
              .width_px = 760,
              .height_px = 860};
  double most = 0.0;
  for (const DirectionCurve& about : direction_curves) {
    Curve curve{.label = about.label,
                .x = {},
                .y = {},
                .colour = about.colour,
                .mark = about.mark,
                .width = about.mark == Mark::points ? 3.0 : 2.0,
                .dashed = about.dashed,
                .of = {}};
    bool seen = false;
    const std::size_t count = boundaries.size();
    for (std::size_t i = 0; i <= 2 * count; ++i) {  // a wall is the same from behind
      const json& at = boundaries.at(i % count);
      const double angle =
          number_from(at.at("angle_rad")) + (i >= count && i < 2 * count ? std::numbers::pi : 0.0);
      const double distance = radius.of(number_from(at.at(about.key)));
      seen = seen || std::isfinite(distance);
      if (std::isfinite(distance)) most = std::max(most, distance);
      curve.x.push_back(distance * std::cos(angle));
      curve.y.push_back(distance * std::sin(angle));
    }
    if (seen) chart.curves.push_back(std::move(curve));
  }
  const double reach = 1.08 * (most > 0.0 ? most : 1.0);
  chart.x_range = chart.y_range = {.begin = -reach, .end = reach};
  if (!radius.logarithmic) return chart;
  for (double stiffness = std::pow(10.0, std::ceil(std::log10(radius.unit))); radius.of(stiffness) < reach;
       stiffness *= 10.0) {
    for (const double side : {-1.0, 1.0}) {
      const NamedTick tick{.at = side * radius.of(stiffness), .name = fmt::format("{:.6g}", stiffness)};
      chart.x_ticks.push_back(tick);
      chart.y_ticks.push_back(tick);
    }
  }
  return chart;
}

}  // namespace kerf::bench

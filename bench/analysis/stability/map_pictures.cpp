#include "stability/map_pictures.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "files/json_number.h"
#include "stability/controllers/controllers_findings.h"
#include "stability/plane/plane_findings.h"
#include "stability/several/several_findings.h"
#include "stability/zwidth/z_width_findings.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// Where the cells of a row or column begin and end: half-way between their middles.
std::vector<double> edges_of(const std::vector<double>& middles, bool logarithmic_scale) {
  std::vector<double> edges;
  const auto between = [&](double a, double b) {
    return logarithmic_scale ? std::sqrt(a * b) : 0.5 * (a + b);
  };
  edges.push_back(middles.front());
  for (std::size_t i = 1; i < middles.size(); ++i) edges.push_back(between(middles[i - 1], middles[i]));
  edges.push_back(middles.back());
  return edges;
}

/// Cells by what they did, with a dot where theory says otherwise.
Cells cells_of(const std::vector<Cell>& cells, const std::string& held, const std::string& broke) {
  const std::string otherwise = ", theory says otherwise";
  Cells drawn{.kinds = {{Colour::sky, held},
                        {Colour::orange, broke},
                        {Colour::sky, held + otherwise, true},
                        {Colour::orange, broke + otherwise, true}}};
  for (const Cell& cell : cells)
    drawn.kind.push_back((cell.stable ? 0U : 1U) + (cell.stable == cell.theory ? 0U : 2U));
  return drawn;
}

Curve boundary(const WallMap& map, const char* label, Colour colour, double WallBoundary::*value) {
  Curve curve{.label = label, .colour = colour, .width = 2.0};
  for (const WallBoundary& at : map.boundaries) {
    const bool drawn = at.*value > map.grid.first.front() && at.*value < map.grid.first.back();
    curve.x.push_back(at.damping_n_s_per_m);
    curve.y.push_back(drawn ? at.*value : line_break);
  }
  return curve;
}

/// The grid of cells as they were written, row by row, and what came of each.
template <typename Map>
void read_cells(const json& cells, const char* first, const char* second, Map& map) {
  for (const json& cell : cells) {
    const auto column = cell.at(first).get<double>();
    const auto row = cell.at(second).get<double>();
    if (map.grid.second.empty() || map.grid.second.back() != row) map.grid.second.push_back(row);
    if (map.grid.second.size() == 1) map.grid.first.push_back(column);
    map.cells.push_back({cell.at("stable").get<bool>(), cell.at("theory").get<bool>()});
  }
  if (map.cells.size() != map.grid.first.size() * map.grid.second.size())
    throw std::invalid_argument(fmt::format("{} cells are no {} columns and {} rows", map.cells.size(),
                                            map.grid.first.size(), map.grid.second.size()));
}

WallMap wall_map_of(const json& study) {
  WallMap map{.abbott_okamura = number_from(study.at("abbott_okamura"))};
  read_cells(study.at("cells"), "K", "B", map);
  for (const json& at : study.at("boundaries")) {
    map.boundaries.push_back({.damping_n_s_per_m = number_from(at.at("B")),
                              .simulated = number_from(at.at("simulated")),
                              .simulated_linear = number_from(at.at("simulated_linear")),
                              .eigenvalues = number_from(at.at("eigenvalues")),
                              .colgate_schenkel = number_from(at.at("colgate_schenkel")),
                              .passive = number_from(at.at("passive"))});
  }
  return map;
}

LawMap law_map_of(const json& study) {
  LawMap map{.speed_m_s = study.at("range").at("speed_m_s").get<double>()};
  map.device.period_s = study.at("device").at("period_s").get<double>();
  read_cells(study.at("cells"), "depth_m", "rate_hz", map);
  return map;
}

}  // namespace

Chart picture_of(const WallMap& map, const TravelUnits& units) {
  Chart chart{.title = "Virtual wall: where it comes to rest",
              .x_label = fmt::format("damping of the wall B [{}]", units.damping()),
              .y_label = fmt::format("stiffness of the wall K [{}]", units.stiffness()),
              .cells = cells_of(map.cells, "comes to rest", "does not"),
              .x_range = {map.grid.second.front(), map.grid.second.back()},
              .y_range = {map.grid.first.front(), map.grid.first.back()},
              .log_y = true,
              .legend_below = true,
              .width_px = 1000,
              .height_px = 560};
  chart.cells.x_edges = edges_of(map.grid.second, false);
  chart.cells.y_edges = edges_of(map.grid.first, true);
  chart.cells.upwards = true;
  chart.curves = {boundary(map, "eigenvalues", Colour::black, &WallBoundary::eigenvalues),
                  boundary(map, "simulated, linear", Colour::vermillion, &WallBoundary::simulated_linear),
                  boundary(map, "simulated, as it is", Colour::blue, &WallBoundary::simulated),
                  boundary(map, "passive, with filter and delay", Colour::green, &WallBoundary::passive),
                  boundary(map, "Colgate and Schenkel", Colour::purple, &WallBoundary::colgate_schenkel)};
  chart.curves[1].mark = Mark::points;
  chart.curves[1].width = 3.0;
  chart.curves[4].dashed = true;
  chart.horizontal.push_back({.at = map.abbott_okamura, .label = "Abbott and Okamura (B = 0)"});
  return chart;
}

Chart picture_of(const std::string& model, const LawMap& map, const TravelUnits& units) {
  const ShownIn shown = units.depth();
  std::vector<double> depths = map.grid.first;
  for (double& depth : depths) depth *= shown.factor;
  const std::vector<double>& rates = map.grid.second;
  Chart chart{.title = fmt::format("{}: where strokes of up to {:.3g} {} are given no energy", model,
                                   map.speed_m_s, units.speed()),
              .x_label = fmt::format("depth, in travel of the device [{}]", shown.unit),
              .y_label = "sampling rate [Hz]",
              .cells = cells_of(map.cells, "passive", "gains energy"),
              .x_range = {depths.front(), depths.back()},
              .y_range = {rates.front(), rates.back()},
              .log_y = true,
              .legend_below = true,
              .width_px = 1000,
              .height_px = 480};
  chart.cells.x_edges = edges_of(depths, false);
  chart.cells.y_edges = edges_of(rates, true);
  Curve theory{.label = "local stiffness = passive stiffness", .colour = Colour::black, .width = 2.0};
  const std::size_t columns = depths.size();
  for (std::size_t row = 0; row < rates.size(); ++row) {
    const auto begin = map.cells.begin() + static_cast<std::ptrdiff_t>(row * columns);
    const auto beyond = std::find_if(begin, begin + static_cast<std::ptrdiff_t>(columns),
                                     [](const Cell& cell) { return !cell.theory; });
    const auto at = static_cast<std::size_t>(beyond - begin);
    theory.x.push_back(at == 0 || at == columns ? line_break : 0.5 * (depths[at - 1] + depths[at]));
    theory.y.push_back(rates[row]);
  }
  chart.curves.push_back(std::move(theory));
  chart.horizontal.push_back({.at = 1.0 / map.device.period_s, .label = "this device"});
  return chart;
}

std::optional<Chart> map_picture(const json& study) {
  const std::string of = study.value("study", "");
  if (of == "several") return direction_picture(study);
  if (of == "z_width") return z_width_picture(study);
  if (of == "controllers") return controllers_picture(study);
  if (!study.contains("cells") || study.at("cells").empty()) return std::nullopt;
  if (of == "plane") return plane_picture(study);
  if (of == "wall") {
    const TravelUnits units(study);
    Chart chart = picture_of(wall_map_of(study), units);
    const auto own = study.at("on").at("damping_n_s_per_m").get<double>();
    chart.vertical.push_back(
        {.at = own,
         .label = fmt::format("the device's own damping: {:.3g} {}", own, units.damping()),
         .label_after = true});
    return chart;
  }
  const TravelUnits units(study);
  const ShownIn shown = units.depth();
  Chart chart = picture_of(study.at("law").get<std::string>(), law_map_of(study), units);
  const double asked = shown.factor * study.at("range").at("depth_m").get<double>();
  chart.vertical.push_back(
      {.at = asked, .label = fmt::format("asked for: {:.3g} {}", asked, shown.unit), .label_after = true});
  return chart;
}

}  // namespace kerf::bench

#include "stability/plane/plane_findings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
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

/// Edges of cells whose middles are in equal steps of the logarithm.
std::vector<double> logarithmic_edges(const std::vector<double>& middles) {
  std::vector<double> edges{middles.front()};
  for (std::size_t i = 1; i < middles.size(); ++i) edges.push_back(std::sqrt(middles[i - 1] * middles[i]));
  edges.push_back(middles.back());
  return edges;
}

Colour colour_of(PlaneBehaviour behaviour) {
  switch (behaviour) {
    case PlaneBehaviour::dies_away:
      return Colour::sky;
    case PlaneBehaviour::locked:
      return Colour::green;
    case PlaneBehaviour::small_cycle:
      return Colour::yellow;
    case PlaneBehaviour::cycle:
      return Colour::orange;
    case PlaneBehaviour::grows:
      break;
  }
  return Colour::vermillion;
}

/// Where the energy of a swing is balanced, over the rows of the grid.
json balance_of(const PlaneMap& map) {
  json balance = json::array();
  for (const double coulomb : map.grid.second) {
    balance.push_back(
        {{"viscous", swing_line(map.device, map.stiffness_n_per_m, coulomb, map.trial.far_steps)},
         {"coulomb", coulomb}});
  }
  return balance;
}

std::string in_words(const PlaneMap::Wall& wall, PlaneLines lines, const TravelUnits& units) {
  return fmt::format(
      "K = {:.4g} {} stands at b/(K T) = {:.3g}, f_c/(K delta) = {:.3g}: by the lines {}; simulated, it {}",
      wall.stiffness_n_per_m, units.stiffness(), wall.at.viscous, wall.at.coulomb,
      name_of(plane_region(wall.at, lines)),
      wall.behaviour == PlaneBehaviour::cycle || wall.behaviour == PlaneBehaviour::small_cycle
          ? fmt::format("has a {}", name_of(wall.behaviour))
          : std::string(name_of(wall.behaviour)));
}

}  // namespace

Findings findings_of(const PlaneMap& map, const StudiedAxis& on) {
  Findings found;
  const PlaneLines lines = plane_lines(map.device);
  const double period_s = map.device.period_s;
  const auto alpha = [&](double stiffness) {
    return stiffness * period_s * period_s / map.device.moving_mass_kg();
  };
  json cells = json::array();
  found.csv = "viscous,coulomb,behaviour,region\n";
  const std::size_t columns = map.grid.first.size();
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    const PlanePoint at{.viscous = map.grid.first[i % columns], .coulomb = map.grid.second[i / columns]};
    const std::string_view region = name_of(plane_region(at, lines));
    cells.push_back({{"viscous", at.viscous},
                     {"coulomb", at.coulomb},
                     {"behaviour", name_of(map.cells[i])},
                     {"region", region}});
    found.csv += fmt::format("{:.8g},{:.8g},{},{}\n", at.viscous, at.coulomb, name_of(map.cells[i]), region);
  }
  json walls = json::array();
  std::vector<std::vector<std::string>> table{{fmt::format("K [{}]", on.units.stiffness()), "b / (K T)",
                                               "f_c / (K delta)", "K T^2 / M", "by the lines", "simulated"}};
  for (const PlaneMap::Wall& wall : map.walls) {
    const std::string_view region = name_of(plane_region(wall.at, lines));
    walls.push_back({{"K", wall.stiffness_n_per_m},
                     {"viscous", wall.at.viscous},
                     {"coulomb", wall.at.coulomb},
                     {"stiffness", alpha(wall.stiffness_n_per_m)},
                     {"region", region},
                     {"behaviour", name_of(wall.behaviour)}});
    table.push_back({fmt::format("{:.4g}", wall.stiffness_n_per_m), fmt::format("{:.3g}", wall.at.viscous),
                     fmt::format("{:.3g}", wall.at.coulomb),
                     fmt::format("{:.3g}", alpha(wall.stiffness_n_per_m)), std::string(region),
                     std::string(name_of(wall.behaviour))});
    found.lines.push_back(in_words(wall, lines, on.units));
  }
  if (!map.cells.empty()) {
    found.lines.push_back(fmt::format("{:.1f} % of {} cells did what the lines say, for K T^2 / M = {:.3g}",
                                      100.0 * map.agreement(), map.cells.size(),
                                      alpha(map.stiffness_n_per_m)));
  }
  for (std::string& line : in_words(plane_conditions)) found.lines.push_back(std::move(line));
  found.json = {{"study", "plane"},
                {"on",
                 {{"device", on.device_uri},
                  {"axis", on.axis},
                  {"grip", on.grip},
                  {"rate_hz", 1.0 / period_s},
                  {"damping_n_s_per_m", map.device.viscous_n_s_per_m}}},
                {"units", as_json(on.units)},
                {"device", as_json(map.device)},
                {"stiffness_n_per_m", map.stiffness_n_per_m},
                {"stiffness", alpha(map.stiffness_n_per_m)},
                {"delay_periods", map.device.delay_s / period_s},
                {"lines", {{"viscous", lines.viscous}, {"coulomb", lines.coulomb}}},
                {"near_steps", map.trial.near_steps},
                {"far_steps", map.trial.far_steps},
                {"felt_n", map.trial.felt_n},
                {"balance_of_far_swings", balance_of(map)},
                {"agreement", map.agreement()},
                {"conditions", to_json(plane_conditions)},
                {"walls", std::move(walls)},
                {"cells", std::move(cells)}};
  found.json["in_words"] = found.lines;
  if (!map.cells.empty()) found.figures.push_back({"plane", plane_picture(found.json)});
  found.html = "<h2>Walls on the device</h2>\n" + html_table(table);
  return found;
}

Chart plane_picture(const json& study) {
  std::vector<double> viscous;
  std::vector<double> coulomb;
  Cells cells{.x_edges = {}, .y_edges = {}, .kinds = {}, .kind = {}};
  for (const PlaneBehaviour behaviour : plane_behaviours)
    cells.kinds.push_back({.colour = colour_of(behaviour), .label = std::string(name_of(behaviour))});
  for (const json& cell : study.at("cells")) {
    const auto row = cell.at("coulomb").get<double>();
    if (coulomb.empty() || coulomb.back() != row) coulomb.push_back(row);
    if (coulomb.size() == 1) viscous.push_back(cell.at("viscous").get<double>());
    cells.kind.push_back(
        static_cast<std::size_t>(plane_behaviour_named(cell.at("behaviour").get<std::string>())));
  }
  if (viscous.empty() || cells.kind.size() != viscous.size() * coulomb.size()) {
    throw std::invalid_argument(fmt::format("{} cells are no {} columns and {} rows", cells.kind.size(),
                                            viscous.size(), coulomb.size()));
  }
  cells.x_edges = logarithmic_edges(viscous);
  cells.y_edges = logarithmic_edges(coulomb);
  const double delay = number_from(study.at("delay_periods"));
  Chart chart{.title = fmt::format("A wall on a sampled device, K T^2 / M = {:.3g}{}",
                                   number_from(study.at("stiffness")),
                                   delay > 0.0 ? fmt::format(", t_d / T = {:.3g}", delay) : ""),
              .x_label = "viscous friction b / (K T) [1]",
              .y_label = "Coulomb friction f_c / (K delta) [1]",
              .cells = std::move(cells),
              .x_range = {.begin = viscous.front(), .end = viscous.back()},
              .y_range = {.begin = coulomb.front(), .end = coulomb.back()},
              .log_x = true,
              .log_y = true,
              .legend_below = true,
              .width_px = 1000,
              .height_px = 640};
  chart.vertical.push_back({.at = number_from(study.at("lines").at("viscous")),
                            .label = delay > 0.0 ? "1/2 + t_d / T" : "1/2",
                            .label_after = true});
  chart.horizontal.push_back({.at = number_from(study.at("lines").at("coulomb")), .label = "1/2"});
  Curve balance{
      .label = fmt::format("energy of swings of {:.4g} steps balanced", number_from(study.at("far_steps"))),
      .x = {},
      .y = {},
      .colour = Colour::black,
      .width = 2.0,
      .dashed = true,
      .of = {}};
  for (const json& at : study.at("balance_of_far_swings")) {
    const double x = number_from(at.at("viscous"));
    balance.x.push_back(x > viscous.front() && x < viscous.back() ? x : line_break);
    balance.y.push_back(number_from(at.at("coulomb")));
  }
  chart.curves.push_back(std::move(balance));
  Curve walls{.label = "walls on the device",
              .x = {},
              .y = {},
              .colour = Colour::black,
              .mark = Mark::circles,
              .width = 3.0,
              .of = {}};
  const std::string unit = TravelUnits(study).stiffness();
  for (const json& wall : study.at("walls")) {
    const double x = number_from(wall.at("viscous"));
    const double y = std::clamp(number_from(wall.at("coulomb")), coulomb.front(), coulomb.back());
    walls.x.push_back(x);
    walls.y.push_back(y);
    chart.labels.push_back(
        {.x = x, .y = y, .text = fmt::format("{:.4g} {}", number_from(wall.at("K")), unit), .left = false});
  }
  chart.curves.push_back(std::move(walls));
  return chart;
}

}  // namespace kerf::bench

#include "stability/findings.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "files/json_number.h"
#include "html/html.h"
#include "stability/conditions.h"
#include "stability/map_pictures.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

std::string text_of(const Limit& limit, const ShownIn& in) {
  const auto& [factor, unit] = in;
  if (limit.at) return fmt::format("{:.4g} {}", factor * *limit.at, unit);
  if (limit.holds_nowhere)
    return fmt::format("none, it fails at {:.4g} {} already", factor * limit.first, unit);
  return fmt::format("holds to {:.4g} {}, the end of the search", factor * limit.last, unit);
}

/// Of the key of a limit in JSON, which is null unless it was found.
const char* how_it_ended(const Limit& limit) {
  return limit.at ? "found" : limit.holds_nowhere ? "holds nowhere" : "holds throughout";
}

std::string device_table(const SampledDevice& device, const TravelUnits& units) {
  const auto row = [](const char* what, double value, const std::string& unit) {
    return std::vector<std::string>{what, fmt::format("{:.6g}", value), unit};
  };
  return html_table({{"device", "value", "unit"},
                     row("mass", device.mass_kg, units.mass()),
                     row("viscous friction b", device.viscous_n_s_per_m, units.damping()),
                     row("Coulomb friction", device.coulomb_n, units.force()),
                     row("encoder step", units.step().factor * device.encoder_step_m, units.step().unit),
                     row("sampling rate", 1.0 / device.period_s, "Hz"),
                     row("delay", 1e3 * device.delay_s, "ms"),
                     row("corner of the velocity filter (0: none)", device.velocity_corner_rad_s, "rad/s"),
                     row("mass of the hand", device.hand.mass_kg, units.mass()),
                     row("damping of the hand", device.hand.damping_n_s_per_m, units.damping()),
                     row("stiffness of the hand", device.hand.stiffness_n_per_m, units.stiffness())});
}

std::string stiffness_text(double stiffness, const std::vector<double>& tried, const std::string& unit) {
  if (stiffness <= tried.front())
    return fmt::format("at no stiffness from {:.4g} {} on", tried.front(), unit);
  if (stiffness >= tried.back()) return fmt::format("to {:.4g} {}, all that was tried", tried.back(), unit);
  return fmt::format("to {:.4g} {}", stiffness, unit);
}

std::string of_the_least_damping(const WallMap& map, const TravelUnits& units) {
  const std::string unit = units.stiffness();
  const WallBoundary& at = map.boundaries.front();
  const bool undamped = at.damping_n_s_per_m == 0.0;
  return fmt::format(
      "{}: stable {}, passive to {:.4g} {} (Colgate and Schenkel {:.4g}{}); passivity must hold in "
      "any hand, stability in the one that was given",
      undamped ? "without damping"
               : fmt::format("at a damping of {:.4g} {}", at.damping_n_s_per_m, units.damping()),
      stiffness_text(at.eigenvalues, map.grid.first, unit), at.passive, unit, at.colgate_schenkel,
      undamped ? fmt::format(", Abbott and Okamura {:.4g}", map.abbott_okamura) : "");
}

/// What a wall that was tried has and the eigenvalues do not know; empty of nothing.
std::string beside_the_eigenvalues(const WallMap& map) {
  std::vector<std::string> takers;
  if (map.device.encoder_step_m > 0.0) takers.emplace_back("encoder steps");
  if (map.trial.push_n > 0.0) takers.emplace_back("lifting off");
  std::vector<std::string> parts;
  if (map.device.coulomb_n > 0.0) parts.emplace_back("Coulomb friction adds");
  if (!takers.empty())
    parts.push_back(
        fmt::format("{} {} away", fmt::join(takers, " and "), takers.size() > 1 ? "take" : "takes"));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// In words what the lines say of each other.
std::vector<std::string> comparison(const WallMap& map, const TravelUnits& units) {
  std::vector<std::string> lines;
  if (!map.cells.empty()) {
    lines.push_back(fmt::format("{:.2f} % of {} cells: the wall as it was tried and the eigenvalues agree",
                                100.0 * map.agreement(), map.cells.size()));
  }
  lines.push_back(fmt::format(
      "without encoder and Coulomb friction, two-sided, the simulated boundary is within {:.2f} % of the "
      "eigenvalues",
      100.0 * map.boundary_error()));
  double least = 1e9;
  double most = 0.0;
  for (const WallBoundary& at : map.boundaries) {
    if (at.eigenvalues <= map.grid.first.front() || at.eigenvalues >= map.grid.first.back()) continue;
    least = std::min(least, at.simulated / at.eigenvalues);
    most = std::max(most, at.simulated / at.eigenvalues);
  }
  if (const std::string why = beside_the_eigenvalues(map); !why.empty() && most > 0.0) {
    lines.push_back(
        fmt::format("as it was tried it comes to rest up to {:.2f} to {:.2f} times the stiffness of the "
                    "eigenvalues: {}",
                    least, most, why));
  }
  lines.push_back(of_the_least_damping(map, units));
  for (std::string& line : in_words(wall_conditions)) lines.push_back(std::move(line));
  return lines;
}

std::string way_text(const WayRequest& way) {
  std::string text;
  for (const std::string& share : way.along) text += (text.empty() ? " along " : ", ") + share;
  for (std::size_t i = 0; i < way.from.size(); ++i) text += (i == 0 ? " from " : ", ") + way.from[i];
  return text;
}

/// Of a law that pushes nowhere along the strokes, which therefore gain nothing.
std::string never_met(const LawStudy& study, const StudiedAxis& on) {
  const ShownIn depth = on.units.depth();
  return fmt::format(
      "{}{}: never met, its force is zero to {:.4g} {} and at {:.3g} {}; whether it is passive is not known: "
      "{}",
      study.model, way_text(on.way), depth.factor * study.range.depth_m, depth.unit, study.range.speed_m_s,
      on.units.speed(),
      on.way.along.empty() ? "a greater --depth may meet it"
                           : "another --from, --along or a greater --depth may meet it");
}

/// The axis that was studied, and what it can do by itself.
json as_json(const StudiedAxis& on, const SampledDevice& device) {
  json about = {{"device", on.device_uri},
                {"axis", on.axis},
                {"grip", on.grip},
                {"rate_hz", 1.0 / device.period_s},
                {"damping_n_s_per_m", device.viscous_n_s_per_m},
                {"passive_stiffness_n_per_m", passive_stiffness(device, 0.0)},
                {"colgate_schenkel_n_per_m", colgate_schenkel(device, 0.0)}};
  if (!on.way.along.empty()) about["along"] = on.way.along;
  if (!on.way.from.empty()) about["from"] = on.way.from;
  return about;
}

}  // namespace

json as_json(const SampledDevice& device) {
  return {{"mass_kg", device.mass_kg},
          {"viscous_n_s_per_m", device.viscous_n_s_per_m},
          {"coulomb_n", device.coulomb_n},
          {"encoder_step_m", device.encoder_step_m},
          {"period_s", device.period_s},
          {"delay_s", device.delay_s},
          {"velocity_corner_rad_s", device.velocity_corner_rad_s},
          {"hand",
           {{"mass_kg", device.hand.mass_kg},
            {"damping_n_s_per_m", device.hand.damping_n_s_per_m},
            {"stiffness_n_per_m", device.hand.stiffness_n_per_m}}}};
}

std::string page_body(const Findings& findings) {
  std::string html = "<ul>\n";
  for (const std::string& line : findings.lines) html += "<li>" + escaped(line) + "</li>\n";
  html += "</ul>\n";
  std::string rest = findings.html;
  std::vector<Chart> charts;
  for (const Figure& figure : findings.figures) charts.push_back(figure.chart);
  const std::vector<std::string> drawings = draw_all(charts);
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    const std::string place = "<!--" + findings.figures[i].name + "-->";
    const std::string picture = html_figure(drawings[i]);
    const std::size_t at = rest.find(place);
    if (at == std::string::npos) {
      html += picture;
    } else {
      rest.replace(at, place.size(), picture);
    }
  }
  return html + rest;
}

Findings findings_of(const WallMap& map, const StudiedAxis& on) {
  Findings found;
  json cells = json::array();
  found.csv = "K_n_per_m,B_n_s_per_m,stable,theory\n";
  for (std::size_t row = 0; row < map.grid.second.size() && !map.cells.empty(); ++row) {
    for (std::size_t column = 0; column < map.grid.first.size(); ++column) {
      const Cell& cell = map.cells[row * map.grid.first.size() + column];
      cells.push_back({{"K", map.grid.first[column]},
                       {"B", map.grid.second[row]},
                       {"stable", cell.stable},
                       {"theory", cell.theory}});
      found.csv += fmt::format("{:.8g},{:.8g},{},{}\n", map.grid.first[column], map.grid.second[row],
                               cell.stable ? 1 : 0, cell.theory ? 1 : 0);
    }
  }
  json boundaries = json::array();
  std::vector<std::vector<std::string>> table{{fmt::format("B [{}]", on.units.damping()),
                                               fmt::format("simulated, as it is [{}]", on.units.stiffness()),
                                               "simulated, linear", "eigenvalues", "passive",
                                               "Colgate and Schenkel"}};
  const std::size_t every = std::max<std::size_t>(1, map.boundaries.size() / 10);
  for (const WallBoundary& at : map.boundaries) {
    boundaries.push_back({{"B", at.damping_n_s_per_m},
                          {"simulated", at.simulated},
                          {"simulated_linear", at.simulated_linear},
                          {"eigenvalues", at.eigenvalues},
                          {"passive", at.passive},
                          {"colgate_schenkel", at.colgate_schenkel}});
    if (static_cast<std::size_t>(&at - map.boundaries.data()) % every != 0) continue;
    std::vector<std::string> row{fmt::format("{:.3g}", at.damping_n_s_per_m)};
    for (const double value :
         {at.simulated, at.simulated_linear, at.eigenvalues, at.passive, at.colgate_schenkel}) {
      row.push_back(value <= map.grid.first.front() ? "none" : fmt::format("{:.4g}", value));
    }
    table.push_back(std::move(row));
  }
  found.json = {{"study", "wall"},
                {"on", as_json(on, map.device)},
                {"units", as_json(on.units)},
                {"device", as_json(map.device)},
                {"push_n", map.trial.push_n},
                {"seconds", map.trial.seconds},
                {"agreement", map.agreement()},
                {"boundary_error", map.boundary_error()},
                {"abbott_okamura", map.abbott_okamura},
                {"conditions", to_json(wall_conditions)},
                {"boundaries", std::move(boundaries)},
                {"cells", std::move(cells)}};
  found.lines = comparison(map, on.units);
  found.json["in_words"] = found.lines;
  found.figures.push_back({"wall", picture_of(map, on.units)});
  found.html = device_table(map.device, on.units) + "<h2>Boundaries</h2>\n" + html_table(table);
  return found;
}

Findings findings_of(const LawStudy& study, const StudiedAxis& on) {
  Findings found;
  const LawLimits& limits = study.limits;
  json cells = json::array();
  found.csv = "depth_m,rate_hz,stable,theory\n";
  const std::size_t columns = study.map.grid.first.size();
  for (std::size_t i = 0; i < study.map.cells.size(); ++i) {
    const Cell& cell = study.map.cells[i];
    const double depth = study.map.grid.first[i % columns];
    const double rate = study.map.grid.second[i / columns];
    cells.push_back(
        {{"depth_m", depth}, {"rate_hz", rate}, {"stable", cell.stable}, {"theory", cell.theory}});
    found.csv += fmt::format("{:.8g},{:.8g},{},{}\n", depth, rate, cell.stable ? 1 : 0, cell.theory ? 1 : 0);
  }
  found.json = {{"study", "law"},
                {"law", study.model},
                {"on", as_json(on, study.device)},
                {"units", as_json(on.units)},
                {"device", as_json(study.device)},
                {"range", {{"depth_m", study.range.depth_m}, {"speed_m_s", study.range.speed_m_s}}},
                {"met", study.met},
                {"passive", study.met ? json(study.passive) : json(nullptr)},
                {"deepest_m", json_number(limits.depth_m.at)},
                {"deepest_by_local_stiffness_m", json_number(limits.local_depth_m.at)},
                {"steepest_approach_m_s", json_number(limits.speed_m_s.at)},
                {"lowest_rate_hz", json_number(limits.rate_hz.at)},
                {"local_stiffness_n_per_m", limits.local.stiffness_n_per_m},
                {"local_damping_n_s_per_m", limits.local.damping_n_s_per_m},
                {"passive_stiffness_n_per_m", limits.passive_stiffness_n_per_m},
                {"searches",
                 {{"deepest_m", how_it_ended(limits.depth_m)},
                  {"deepest_by_local_stiffness_m", how_it_ended(limits.local_depth_m)},
                  {"steepest_approach_m_s", how_it_ended(limits.speed_m_s)},
                  {"lowest_rate_hz", how_it_ended(limits.rate_hz)}}}};
  if (study.pressed) {
    found.json["press"] = {{"stable", study.pressed->stable},
                           {"ripple_n", study.pressed->ripple_n},
                           {"peak_n", study.pressed->peak_n}};
  }
  if (study.worst) {
    found.json["worst_stroke"] = {{"from_m", study.worst->stroke.from_m},
                                  {"to_m", study.worst->stroke.to_m},
                                  {"ticks", study.worst->stroke.ticks},
                                  {"energy_j", study.worst->energy_j}};
  }
  found.json["agreement"] = study.map.agreement();
  found.json["cells"] = std::move(cells);

  const ShownIn depth = on.units.depth();
  const std::string speed = on.units.speed();
  found.lines = {
      fmt::format("{}{}: {} to {:.4g} {} and {:.3g} {} at {:.0f} Hz", study.model, way_text(on.way),
                  study.passive ? "passive by all strokes that were tried" : "NOT passive",
                  depth.factor * study.range.depth_m, depth.unit, study.range.speed_m_s, speed,
                  1.0 / study.device.period_s),
      fmt::format("deepest passive penetration: {}; by its local stiffness, against {:.4g} {}: {}",
                  text_of(limits.depth_m, depth), limits.passive_stiffness_n_per_m, on.units.stiffness(),
                  text_of(limits.local_depth_m, depth)),
      fmt::format("steepest passive approach: {}", text_of(limits.speed_m_s, {1.0, speed})),
      fmt::format("lowest passive rate: {}", text_of(limits.rate_hz, {1.0, "Hz"})),
      fmt::format("strokes and local stiffness agree in {:.1f} % of {} cells", 100.0 * study.map.agreement(),
                  study.map.cells.size())};
  if (!limits.passive_at_all) {
    found.lines[1] =
        "gains energy however shallow and slow, at 100 kHz too: it is no passive law on this device";
  }
  if (study.worst) {
    const Gain& worst = *study.worst;
    const ShownIn energy = on.units.energy();
    found.lines.push_back(fmt::format(
        "the worst stroke: {:.3g} to {:.3g} {} in {} ticks ({:.3g} {}) gains {:.2g} {}",
        depth.factor * worst.stroke.from_m, depth.factor * worst.stroke.to_m, depth.unit, worst.stroke.ticks,
        worst.stroke.speed_m_s(study.device.period_s), speed, energy.factor * worst.energy_j, energy.unit));
  }
  if (study.pressed) {
    found.lines.push_back(
        fmt::format("pressed by the hand and held: {}, ripple of the force {:.3g} {unit}, peak {:.3g} {unit}",
                    study.pressed->stable ? "stable" : "UNSTABLE", study.pressed->ripple_n,
                    study.pressed->peak_n, fmt::arg("unit", on.units.force())));
  }
  if (!study.met) found.lines = {never_met(study, on)};
  const std::span all(law_conditions);
  const auto conditions = study.pressed ? all : all.first(all.size() - 1);  // the last is that of the press
  found.json["conditions"] = to_json(conditions);
  for (std::string& line : in_words(conditions)) found.lines.push_back(std::move(line));
  found.json["in_words"] = found.lines;
  found.figures.push_back({"law", picture_of(study.model, study.map, on.units)});
  found.html = device_table(study.device, on.units);
  return found;
}

}  // namespace kerf::bench

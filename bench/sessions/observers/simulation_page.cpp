#include <cmath>

#include <fmt/core.h>

#include "html/html.h"
#include "observers/simulation_report.h"

namespace kerf::bench {
namespace {

std::string percent_cell(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

std::string curve_table(const Simulation& simulation) {
  const auto cell = [](double value, auto text) {
    return std::isfinite(value) ? text(value) : std::string("-");
  };
  const auto plain = [](double value) { return fmt::format("{:.2f}", value); };
  const bool of_levels = simulation.truth.is_of_levels;
  std::vector<std::vector<std::string>> rows{{simulation.curve_of, "answers of all"}};
  if (of_levels) {
    rows[0].insert(rows[0].end(), {"JND covered", "its bias", "its scatter", "upper over lower end"});
  } else {
    rows[0].insert(rows[0].end(), {"power", "by the exact probability"});
  }
  for (const PowerPoint& point : simulation.curve) {
    const SimulatedFindings& found = point.found;
    auto& row = rows.emplace_back(
        std::vector<std::string>{std::to_string(point.trials), fmt::format("{:.0f}", found.trials)});
    if (of_levels) {
      row.insert(row.end(),
                 {cell(found.jnd_covered.value(), percent_cell), cell(found.jnd_bias, percent_cell),
                  cell(found.jnd_spread, percent_cell), cell(found.jnd_ratio, plain)});
    } else {
      row.insert(row.end(), {cell(found.significant.value(), plain), cell(point.theory, plain)});
    }
  }
  return html_table(rows);
}

}  // namespace

std::string simulation_page(const Simulation& simulation) {
  const std::vector<std::string> lines = simulation_lines(simulation);
  std::string body = fmt::format("<h1>{}</h1>\n", escaped(simulation.name));
  body += fmt::format(
      "<p class=\"soft\">Simulated observers feel the forces that the laws of this protocol render, and go "
      "through its sessions: {}.</p>\n",
      escaped(lines.front()));
  for (std::size_t i = 1; i < lines.size(); ++i)
    body += fmt::format("<p{}>{}</p>\n", lines[i].starts_with("Power") ? " class=\"answer\"" : "",
                        escaped(lines[i]));
  std::vector<Chart> charts;
  for (const Figure& figure : simulation_charts(simulation)) charts.push_back(figure.chart);
  for (const std::string& svg : draw_all(charts)) body += html_figure(svg);
  if (!simulation.curve.empty()) {
    body += fmt::format("<h2>Numbers of trials</h2>\n<p class=\"soft\">{} experiments each.</p>\n",
                        simulation.curve_experiments);
    body += curve_table(simulation);
  }
  body +=
      "<p class=\"soft\">The observers are a model: what real people do may differ, and with it the trials "
      "that it takes. Their JND is that of force; between-subject spread, learning and fatigue are not in "
      "it unless they were asked for.</p>\n";
  return html_page("Simulated: " + simulation.name, body);
}

}  // namespace kerf::bench

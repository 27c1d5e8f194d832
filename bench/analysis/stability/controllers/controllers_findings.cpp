#include "stability/controllers/controllers_findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

constexpr double not_found_out = std::numeric_limits<double>::quiet_NaN();
constexpr std::array controller_colours{Colour::blue, Colour::vermillion, Colour::green, Colour::purple,
                                        Colour::orange};

json design_as_json(const ControllerDesign& design, const TravelUnits& units) {
  json of = json::object();
  if (design.controller == WallController::damping) of["B_d"] = design.most_damping_n_s_per_m;
  if (design.controller == WallController::coupling) {
    of["K_c"] = design.coupling_stiffness_n_per_m;
    of["B_c"] = design.coupling_damping_n_s_per_m;
  }
  of["in_words"] = in_words(design, units);
  return of;
}

json complex_as_json(std::complex<double> value) {
  return {json_number(value.real()), json_number(value.imag())};
}

json transparency_as_json(const ComparedController& one) {
  if (!one.transparency) return nullptr;
  const Transparency& found = *one.transparency;
  json lines = json::array();
  for (std::size_t i = 0; i < found.lines.size(); ++i) {
    const RenderedLine& line = found.lines[i];
    const bool has_theory = one.theory && i < one.theory->loop.size();
    lines.push_back({{"frequency_hz", line.frequency_hz},
                     {"commanded", complex_as_json(line.commanded)},
                     {"loop", complex_as_json(line.loop)},
                     {"felt", complex_as_json(line.felt)},
                     {"model", has_theory ? complex_as_json(one.theory->loop[i]) : json(nullptr)},
                     {"coherence", line.coherence.value},
                     {"coherence_lower", line.coherence.lower},
                     {"coherence_upper", line.coherence.upper}});
  }
  return {{"push_n", found.push_n},
          {"records", found.records},
          {"felt_by", found.felt_by_sensor ? "sensor" : "model"},
          {"coherent_lines", found.error.lines},
          {"loop_share", json_number(found.error.loop_share)},
          {"loop_db", json_number(found.error.loop_db)},
          {"felt_share", json_number(found.error.felt_share)},
          {"felt_db", json_number(found.error.felt_db)},
          {"lines", std::move(lines)}};
}

/// What a controller holds at a damping, in words.
std::string held_in_words(const WallRung& rung, const std::string& unit) {
  switch (rung.end) {
    case SearchEnd::found:
      return fmt::format("holds to {:.5g} {}", rung.held_n_per_m, unit);
    case SearchEnd::holds_throughout:
      return fmt::format("holds to {:.5g} {}, the end of the search", rung.held_n_per_m, unit);
    case SearchEnd::holds_nowhere:
      return fmt::format("fails at {:.5g} {} already", rung.failed_n_per_m, unit);
    case SearchEnd::not_finished:
      break;
  }
  return "not finished";
}

std::string line_of(const ComparedController& one, const Wall& wall, const TravelUnits& units) {
  const std::string unit = units.stiffness();
  std::string text = fmt::format("{}: ", name_of(one.design.controller));
  if (one.z_width.ladder.empty()) return text + "nothing was tried";
  text += held_in_words(one.z_width.ladder.front(), unit);
  if (one.transparency) {
    const TransparencyError& error = one.transparency->error;
    if (error.lines == 0) {
      text += fmt::format("; at {:.5g} {} nothing coherent: a stronger --strike would tell",
                          wall.stiffness_n_per_m, unit);
    } else {
      text += fmt::format(
          "; at {:.5g} {} it renders the wall to {:.2g} % ({:.2g} dB), with the device {:.2g} %",
          wall.stiffness_n_per_m, unit, 100.0 * error.loop_share, error.loop_db, 100.0 * error.felt_share);
    }
  } else if (!one.without.empty()) {
    text += "; no transparency: " + one.without;
  }
  if (one.tick_ns > 0.0) text += fmt::format("; {:.2g} ns a tick", one.tick_ns);
  return text + fmt::format(" ({})", in_words(one.design, units));
}

std::string text_or_unknown(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("not known");
}

Chart over_frequency(const char* title, const std::string& label, bool log_y) {
  return {.title = title,
          .x_label = "frequency [Hz]",
          .y_label = label,
          .log_x = true,
          .log_y = log_y,
          .legend_below = true,
          .width_px = 900,
          .height_px = 460};
}

/// A curve of one controller over frequency.
Curve curve_of(const ComparedController& one, std::size_t number, double (*value)(const RenderedLine& line)) {
  Curve curve{.label = std::string(name_of(one.design.controller)),
              .x = {},
              .y = {},
              .colour = controller_colours.at(number % controller_colours.size()),
              .width = 2.0,
              .of = {}};
  for (const RenderedLine& line : one.transparency->lines) {
    curve.x.push_back(line.frequency_hz);
    curve.y.push_back(value(line));
  }
  return curve;
}

/// What each controller renders beside the wall that is commanded, and how coherent it was.
void add_frequency_figures(const ComparedControllers& compared, const std::string& unit, Findings& found) {
  Chart loop =
      over_frequency("Impedance that a controller renders", fmt::format("|Z| of the loop [{}]", unit), true);
  Chart felt =
      over_frequency("Impedance that the hand feels", fmt::format("|Z| at the hand [{}]", unit), true);
  Chart coherence = over_frequency("Coherence of excitation, force and position", "gamma^2 [1]", false);
  Curve commanded{.label = "commanded, K / (j w) + B",
                  .x = {},
                  .y = {},
                  .colour = Colour::black,
                  .dashed = true,
                  .of = {}};
  double least = 1.0;
  for (std::size_t i = 0; i < compared.controllers.size(); ++i) {
    const ComparedController& one = compared.controllers[i];
    if (!one.transparency) continue;
    if (commanded.x.empty()) {
      for (const RenderedLine& line : one.transparency->lines) {
        commanded.x.push_back(line.frequency_hz);
        commanded.y.push_back(std::abs(line.commanded));
      }
    }
    loop.curves.push_back(curve_of(one, i, [](const RenderedLine& line) { return std::abs(line.loop); }));
    felt.curves.push_back(curve_of(one, i, [](const RenderedLine& line) { return std::abs(line.felt); }));
    coherence.curves.push_back(
        curve_of(one, i, [](const RenderedLine& line) { return line.coherence.value; }));
    for (const RenderedLine& line : one.transparency->lines) least = std::min(least, line.coherence.value);
  }
  if (commanded.x.empty()) return;
  coherence.y_range = {.begin = std::min(0.99, 0.1 * std::floor(10.0 * least)), .end = 1.001};
  const Range band{.begin = 0.9 * commanded.x.front(), .end = 1.1 * commanded.x.back()};
  for (Chart* const chart : {&loop, &felt, &coherence}) chart->x_range = band;
  loop.curves.push_back(commanded);
  felt.curves.push_back(std::move(commanded));
  found.figures.push_back({"impedance", std::move(loop)});
  found.figures.push_back({"felt", std::move(felt)});
  found.figures.push_back({"coherence", std::move(coherence)});
}

void add_ladder_figure(const ComparedControllers& compared, const TravelUnits& units, Findings& found) {
  if (compared.controllers.empty() || compared.controllers.front().z_width.ladder.size() < 2) return;
  Chart chart{.title = "Z-width of each controller",
              .x_label = fmt::format("damping of the wall B [{}]", units.damping()),
              .y_label = fmt::format("stiffest wall K [{}]", units.stiffness()),
              .log_y = true,
              .legend_below = true,
              .width_px = 900,
              .height_px = 460};
  for (std::size_t i = 0; i < compared.controllers.size(); ++i) {
    const ComparedController& one = compared.controllers[i];
    Curve curve{.label = std::string(name_of(one.design.controller)),
                .x = {},
                .y = {},
                .colour = controller_colours.at(i % controller_colours.size()),
                .width = 2.0,
                .of = {}};
    for (const WallRung& rung : one.z_width.ladder) {
      curve.x.push_back(rung.damping_n_s_per_m);
      curve.y.push_back(rung.held_n_per_m > 0.0 ? rung.held_n_per_m : line_break);
    }
    chart.curves.push_back(std::move(curve));
  }
  found.figures.push_back({"z-widths", std::move(chart)});
}

}  // namespace

Findings findings_of(const ComparedControllers& compared, const StudiedAxis& on) {
  Findings found;
  json controllers = json::array();
  found.csv =
      "controller,B_n_s_per_m,K_held_n_per_m,K_failed_n_per_m,end,eigenvalues_n_per_m,passive_n_per_m,"
      "wall_n_per_m,loop_share,loop_db,felt_share,felt_db,coherent_lines,tick_ns\n";
  const std::string stiffness = on.units.stiffness();
  std::vector<std::vector<std::string>> table{
      {"controller", fmt::format("B [{}]", on.units.damping()), fmt::format("holds to [{}]", stiffness),
       fmt::format("eigenvalues [{}]", stiffness), fmt::format("passive, any hand [{}]", stiffness),
       "error of the loop", "as felt", "tick [ns]"}};
  for (const ComparedController& one : compared.controllers) {
    const TransparencyError error = one.transparency ? one.transparency->error
                                                     : TransparencyError{.loop_share = not_found_out,
                                                                         .loop_db = not_found_out,
                                                                         .felt_share = not_found_out,
                                                                         .felt_db = not_found_out};
    json ladder = json::array();
    for (std::size_t i = 0; i < one.z_width.ladder.size(); ++i) {
      const WallRung& rung = one.z_width.ladder[i];
      const double stable = one.theory ? one.theory->boundary_n_per_m[i] : not_found_out;
      const double passive = one.theory ? one.theory->passive_n_per_m[i] : not_found_out;
      ladder.push_back({{"B", rung.damping_n_s_per_m},
                        {"K_held", rung.held_n_per_m},
                        {"K_failed", rung.failed_n_per_m > 0.0 ? json(rung.failed_n_per_m) : json(nullptr)},
                        {"end", name_of(rung.end)},
                        {"trials", rung.trials},
                        {"eigenvalues", json_number(stable)},
                        {"passive", json_number(passive)}});
      found.csv += fmt::format(
          "{},{:.8g},{:.8g},{:.8g},{},{:.8g},{:.8g},{:.8g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.4g}\n",
          name_of(one.design.controller), rung.damping_n_s_per_m, rung.held_n_per_m, rung.failed_n_per_m,
          name_of(rung.end), stable, passive, compared.wall.stiffness_n_per_m, error.loop_share,
          error.loop_db, error.felt_share, error.felt_db, error.lines, one.tick_ns);
      const auto percent = [](double share) {
        return std::isfinite(share) ? fmt::format("{:.2g} %", 100.0 * share) : std::string("not known");
      };
      table.push_back(
          {std::string(name_of(one.design.controller)), fmt::format("{:.4g}", rung.damping_n_s_per_m),
           fmt::format("{:.4g}", rung.held_n_per_m), text_or_unknown(stable), text_or_unknown(passive),
           percent(error.loop_share), percent(error.felt_share), fmt::format("{:.2g}", one.tick_ns)});
    }
    controllers.push_back({{"controller", name_of(one.design.controller)},
                           {"design", design_as_json(one.design, on.units)},
                           {"ladder", std::move(ladder)},
                           {"transparency", transparency_as_json(one)},
                           {"no_transparency", one.without.empty() ? json(nullptr) : json(one.without)},
                           {"tick_ns", one.tick_ns > 0.0 ? json(one.tick_ns) : json(nullptr)}});
    found.lines.push_back(line_of(one, compared.wall, on.units));
  }
  for (const std::string& why : compared.left_out) found.lines.push_back("left out: " + why);
  if (!compared.finished)
    found.lines.push_back("it was stopped before its end; what is told was found until then");
  for (std::string& line : in_words(controller_conditions)) found.lines.push_back(std::move(line));
  const bool has_wall = compared.wall.stiffness_n_per_m > 0.0;
  found.json = {
      {"study", "controllers"},
      {"on",
       {{"device", on.device_uri},
        {"axis", on.axis},
        {"grip", on.grip},
        {"rate_hz", 1.0 / compared.model.period_s},
        {"simulated", compared.device.simulated}}},
      {"units", as_json(on.units)},
      {"model", as_json(compared.model)},
      {"wall", has_wall ? json{{"K", compared.wall.stiffness_n_per_m}, {"B", compared.wall.damping_n_s_per_m}}
                        : json(nullptr)},
      {"finished", compared.finished},
      {"conditions", to_json(controller_conditions)},
      {"left_out", compared.left_out},
      {"controllers", std::move(controllers)}};
  found.json["in_words"] = found.lines;
  found.figures.push_back({"controllers", controllers_picture(found.json)});
  add_ladder_figure(compared, on.units, found);
  add_frequency_figures(compared, on.units.damping(), found);
  found.html = "<h2>Controllers</h2>\n" + html_table(table);
  return found;
}

Chart controllers_picture(const json& study) {
  const auto device = study.at("on").at("device").get<std::string>();
  Chart chart{.title = fmt::format("Controllers of a wall on {}, axis {}", device.substr(0, device.find('?')),
                                   study.at("on").at("axis").get<std::string>()),
              .x_label = "error of the impedance that is rendered, 1 to 30 Hz, rms [%]",
              .y_label = fmt::format("stiffest wall that holds [{}]", TravelUnits(study).stiffness()),
              .log_x = true,
              .log_y = true,
              .legend_below = true,
              .width_px = 900,
              .height_px = 460};
  Range x{.begin = std::numeric_limits<double>::infinity(), .end = 0.0};
  Range y = x;
  for (std::size_t i = 0; i < study.at("controllers").size(); ++i) {
    const json& one = study.at("controllers").at(i);
    if (one.at("transparency").is_null() || one.at("ladder").empty()) continue;
    const double percent = 100.0 * number_from(one.at("transparency").at("loop_share"));
    const json& rung = one.at("ladder").at(0);
    const double held = number_from(rung.at("K_held"));
    if (!(percent > 0.0) || !(held > 0.0)) continue;
    const double tick_ns = number_from(one.at("tick_ns"));
    std::string label = one.at("controller").get<std::string>();
    if (rung.at("end") == name_of(SearchEnd::holds_throughout)) label += " (to the end of the search)";
    if (std::isfinite(tick_ns)) label += fmt::format(", {:.2g} ns a tick", tick_ns);
    chart.curves.push_back({.label = std::move(label),
                            .x = {percent},
                            .y = {held},
                            .colour = controller_colours.at(i % controller_colours.size()),
                            .mark = Mark::points,
                            .width = 6.0,
                            .of = {}});
    x = {.begin = std::min(x.begin, percent), .end = std::max(x.end, percent)};
    y = {.begin = std::min(y.begin, held), .end = std::max(y.end, held)};
  }
  if (!chart.curves.empty()) {
    const auto around = [](Range range) {
      constexpr double beside = 1.6;
      return Range{.begin = range.begin / beside, .end = range.end * beside};
    };
    chart.x_range = around(x);
    chart.y_range = around(y);
  }
  return chart;
}

}  // namespace kerf::bench

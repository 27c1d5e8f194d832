#include "stability/zwidth/z_width_findings.h"

#include <algorithm>
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

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of a boundary that was found; null of one that lies beyond the search.
json found_or_null(const WallRung& rung) {
  return rung.end == SearchEnd::found ? json(rung.boundary()) : json(nullptr);
}

std::string in_words(const WallRung& rung, const ZWidthTheory* theory, const TravelUnits& units) {
  const std::string unit = units.stiffness();
  std::string text = fmt::format("B = {:.4g} {}: ", rung.damping_n_s_per_m, units.damping());
  if (rung.end == SearchEnd::holds_throughout) {
    text += fmt::format("holds to {:.5g} {}, the end of the search", rung.held_n_per_m, unit);
  } else if (rung.end == SearchEnd::holds_nowhere) {
    text += fmt::format("fails at {:.5g} {} already", rung.failed_n_per_m, unit);
  } else if (rung.end == SearchEnd::not_finished) {
    return text + "not finished";
  } else {
    text += fmt::format("holds to {:.5g} {unit}, fails at {:.5g} {unit}", rung.held_n_per_m,
                        rung.failed_n_per_m, fmt::arg("unit", unit));
  }
  if (rung.failed_n_per_m > 0.0) {
    text += rung.cycle_n > 0.0
                ? fmt::format(" with {:.2g} {} rms at {:.3g} Hz", rung.cycle_n, units.force(), rung.cycle_hz)
                : std::string(", where the force passed its stop");
    if (rung.hysteresis) text += "; struck softly it holds there (hysteresis)";
  }
  if (theory == nullptr) return text;
  text += fmt::format("; the model says {:.5g} {}", theory->boundary, unit);
  if (theory->band) text += fmt::format(" ({:.4g} to {:.4g})", theory->band->begin, theory->band->end);
  return text + fmt::format(", passive in any hand to {:.4g}", theory->passive);
}

json as_json(const WallSearchOptions& options) {
  return {{"softest_n_per_m", options.softest_n_per_m},
          {"stiffest_n_per_m", options.stiffest_n_per_m},
          {"resolution", options.resolution},
          {"repeats", options.repeats},
          {"felt_n", options.felt_n},
          {"false_alarms", options.false_alarms},
          {"strike_n", options.strike_n},
          {"soft_strike", options.soft_strike},
          {"stop_n", options.stop_n > 0.0 ? json(options.stop_n) : json(nullptr)},
          {"window_s", options.window_s},
          {"shortest_s", options.shortest_s},
          {"longest_s", std::ldexp(options.shortest_s, options.extensions)},
          {"lowest_hz", options.lowest_hz}};
}

json as_json(const UncertainModel& model) {
  return {{"device", as_json(model.device)},
          {"half_intervals",
           {{"mass", model.mass},
            {"viscous", model.viscous},
            {"coulomb", model.coulomb},
            {"hand", model.hand},
            {"delay_s", model.delay_s}}}};
}

}  // namespace

Findings findings_of(const ZWidth& measured, const std::vector<ZWidthTheory>& theory,
                     const std::optional<UncertainModel>& model, const StudiedAxis& on) {
  Findings found;
  json ladder = json::array();
  found.csv =
      "B_n_s_per_m,K_held_n_per_m,K_failed_n_per_m,end,trials,hysteresis,cycle_n,cycle_hz,model_n_per_m,"
      "model_lower_n_per_m,model_upper_n_per_m,passive_n_per_m\n";
  const std::string stiffness = on.units.stiffness();
  std::vector<std::vector<std::string>> table{
      {fmt::format("B [{}]", on.units.damping()), fmt::format("holds to [{}]", stiffness),
       fmt::format("fails at [{}]", stiffness), fmt::format("model [{}]", stiffness), "its interval",
       "passive, any hand", "trials"}};
  const auto text_of = [](double value) {
    return value > 0.0 ? fmt::format("{:.4g}", value) : std::string("none");
  };
  for (std::size_t i = 0; i < measured.ladder.size(); ++i) {
    const WallRung& rung = measured.ladder[i];
    const ZWidthTheory* const at = i < theory.size() ? &theory[i] : nullptr;
    const double lower = at != nullptr && at->band ? at->band->begin : unknown;
    const double upper = at != nullptr && at->band ? at->band->end : unknown;
    const double said = at != nullptr ? at->boundary : unknown;
    const double passive = at != nullptr ? at->passive : unknown;
    ladder.push_back({{"B", rung.damping_n_s_per_m},
                      {"K", found_or_null(rung)},
                      {"K_held", rung.held_n_per_m},
                      {"K_failed", rung.failed_n_per_m > 0.0 ? json(rung.failed_n_per_m) : json(nullptr)},
                      {"end", name_of(rung.end)},
                      {"trials", rung.trials},
                      {"disturbed", rung.disturbed},
                      {"hysteresis", rung.hysteresis},
                      {"cycle_n", rung.cycle_n > 0.0 ? json(rung.cycle_n) : json(nullptr)},
                      {"cycle_hz", rung.cycle_n > 0.0 ? json(rung.cycle_hz) : json(nullptr)},
                      {"model", json_number(said)},
                      {"model_lower", json_number(lower)},
                      {"model_upper", json_number(upper)},
                      {"passive", json_number(passive)}});
    found.csv += fmt::format("{:.8g},{:.8g},{:.8g},{},{},{},{:.4g},{:.4g},{:.8g},{:.8g},{:.8g},{:.8g}\n",
                             rung.damping_n_s_per_m, rung.held_n_per_m, rung.failed_n_per_m,
                             name_of(rung.end), rung.trials, rung.hysteresis ? 1 : 0, rung.cycle_n,
                             rung.cycle_hz, said, lower, upper, passive);
    table.push_back(
        {fmt::format("{:.4g}", rung.damping_n_s_per_m), text_of(rung.held_n_per_m),
         text_of(rung.failed_n_per_m), text_of(said),
         std::isfinite(lower) ? fmt::format("{:.4g} to {:.4g}", lower, upper) : std::string("not known"),
         text_of(passive), fmt::format("{}", rung.trials)});
    found.lines.push_back(in_words(rung, at, on.units));
  }
  if (!measured.finished)
    found.lines.push_back("it was stopped before its end; what is told was found until then");
  for (std::string& line : in_words(z_width_conditions)) found.lines.push_back(std::move(line));
  const bool by_eigenvalues = model && model->device.is_linear();
  found.json = {{"study", "z_width"},
                {"on",
                 {{"device", on.device_uri},
                  {"axis", on.axis},
                  {"grip", on.grip},
                  {"rate_hz", 1.0 / measured.period_s},
                  {"simulated", measured.device.simulated}}},
                {"units", as_json(on.units)},
                {"model", model ? as_json(*model) : json(nullptr)},
                {"model_by", !model ? json(nullptr) : json(by_eigenvalues ? "eigenvalues" : "simulation")},
                {"search", as_json(measured.options)},
                {"finished", measured.finished},
                {"ticks", measured.ticks},
                {"missed_deadlines", measured.missed},
                {"conditions", to_json(z_width_conditions)},
                {"ladder", std::move(ladder)}};
  found.json["in_words"] = found.lines;
  found.figures.push_back({"z-width", z_width_picture(found.json)});
  found.html = "<h2>Stiffest walls</h2>\n" + html_table(table);
  return found;
}

Chart z_width_picture(const json& study) {
  const auto device = study.at("on").at("device").get<std::string>();
  const TravelUnits units(study);
  Chart chart{.title = fmt::format("Z-width of {}, axis {}", device.substr(0, device.find('?')),
                                   study.at("on").at("axis").get<std::string>()),
              .x_label = fmt::format("damping of the wall B [{}]", units.damping()),
              .y_label = fmt::format("stiffness of the wall K [{}]", units.stiffness()),
              .log_y = true,
              .legend_below = true,
              .width_px = 900,
              .height_px = 520};
  const auto curve = [](const char* label, Colour colour) {
    return Curve{.label = label, .x = {}, .y = {}, .colour = colour, .of = {}};
  };
  Curve held = curve("held", Colour::blue);
  held.mark = Mark::circles;
  held.width = 5.0;
  Curve failed = curve("failed", Colour::vermillion);
  failed.mark = Mark::crosses;
  failed.width = 5.0;
  Curve model = curve("the model says", Colour::black);
  Curve lower = curve("95 % of the model", Colour::black);
  Curve upper = curve("", Colour::black);
  Curve passive = curve("passive, in any hand", Colour::green);
  lower.dashed = upper.dashed = true;
  const auto add = [](Curve& to, const json& rung, const char* key) {
    const double value = number_from(rung.at(key));
    to.x.push_back(number_from(rung.at("B")));
    to.y.push_back(value > 0.0 ? value : line_break);
  };
  for (const json& rung : study.at("ladder")) {
    add(held, rung, "K_held");
    add(failed, rung, "K_failed");
    add(model, rung, "model");
    add(lower, rung, "model_lower");
    add(upper, rung, "model_upper");
    add(passive, rung, "passive");
  }
  double least_b = std::numeric_limits<double>::infinity();
  double most_b = 0.0;
  for (const double damping : held.x) least_b = std::min(least_b, damping);
  for (const double damping : held.x) most_b = std::max(most_b, damping);
  const double beside = most_b > least_b ? 0.05 * (most_b - least_b) : 1.0;
  chart.x_range = {.begin = least_b - beside, .end = most_b + beside};
  double softest = std::numeric_limits<double>::infinity();
  double stiffest = 0.0;
  for (Curve* const each : {&model, &lower, &upper, &passive, &held, &failed}) {
    const bool seen = std::ranges::any_of(each->y, [](double y) { return std::isfinite(y); });
    if (!seen) continue;
    for (const double y : each->y) {
      if (!std::isfinite(y)) continue;
      softest = std::min(softest, y);
      stiffest = std::max(stiffest, y);
    }
    chart.curves.push_back(std::move(*each));
  }
  constexpr double above = 1.5;  // so that no mark lies on the frame
  if (stiffest > 0.0) chart.y_range = {.begin = softest / above, .end = stiffest * above};
  return chart;
}

}  // namespace kerf::bench

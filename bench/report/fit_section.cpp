#include "report/fit_section.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include "laws/law_file.h"
#include "laws/render.h"
#include "report/charts.h"
#include "report/html.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr std::array law_colours{Colour::vermillion, Colour::green, Colour::blue, Colour::purple,
                                 Colour::orange};
constexpr std::uint32_t cycles_drawn = 3;
constexpr std::size_t parameters_listed = 40;  ///< of a law; a longer list is a table to be seen as a curve

/// A law drawn along the recording.
struct Trace {
  std::string model;
  Colour colour;
  std::vector<double> force;
};

struct Window {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The first cycles, or all where there are none: what the eye can follow.
Window window_of(const schema::Recording& recording) {
  Window window{.begin = 0, .end = recording.rows()};
  if (!recording.cycles || recording.cycles->phases.empty()) return window;
  const auto& phases = recording.cycles->phases;
  const auto first = std::find_if(phases.begin(), phases.end(),
                                  [](const auto& span) { return span.phase == schema::Phase::closing; });
  if (first == phases.end()) return window;
  window.begin = first->begin;
  for (const auto& span : phases) {
    if (span.cycle < first->cycle + cycles_drawn) window.end = span.end;
  }
  const std::size_t margin = (window.end - window.begin) / 20;
  window.begin -= std::min(window.begin, margin);
  window.end = std::min(window.end + margin, recording.rows());
  return window;
}

std::vector<double> part(const std::vector<double>& values, const Window& window) {
  return {values.begin() + static_cast<std::ptrdiff_t>(window.begin),
          values.begin() + static_cast<std::ptrdiff_t>(window.end)};
}

std::string figure(const Chart& chart) { return "<figure>" + draw(chart) + "</figure>\n"; }

std::string over_time(const AxisSeries& series, const std::vector<Trace>& traces, const Window& window,
                      const std::string& unit) {
  Chart chart{.title = "The laws over the recorded force",
              .x_label = "time [s]",
              .y_label = "resisting force [" + unit + "]",
              .height_px = 420};
  chart.curves.push_back(decimated({.label = "recorded",
                                    .x = part(series.time_s, window),
                                    .y = part(series.force, window),
                                    .colour = Colour::grey,
                                    .width = 3.0}));
  for (const Trace& trace : traces) {
    chart.curves.push_back(decimated({.label = trace.model,
                                      .x = part(series.time_s, window),
                                      .y = part(trace.force, window),
                                      .colour = trace.colour,
                                      .width = 1.4}));
  }
  return figure(chart);
}

std::string over_penetration(const schema::Recording& recording, std::size_t axis, const AxisSeries& series,
                             const std::vector<Trace>& traces, const Window& window) {
  const DrawnUnit unit = drawn_position(recording.axes[axis]);
  std::vector<double> penetration = part(series.penetration, window);
  for (double& x : penetration) x *= unit.factor;
  Chart chart{.title = "Force against penetration", .height_px = 420};
  chart.x_label = fmt::format("penetration from contact [{}]", unit.unit);
  chart.y_label = "resisting force [" + recording.axes[axis].force_unit + "]";
  const auto add = [&](const std::string& label, const std::vector<double>& force, Colour colour,
                       double width) {
    chart.curves.push_back(decimated(
        {.label = label, .x = penetration, .y = part(force, window), .colour = colour, .width = width},
        8000));
  };
  add("recorded", series.force, Colour::grey, 2.5);
  for (const Trace& trace : traces) add(trace.model, trace.force, trace.colour, 1.2);
  return figure(chart);
}

std::string residual_charts(const AxisSeries& series, const std::vector<Trace>& traces,
                            const std::string& unit) {
  double largest = 0.0;
  std::vector<std::vector<double>> residuals;
  for (const Trace& trace : traces) {
    auto& residual = residuals.emplace_back();
    for (std::size_t i = 0; i < series.force.size(); ++i)
      residual.push_back(series.force[i] - trace.force[i]);
    for (const double r : residual) largest = std::max(largest, std::abs(r));
  }
  std::string html;
  for (std::size_t i = 0; i < traces.size(); ++i) {
    Chart chart{.title = "Residual of " + traces[i].model + " (recorded less law), on one scale for all laws",
                .x_label = "time [s]",
                .y_label = "[" + unit + "]",
                .height_px = 210};
    chart.y_range = {-largest, largest};
    chart.curves.push_back(
        decimated({.x = series.time_s, .y = residuals[i], .colour = traces[i].colour, .width = 0.8}));
    html += figure(chart);
  }
  return html;
}

std::string number(const json& value, const char* format = "{:.4g}") {
  return value.is_null() ? "undetermined" : fmt::format(fmt::runtime(format), value.get<double>());
}

std::string comparison_table(const json& fits, const std::string& unit) {
  std::vector<std::vector<std::string>> rows{{"law", "free parameters", "rmse [" + unit + "]",
                                              "rmse rendered [" + unit + "]", "largest [" + unit + "]", "R²",
                                              "AIC", "BIC", "rmse held out [" + unit + "]", "outside JND",
                                              "converged"}};
  for (const json& fit : fits.at("fits")) {
    rows.push_back(
        {fit.at("model").get<std::string>(), fmt::format("{}", fit.at("free_parameters").get<int>()),
         number(fit.at("rmse")), number(fit.at("rmse_rendered")), number(fit.at("max_abs")),
         number(fit.at("r2"), "{:.4f}"), number(fit.at("aic"), "{:.0f}"), number(fit.at("bic"), "{:.0f}"),
         number(fit.at("cv_rmse")), fmt::format("{:.1f} %", 100.0 * fit.at("jnd_fraction").get<double>()),
         fit.at("converged").get<bool>() ? "yes" : "no"});
  }
  rows.push_back({"straight line", "2", number(fits.at("line_rmse"))});
  return html_table(rows);
}

std::string parameter_table(const json& fit) {
  const json& parameters = fit.at("parameters");
  const std::string title = "<h3>" + escaped(fit.at("model").get<std::string>()) + "</h3>\n";
  if (parameters.size() > parameters_listed) {
    return title +
           fmt::format(
               "<p>{} table values, drawn above; with their uncertainty in <code>fit.csv</code>.</p>\n",
               parameters.size());
  }
  std::vector<std::vector<std::string>> rows{
      {"parameter", "value", "standard error", "95 % interval", "unit"}};
  for (const auto& [name, parameter] : parameters.items()) {
    const json& interval = parameter.at("ci95");
    const bool held = parameter.at("std_error").is_number() && parameter.at("std_error").get<double>() == 0.0;
    rows.push_back({name, number(parameter.at("value"), "{:.6g}"),
                    held ? "held" : number(parameter.at("std_error"), "{:.2g}"),
                    held ? "" : number(interval.at(0), "{:.6g}") + " to " + number(interval.at(1), "{:.6g}"),
                    parameter.at("unit").get<std::string>()});
  }
  std::string html = title + html_table(rows);
  for (const json& warning : fit.at("warnings")) {
    html += "<p class=\"soft\">" + escaped(warning.get<std::string>()) + "</p>\n";
  }
  return html;
}

}  // namespace

std::string choice_paragraph(const json& fits) {
  try {
    return fmt::format("<p class=\"answer\"><strong>Choice: {}.</strong> {}.</p>\n",
                       escaped(fits.at("choice").at("model").get<std::string>()),
                       escaped(fits.at("choice").at("why").get<std::string>()));
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("fit.json is not what 'kerf fit' writes: {}", error.what()));
  }
}

std::string fit_section(const schema::Recording& recording, std::size_t axis, const json& fits,
                        const std::filesystem::path& folder) {
  const std::string unit = recording.axes[axis].force_unit;
  try {
    std::vector<Trace> traces;
    AxisSeries series;
    for (const json& fit : fits.at("fits")) {
      const std::string model = fit.at("model").get<std::string>();
      const LawFile law = read_law_file(folder / (model + ".law.toml"));
      series = axis_series(recording, axis, law.contact);
      traces.push_back({.model = model,
                        .colour = law_colours[traces.size() % law_colours.size()],
                        .force = render(without_rendering_aids(law.law), series)});
    }
    if (traces.empty()) return "<h2>Fits</h2>\n<p>No law could be fitted.</p>\n";
    const Window window = window_of(recording);
    std::string html = "<h2>Fits</h2>\n" + comparison_table(fits, unit);
    html +=
        "<p class=\"soft\">Held out: each cycle (or block of time) predicted by a fit to the others. "
        "Rendered: with "
        "the rendering aids of laws that have branches. Outside JND: share of samples whose error a person "
        "could "
        "feel.</p>\n";
    html +=
        over_time(series, traces, window, unit) + over_penetration(recording, axis, series, traces, window);
    html += "<h2>Residuals</h2>\n" + residual_charts(series, traces, unit);
    html += "<h2>Parameters</h2>\n";
    for (const json& fit : fits.at("fits")) html += parameter_table(fit);
    return html;
  } catch (const json::exception& error) {
    throw std::invalid_argument(
        fmt::format("{}/fit.json is not what 'kerf fit' writes: {}", folder.string(), error.what()));
  }
}

}  // namespace kerf::bench

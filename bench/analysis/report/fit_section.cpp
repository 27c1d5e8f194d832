#include "report/fit_section.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include "fits/fit_files.h"
#include "html/html.h"
#include "inspect/flagged_cycles.h"
#include "report/comparison.h"
#include "report/fit_view.h"
#include "report/parameter_tables.h"
#include "report/residual_charts.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr std::uint32_t cycles_drawn = 3;

struct Window {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Cycles that are flagged show what no law was asked for.
std::vector<std::uint32_t> flagged_in(const schema::Recording& recording) {
  std::vector<std::uint32_t> flagged;
  if (!recording.cycle_flags) return flagged;
  for (const CycleVerdict& one :
       verdicts_on_cycles(schema::RowsInMemory(recording), recording.cycle_flags->felt))
    if (!one.reason.empty()) flagged.push_back(one.cycle);
  return flagged;
}

/// The first good cycles, or all where there are none: what the eye can follow.
Window window_of(const schema::Recording& recording, const AxisSeries& series) {
  const Window all{.begin = 0, .end = series.time_s.size()};
  if (!recording.cycles || recording.cycles->phases.empty()) return all;
  const auto& phases = recording.cycles->phases;
  const std::vector<std::uint32_t> flagged = flagged_in(recording);
  const auto first = std::find_if(phases.begin(), phases.end(), [&](const auto& span) {
    return span.phase == schema::Phase::closing && std::ranges::find(flagged, span.cycle) == flagged.end();
  });
  if (first == phases.end()) return all;
  const double begin_s = recording.time[first->begin];
  double end_s = begin_s;
  for (const auto& span : phases) {
    if (span.cycle >= first->cycle && span.cycle < first->cycle + cycles_drawn)
      end_s = recording.time[std::min<std::size_t>(span.end, recording.rows() - 1)];
  }
  const double margin_s = (end_s - begin_s) / 20.0;
  const auto row = [&](double time_s) {
    const auto& times = series.time_s;
    return static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time_s) - times.begin());
  };
  const Window window{.begin = row(begin_s - margin_s), .end = row(end_s + margin_s)};
  return window.end > window.begin + 1 ? window : all;
}

std::vector<double> part(const std::vector<double>& values, const Window& window) {
  return {values.begin() + static_cast<std::ptrdiff_t>(window.begin),
          values.begin() + static_cast<std::ptrdiff_t>(window.end)};
}

Chart over_time(const FitView& view, const Window& window) {
  Chart chart{.title = "The laws over the recorded force (on grey: rows that no law is judged by)",
              .x_label = "time [s]",
              .y_label = "resisting force [" + view.force_unit + "]",
              .height_px = 420};
  const auto add = [&](const std::string& label, const std::vector<double>& force, Colour colour,
                       double width) {
    chart.curves.push_back(decimated({.label = label,
                                      .x = part(view.series.time_s, window),
                                      .y = part(force, window),
                                      .colour = colour,
                                      .width = width}));
  };
  add("recorded", view.series.force, Colour::grey, 3.0);
  for (std::size_t i = view.shown; i-- > 0;)
    add(view.traces[i].model, view.traces[i].force, view.traces[i].colour, 1.4);
  chart.bands =
      bands_not_judged(view.series, view.series.time_s[window.begin], view.series.time_s[window.end - 1]);
  return chart;
}

Chart over_penetration(const FitView& view, const Window& window) {
  Chart chart{.title = "Force against penetration",
              .x_label = fmt::format("penetration from contact [{}]", view.position.unit),
              .y_label = "resisting force [" + view.force_unit + "]",
              .height_px = 420};
  std::vector<double> penetration = part(view.series.penetration, window);
  for (double& x : penetration) x *= view.position.factor;
  const auto add = [&](const std::string& label, const std::vector<double>& force, Colour colour,
                       double width) {
    chart.curves.push_back(decimated(
        {.label = label, .x = penetration, .y = part(force, window), .colour = colour, .width = width},
        8000));
  };
  add("recorded", view.series.force, Colour::grey, 2.5);
  for (std::size_t i = view.shown; i-- > 0;)
    add(view.traces[i].model, view.traces[i].force, view.traces[i].colour, 1.2);
  return chart;
}

std::string warnings_of(const json& fits, const FitView& view) {
  std::string html;
  const auto add = [&](const std::string& text) { html += "<p class=\"soft\">" + escaped(text) + "</p>\n"; };
  if (!view.of_this_recording)
    add("These laws were fitted to another recording: what is drawn below is how they predict this one.");
  if (fits.contains("recordings") && fits.at("recordings").size() > 1)
    add(fmt::format("Fitted to {} recordings at once; the charts show this one.",
                    fits.at("recordings").size()));
  if (fits.contains("warnings")) {
    for (const json& warning : fits.at("warnings")) add(warning.get<std::string>());
  }
  if (fits.contains("refused")) {
    for (const json& refused : fits.at("refused"))
      add(refused.at("model").get<std::string>() + ": " + refused.at("why").get<std::string>());
  }
  return html;
}

double largest_residual(const FitView& view) {
  double largest = 0.0;
  for (std::size_t i = 0; i < view.shown; ++i) {
    for (const double r : view.traces[i].residual) largest = std::max(largest, std::abs(r));
  }
  return largest;
}

std::string residual_part(const FitView& view) {
  const double largest = largest_residual(view);
  std::string html =
      "<h2>Residuals</h2>\n<p class=\"soft\">Recorded less law, on one scale for these laws and in the rows "
      "that they are judged by; the others are grey. Against penetration and velocity: samples in grey, "
      "their mean in bins with one deviation to each side.</p>\n";
  for (std::size_t i = 0; i < view.shown; ++i) {
    const FittedTrace& trace = view.traces[i];
    html += "<h3>" + escaped(trace.model) + "</h3>\n" +
            html_figure(draw(residual_over_time(view, trace, largest)));
    html += figures_in_pairs({residual_over_penetration(view, trace, largest),
                              residual_over_velocity(view, trace, largest),
                              residual_autocorrelation(view, trace), residual_histogram(view, trace)});
  }
  if (view.shown == view.traces.size()) return html;
  html +=
      fmt::format("<details><summary>Residuals of the other {} laws, each on a scale of its own</summary>\n",
                  view.traces.size() - view.shown);
  for (std::size_t i = view.shown; i < view.traces.size(); ++i) {
    const FittedTrace& trace = view.traces[i];
    html += "<h3>" + escaped(trace.model) + "</h3>\n";
    html += figures_in_pairs(
        {residual_over_penetration(view, trace, 0.0), residual_autocorrelation(view, trace)});
  }
  return html + "</details>\n";
}

std::string parameters_part(const FitView& view, double confidence) {
  std::string html = "<h2>Parameters</h2>\n";
  for (std::size_t i = 0; i < view.shown; ++i) html += parameter_part(view.traces[i], confidence);
  if (view.shown == view.traces.size()) return html;
  html += fmt::format("<details><summary>Parameters of the other {} laws</summary>\n",
                      view.traces.size() - view.shown);
  for (std::size_t i = view.shown; i < view.traces.size(); ++i)
    html += parameter_part(view.traces[i], confidence);
  return html + "</details>\n";
}

std::string blame_of(const json& fits, const std::string& model) {
  for (const json& fit : fits.at("fits")) {
    if (fit.at("model") == model && fit.contains("blame"))
      return fmt::format(" What is to blame: {}.", escaped(fit.at("blame").get<std::string>()));
  }
  return "";
}

}  // namespace

std::string choice_paragraph(const json& fits, bool outdated) {
  try {
    const std::string model = fits.at("choice").at("model").get<std::string>();
    const Answer answer = model.empty()                                          ? Answer::bad
                          : !outdated && choice_within_jnd(fits).value_or(false) ? Answer::good
                                                                                 : Answer::partly;
    return html_answer(
        answer, fmt::format("<strong>Choice: {}</strong>: {}.{}", escaped(model.empty() ? "none" : model),
                            escaped(fits.at("choice").at("why").get<std::string>()), blame_of(fits, model)));
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("fit.json is not what 'kerf fit' writes: {}", error.what()));
  }
}

std::string fit_section(const schema::Recording& recording, std::size_t axis, const json& fits,
                        const std::filesystem::path& folder) {
  try {
    const FitView view = view_of_fits(recording, axis, fits, folder);
    if (view.traces.empty())
      return "<h2>Fits</h2>\n<p>No law could be fitted.</p>\n" + warnings_of(fits, view);
    const double confidence =
        fits.contains("settings") ? fits.at("settings").at("confidence").get<double>() : 0.95;
    const Window window = window_of(recording, view.series);
    std::string html = "<h2>Fits</h2>\n" + warnings_of(fits, view) + comparison_table(fits, view.force_unit);
    html +=
        "<p class=\"soft\">Free: the parameters that were fitted. Held out: each cycle (or blocks of time) "
        "predicted by a fit to the others. As "
        "rendered: by a loop, with its late velocity, its latency, and the rendering aids of laws that have "
        "branches; the choice goes by that. Outside JND: share of samples whose error a person could feel. "
        "Errors are over the rows in contact unless all were asked for. Floor: no map of penetration "
        "and velocity and no law was found that errs by less on held-out data, as fitted.</p>\n";
    html += html_figure(draw(comparison_chart(fits, view.force_unit)));
    if (view.shown < view.traces.size())
      html +=
          fmt::format("<p class=\"soft\">Drawn below: the chosen law and the next {} by that error.</p>\n",
                      view.shown - 1);
    html += html_figure(draw(over_time(view, window))) + html_figure(draw(over_penetration(view, window)));
    return html + residual_part(view) + parameters_part(view, confidence);
  } catch (const json::exception& error) {
    throw std::invalid_argument(
        fmt::format("{}/fit.json is not what 'kerf fit' writes: {}", folder.string(), error.what()));
  }
}

}  // namespace kerf::bench

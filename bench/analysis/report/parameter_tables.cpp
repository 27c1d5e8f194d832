#include "report/parameter_tables.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "fits/fit_files.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t parameters_listed = 40;  ///< of a law; a longer list is a table to be seen as a curve
constexpr std::size_t max_searched = 12;       ///< for correlations and profiles

constexpr double log_profile_from =
    8.0;                           ///< ratio of a profile's ends from which it is drawn over a logarithm
constexpr double widest = 1000.0;  ///< and how far from the best it is then followed

std::string interval_text(const json& lower, const json& upper) {
  if (lower.is_null() && upper.is_null()) return "undetermined";
  if (lower.is_null()) return "below " + number_text(upper, "{:.6g}");
  if (upper.is_null()) return "above " + number_text(lower, "{:.6g}");
  return number_text(lower, "{:.6g}") + " to " + number_text(upper, "{:.6g}");
}

std::vector<std::string> parameter_row(const std::string& name, const json& parameter,
                                       const std::string& interval_name) {
  const json& interval = parameter.at(interval_name);
  const json& error = parameter.at("std_error");
  const bool held = error.is_number() && error.get<double>() == 0.0;
  return {name, number_text(parameter.at("value"), "{:.6g}"),
          held ? "held" : (error.is_null() ? "undetermined" : number_text(error, "{:.2g}")),
          held ? "" : interval_text(interval.at(0), interval.at(1)), parameter.at("unit").get<std::string>()};
}

std::string table_of_parameters(const json& fit, double confidence) {
  const json& parameters = fit.at("parameters");
  if (parameters.size() > parameters_listed) {
    return fmt::format(
        "<p>{} table values, drawn above; with their uncertainty in <code>fit.csv</code>.</p>\n",
        parameters.size());
  }
  const std::string interval = interval_name(confidence);
  std::vector<std::vector<std::string>> rows{
      {"parameter", "value", "standard error", fmt::format("{:g} % interval", 100.0 * confidence), "unit"}};
  const bool own = fit.contains("per_recording");
  for (const auto& [name, parameter] : parameters.items()) {
    const bool shared = !own || !fit.at("per_recording").begin()->contains(name);
    if (shared) rows.push_back(parameter_row(name, parameter, interval));
  }
  if (own) {
    for (const auto& [recording, theirs] : fit.at("per_recording").items()) {
      for (const auto& [name, parameter] : theirs.items())
        rows.push_back(parameter_row(name + " of " + recording, parameter, interval));
    }
  }
  return html_table(rows);
}

/// Blue for parameters that stand in for each other's opposite, orange for those that do for each other.
std::string shaded_cell(const json& value) {
  if (!value.is_number()) return "<td class=\"share\">-</td>";
  const double r = value.get<double>();
  const char* const colour = r > 0.0 ? "213, 94, 0" : "0, 114, 178";
  return fmt::format("<td class=\"share\" style=\"background: rgba({}, {:.2f})\">{:.2f}</td>", colour,
                     0.6 * std::min(1.0, std::abs(r)), r);
}

std::string correlation_table(const json& fit) {
  if (!fit.contains("correlation")) return {};
  const json& names = fit.at("correlation").at("parameters");
  const json& matrix = fit.at("correlation").at("matrix");
  if (names.size() < 2 || names.size() > max_searched || matrix.size() != names.size()) return {};
  std::string html =
      "<p class=\"soft\">Correlation of the estimates; near 1 or -1 the data tell only a combination of the "
      "two.</p>\n"
      "<div class=\"scroll\"><table>\n<tr><th></th>";
  for (const json& name : names) html += "<th>" + escaped(name.get<std::string>()) + "</th>";
  html += "</tr>\n";
  for (std::size_t row = 0; row < matrix.size(); ++row) {
    html += "<tr><td>" + escaped(names[row].get<std::string>()) + "</td>";
    for (const json& value : matrix[row]) html += shaded_cell(value);
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

/// Value and error of a profile's parameter, and whether it is searched on a logarithmic scale.
struct Centre {
  double value = 0.0;
  double error = 0.0;
  double quantile = 0.0;
  std::string unit;
  bool logarithmic = false;
  bool known = false;
  [[nodiscard]] double deviation(double at) const {
    return logarithmic ? value / error * std::log(at / value) : (at - value) / error;
  }
};

Centre centre_of(const FittedTrace& trace, const std::string& name, const std::string& interval) {
  Centre centre;
  const json& parameters = trace.fit.at("parameters");
  if (!parameters.contains(name)) return centre;
  const json& parameter = parameters.at(name);
  centre.unit = parameter.at("unit").get<std::string>();
  if (!parameter.at("std_error").is_number() || !parameter.at(interval).at(1).is_number()) return centre;
  centre.value = parameter.at("value").get<double>();
  centre.error = parameter.at("std_error").get<double>();
  centre.known = centre.error > 0.0;
  for (const models::ParameterInfo& info : trace.law.law.parameters()) {
    if (info.name == name) centre.logarithmic = info.scale == models::Scale::logarithmic;
  }
  if (centre.known) centre.quantile = centre.deviation(parameter.at(interval).at(1).get<double>());
  return centre;
}

Chart profile_chart(const FittedTrace& trace, const json& profile, double confidence) {
  const std::string name = profile.at("parameter").get<std::string>();
  const Centre centre = centre_of(trace, name, interval_name(confidence));
  Chart chart{.title = fmt::format("Profile of {}", name),
              .x_label = centre.unit.empty() ? name : fmt::format("{} [{}]", name, centre.unit),
              .y_label = "rise of squares",
              .width_px = 450,
              .height_px = 270};
  Curve curve{
      .x = profile.at("value").get<std::vector<double>>(), .y = {}, .colour = trace.colour, .width = 2.0};
  for (const double deviation : profile.at("deviation").get<std::vector<double>>())
    curve.y.push_back(deviation * deviation);
  if (curve.x.size() < 2) return chart;
  double highest = *std::max_element(curve.y.begin(), curve.y.end());
  Range range{curve.x.front(), curve.x.back()};
  chart.log_x = centre.logarithmic && range.begin > 0.0 && range.end > log_profile_from * range.begin;
  if (chart.log_x) {
    range = {std::max(range.begin, centre.value / widest), std::min(range.end, centre.value * widest)};
    chart.x_range = range;
  }
  if (centre.known) {
    constexpr int points = 60;
    Curve parabola{.x = {}, .y = {}, .colour = Colour::grey, .dashed = true};
    for (int i = 0; i <= points; ++i) {
      const double share = static_cast<double>(i) / points;
      const double x = chart.log_x ? range.begin * std::pow(range.end / range.begin, share)
                                   : range.begin + share * (range.end - range.begin);
      parabola.x.push_back(x);
      parabola.y.push_back(std::pow(centre.deviation(x), 2));
    }
    chart.curves.push_back(std::move(parabola));
    const double limit = centre.quantile * centre.quantile;
    chart.horizontal.push_back({.at = limit, .label = fmt::format("{:g} %", 100.0 * confidence)});
    highest = std::max(highest, 1.2 * limit);
  }
  chart.y_range = {0.0, 1.1 * highest};
  chart.curves.push_back(std::move(curve));
  return chart;
}

std::string profile_part(const FittedTrace& trace, double confidence) {
  if (!trace.fit.contains("profiles") || trace.fit.at("profiles").size() > max_searched) return {};
  std::vector<Chart> charts;
  for (const json& profile : trace.fit.at("profiles")) {
    Chart chart = profile_chart(trace, profile, confidence);
    if (!chart.curves.empty()) charts.push_back(std::move(chart));
  }
  if (charts.empty()) return {};
  return "<p class=\"soft\">The sum of squares with one parameter held and the others following, in units of "
         "its rise at one standard error; dashed: the parabola on which the intervals above rest.</p>\n" +
         figures_in_pairs(charts);
}

}  // namespace

std::string parameter_part(const FittedTrace& trace, double confidence) {
  std::string html = "<h3>" + escaped(trace.model) + "</h3>\n" + table_of_parameters(trace.fit, confidence);
  for (const json& warning : trace.fit.at("warnings"))
    html += "<p class=\"soft\">" + escaped(warning.get<std::string>()) + "</p>\n";
  return html + correlation_table(trace.fit) + profile_part(trace, confidence);
}

}  // namespace kerf::bench

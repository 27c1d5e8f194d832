#include "report/comparison.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <fmt/core.h>

#include "html/html.h"
#include "report/fit_view.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr double log_errors_from = 30.0;  ///< ratio of the largest to the smallest error
constexpr std::size_t letters_of_a_name = 17;

std::vector<json> by_error(const json& fits) {
  std::vector<json> all(fits.at("fits").begin(), fits.at("fits").end());
  std::stable_sort(all.begin(), all.end(),
                   [](const json& a, const json& b) { return compared_error(a) < compared_error(b); });
  return all;
}

bool has_any(const json& fits, const char* name) {
  const json& all = fits.at("fits");
  return std::any_of(all.begin(), all.end(),
                     [&](const json& fit) { return fit.contains(name) && fit.at(name).is_number(); });
}

void scale(Chart& chart) {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  const auto widen = [&](double value) {
    if (value > 0.0) smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  };
  for (const Curve& curve : chart.curves) {
    for (const double x : curve.x) widen(x);
  }
  for (const Marker& marker : chart.vertical) widen(marker.at);
  if (!(largest > 0.0)) return;
  chart.log_x = largest > log_errors_from * smallest;
  chart.x_range = chart.log_x ? Range{smallest / 1.5, 1.5 * largest} : Range{0.0, 1.08 * largest};
  for (Marker& marker : chart.vertical) marker.label_after = !chart.log_x && marker.at < 0.4 * largest;
}

}  // namespace

std::string comparison_table(const json& fits, const std::string& unit) {
  std::vector<std::vector<std::string>> rows{
      {"law", "free", "rmse [" + unit + "]", "rmse rendered [" + unit + "]", "largest [" + unit + "]", "R²",
       "AIC", "BIC", "rmse held out [" + unit + "]", "held out as rendered [" + unit + "]", "outside JND",
       "converged"}};
  const bool tested = has_any(fits, "test_rmse");
  if (tested) rows[0].insert(rows[0].begin() + 10, "rmse in the test [" + unit + "]");
  for (const json& fit : fits.at("fits")) {
    rows.push_back({fit.at("model").get<std::string>(),
                    fmt::format("{}", fit.at("free_parameters").get<int>()), number_text(fit.at("rmse")),
                    number_text(fit.at("rmse_rendered")), number_text(fit.at("max_abs")),
                    number_text(fit.at("r2"), "{:.4f}"), number_text(fit.at("aic"), "{:.0f}"),
                    number_text(fit.at("bic"), "{:.0f}"), number_text(fit.at("cv_rmse")),
                    number_text(fit.value("cv_rmse_rendered", json(nullptr))),
                    fmt::format("{:.1f} %", 100.0 * fit.at("jnd_fraction").get<double>()),
                    fit.at("converged").get<bool>() ? "yes" : "no"});
    if (tested) rows.back().insert(rows.back().begin() + 10, number_text(fit.at("test_rmse")));
  }
  rows.push_back({"straight line", "2", number_text(fits.at("line_rmse")), "", "", "", "", "",
                  number_text(fits.value("line_cv_rmse", json(nullptr)))});
  return html_table(rows);
}

Chart comparison_chart(const json& fits, const std::string& unit) {
  Chart chart{.title = "Root mean square error of each law",
              .x_label = "root mean square error [" + unit + "]",
              .y_label = ""};
  const auto laws = by_error(fits);
  const auto rows = static_cast<double>(laws.size());
  Curve all{.label = "fitted", .x = {}, .y = {}, .colour = Colour::grey, .mark = Mark::points, .width = 4.0};
  Curve held_out{.label = "held out",
                 .x = {},
                 .y = {},
                 .colour = Colour::vermillion,
                 .mark = Mark::points,
                 .width = 3.0};
  Curve rendered{.label = "held out, as rendered",
                 .x = {},
                 .y = {},
                 .colour = Colour::green,
                 .mark = Mark::points,
                 .width = 2.5};
  Curve tested{.label = "test", .x = {}, .y = {}, .colour = Colour::blue, .mark = Mark::points, .width = 2.5};
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const double y = rows - static_cast<double>(i);
    chart.y_ticks.push_back(
        {.at = y, .name = laws[i].at("model").get<std::string>().substr(0, letters_of_a_name)});
    const auto add = [&](Curve& curve, const char* name) {
      if (!laws[i].contains(name) || !laws[i].at(name).is_number()) return;
      curve.x.push_back(laws[i].at(name).get<double>());
      curve.y.push_back(y);
    };
    add(all, "rmse");
    add(held_out, "cv_rmse");
    add(rendered, "cv_rmse_rendered");
    add(tested, "test_rmse");
  }
  chart.y_ticks.push_back({.at = 0.0, .name = "straight line"});
  all.x.push_back(fits.at("line_rmse").get<double>());
  all.y.push_back(0.0);
  if (fits.contains("line_cv_rmse") && fits.at("line_cv_rmse").is_number()) {
    held_out.x.push_back(fits.at("line_cv_rmse").get<double>());
    held_out.y.push_back(0.0);
  }
  for (Curve* curve : {&all, &held_out, &rendered, &tested}) {
    if (!curve->x.empty()) chart.curves.push_back(std::move(*curve));
  }
  if (fits.contains("jnd") && fits.at("jnd").get<double>() > 0.0) {
    Marker& jnd = chart.vertical.emplace_back();
    jnd.at = fits.at("jnd").get<double>();
    jnd.label = "what a person feels (JND)";
  }
  if (fits.contains("floor") && fits.at("floor").at("velocity").is_number())
    chart.vertical.push_back({.at = fits.at("floor").at("velocity").get<double>(), .label = "floor"});
  scale(chart);
  chart.y_range = {-0.6, rows + 1.2};
  chart.height_px = 110 + 24 * static_cast<int>(laws.size() + 2);
  return chart;
}

}  // namespace kerf::bench

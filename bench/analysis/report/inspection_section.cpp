#include <algorithm>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "html/html.h"
#include "report/charts.h"
#include "report/fit_view.h"
#include "report/result_sections.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

std::string signal_table(const json& signals) {
  std::vector<std::vector<std::string>> rows{
      {"signal", "unit", "quantum", "noise", "zeros", "dead zone", "clipped", "outliers"}};
  for (const auto& [name, value] : signals.items()) {
    const json& signal = value;
    const auto clipped = [&](const char* end) {
      return signal.contains(end) && signal.at(end).is_object() && signal.at(end).value("clipped", false);
    };
    const json zeros = signal.value("zeros", json::object());
    rows.push_back(
        {name, signal.value("unit", std::string()), number_text(signal.value("quantum", json(nullptr))),
         number_text(signal.value("noise", json(nullptr))),
         zeros.is_object() ? number_text(zeros.value("rows", json(nullptr)), "{:.0f}") : "-",
         signal.value("dead_zone", false) ? "yes" : "no", clipped("least") || clipped("most") ? "yes" : "no",
         number_text(signal.value("outliers", json(nullptr)), "{:.0f}")});
  }
  return html_table(rows);
}

std::string reasons_of_flags(const json& cycle) {
  std::string reasons;
  for (const json& flag : cycle.at("flags"))
    reasons += (reasons.empty() ? "" : "; ") + flag.at("reason").get<std::string>();
  return reasons;
}

std::string cycle_table(const json& cycles) {
  std::vector<std::vector<std::string>> rows{{"cycle", "begin [s]", "closing [s]", "hold [s]", "opening [s]",
                                              "peak", "closing work [J]", "flagged"}};
  for (const json& cycle : cycles) {
    rows.push_back({fmt::format("{}", cycle.at("number").get<int>()), number_text(cycle.at("begin_s")),
                    number_text(cycle.at("closing_s")), number_text(cycle.at("hold_s")),
                    number_text(cycle.at("opening_s")), number_text(cycle.at("peak")),
                    number_text(cycle.at("closing_work")), reasons_of_flags(cycle)});
  }
  return html_table(rows);
}

/// Force over time with what is flagged behind it, each with its number.
Chart flagged_chart(const json& cycles, const schema::RecordedRows& rows, std::size_t axis) {
  Chart chart = force_chart(rows.about(), rows, axis);
  chart.title = "Force over time, flagged cycles in yellow";
  double highest = 0.0;
  for (const Curve& curve : chart.curves) {
    for (const double y : curve.y) highest = std::max(highest, y);
  }
  for (const json& cycle : cycles) {
    if (cycle.at("good").get<bool>()) continue;
    const double begin_s = cycle.at("begin_s").get<double>();
    chart.bands.push_back(
        {.begin = begin_s, .end = begin_s + cycle.at("duration_s").get<double>(), .colour = Colour::yellow});
    chart.labels.push_back(
        {.x = begin_s, .y = highest, .text = fmt::format("{}", cycle.at("number").get<int>())});
  }
  return chart;
}

}  // namespace

std::string inspection_section(const FoundResult& result, const schema::RecordedRows& rows,
                               std::size_t axis) {
  const json& inspection = result.json;
  std::string html = "<h2>What it is worth</h2>\n" + whose(result);
  for (const json& warning : inspection.at("warnings"))
    html += "<p class=\"soft\">" + escaped(warning.get<std::string>()) + "</p>\n";
  html += signal_table(inspection.at("signals"));
  const json cycles = inspection.at("cycles").value("list", json::array());
  const bool flagged =
      std::ranges::any_of(cycles, [](const json& cycle) { return !cycle.at("good").get<bool>(); });
  const bool forceful =
      rows.width(schema::Column::force_measured) + rows.width(schema::Column::force_commanded) > 0;
  if (flagged && forceful && result.belongs == Belongs::here)
    html += html_figure(draw(flagged_chart(cycles, rows, axis)));
  return cycles.empty() ? html : html + cycle_table(cycles);
}

}  // namespace kerf::bench

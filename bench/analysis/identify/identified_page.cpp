#include "identify/identified_page.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "files/json_number.h"
#include "html/html.h"
#include "plot/chart_json.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

std::string in_words(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("unknown");
}

std::string table_of_numbers(const json& numbers) {
  std::vector<std::vector<std::string>> rows{{"number", "value", "interval of 95 %", "unit"}};
  for (const json& number : numbers) {
    const double lower = number_from(number.at("lower"));
    const double upper = number_from(number.at("upper"));
    rows.push_back({number.at("name").get<std::string>(), in_words(number_from(number.at("value"))),
                    std::isfinite(lower) || std::isfinite(upper)
                        ? fmt::format("{} to {}", in_words(lower), in_words(upper))
                        : std::string(),
                    number.at("unit").get<std::string>()});
  }
  return html_table(rows);
}

std::string drawn_charts(const json& of) {
  const auto charts = of.find("charts");
  if (charts == of.end()) return {};
  std::vector<Chart> all;
  for (const json& one : *charts) all.push_back(chart_from_json(one.at("figure")));
  std::string html;
  for (const std::string& svg : draw_all(all)) html += html_figure(svg);
  return html;
}

Answer answer_of(const json& axis) {
  const auto fits = axis.find("fits");
  if (!axis.at("problem").get<std::string>().empty() || fits == axis.end() || fits->is_null())
    return Answer::partly;
  return fits->get<bool>() ? Answer::good : Answer::bad;
}

std::string axis_body(const json& axis) {
  std::string html = fmt::format("<h2>Axis {}</h2>\n", escaped(axis.at("name").get<std::string>()));
  std::string answer = "<strong>" + escaped(axis_verdict(axis)) + "</strong>";
  const std::string problem = axis.at("problem").get<std::string>();
  if (!problem.empty()) answer += "<br>" + escaped(problem);
  if (axis.contains("why_not")) {
    for (const json& why : axis.at("why_not")) answer += "<br>" + escaped(why.get<std::string>());
  }
  html += html_answer(answer_of(axis), answer);
  if (axis.contains("numbers")) html += table_of_numbers(axis.at("numbers"));
  html += drawn_charts(axis);
  const auto z_width = axis.find("z_width");
  if (z_width == axis.end() || z_width->is_null()) return html;
  html += "<h3>Z-width</h3>\n<ul>\n";
  for (const json& line : z_width->at("in_words"))
    html += "<li>" + escaped(line.get<std::string>()) + "</li>\n";
  return html + "</ul>\n";
}

}  // namespace

std::string axis_verdict(const json& axis) {
  if (!axis.contains("fits")) return "nothing was found";
  const std::string verdict = axis.at("verdict").get<std::string>();
  if (axis.at("fits").is_null())
    return "unknown whether the model fits" + (verdict.empty() ? "" : ": " + verdict);
  const std::string said = verdict.empty() ? "no other data to try it on" : verdict;
  return (axis.at("fits").get<bool>() ? "the model fits: " : "the model does not fit: ") + said;
}

std::string identified_body(const json& identified) {
  std::string html = fmt::format(
      "<p>{}, {}, {}.</p>\n", escaped(identified.at("device").get<std::string>()),
      escaped(identified.at("model").get<std::string>()),
      identified.at("held").get<bool>() ? "held in a hand: mass and friction are those of both" : "free");
  for (const json& axis : identified.at("axes")) html += axis_body(axis);
  return html + drawn_charts(identified);
}

}  // namespace kerf::bench

#include "choose/choice_page.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "html/html.h"
#include "recordings/axes.h"
#include "recordings/axis_series.h"
#include "report/charts.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr double least_drawn_jnd = 1e-4;  ///< less is drawn there

std::string number(const json& value, const char* format = "{:.3g}") {
  return value.is_null() ? "-" : fmt::format(fmt::runtime(format), value.get<double>());
}

std::string deadline_in_words(const json& deadline) {
  if (deadline.is_null()) return "-";
  if (deadline.at("held").get<bool>())
    return fmt::format("held, {:.1f} us", deadline.at("compute_p999_us").get<double>());
  return deadline.at("machine_late").get<bool>() ? "machine late" : "NOT held";
}

std::string candidate_table(const json& all, const LawChoice& choice) {
  std::vector<std::vector<std::string>> rows{{"law", "parameters",
                                              fmt::format("error [{}]", choice.force_unit), "JND",
                                              "tick [µs]", "deadlines", "stable", "why passed over"}};
  for (const json& one : all.at("candidates")) {
    const Stable stable = stable_from(one.at("stable"));
    const auto why = one.at("passed_over").get<std::string>();
    rows.push_back({one.at("law").get<std::string>(),
                    fmt::format("{}", one.at("parameters").get<std::size_t>()), number(one.at("held_out")),
                    number(one.at("held_out_jnd"), "{:.2g}"), number(one.at("tick_us"), "{:.3f}"),
                    deadline_in_words(one.at("deadline")),
                    std::string(stable == Stable::no ? "NO" : name_of(stable)),
                    why.empty() ? std::string(taken_in_words(choice)) : why});
  }
  return html_table(rows);
}

std::string effect_table(const json& all) {
  std::vector<std::vector<std::string>> rows{{"effect", "verdict", "least error, in JNDs, and its law"}};
  for (const json& one : all.at("effects")) {
    rows.push_back({one.at("effect").get<std::string>(), one.at("verdict").get<std::string>(),
                    one.at("why").get<std::string>()});
  }
  return html_table(rows);
}

std::string parameter_table(const json& parameters) {
  std::vector<std::vector<std::string>> rows{{"parameter", "value", "interval", "unit"}};
  for (const auto& [name, value] : parameters.items()) {
    const json& one = value;
    rows.push_back({name, number(one.at("value"), "{:.5g}"),
                    number(one.at("lower"), "{:.5g}") + " to " + number(one.at("upper"), "{:.5g}"),
                    one.at("unit").get<std::string>()});
  }
  return html_table(rows);
}

/// Force over position: what was recorded, and what the law gives along the same path.
Chart law_chart(const schema::Recording& recording, std::size_t axis_place, const LawChoice& choice) {
  const Candidate& taken = choice.candidates.at(*choice.taken);
  const schema::Axis& axis = recording.axes[axis_place];
  const DrawnUnit unit = drawn_position(axis);
  const AxisSeries series = fit_series(recording, axis_place, choice.contact);
  std::vector<double> position = series.penetration;
  for (double& value : position) value *= unit.factor;
  const auto cloud = [&](const std::string& label, std::vector<double> force, Colour colour) {
    return thinned({.label = label,
                    .x = position,
                    .y = std::move(force),
                    .colour = colour,
                    .mark = Mark::points,
                    .width = 1.2},
                   4000);
  };
  return {.title = "The law along the recorded path",
          .x_label = fmt::format("penetration [{}]", unit.unit),
          .y_label = fmt::format("force [{}]", axis.force_unit),
          .curves = {cloud("recorded", series.force, Colour::grey),
                     cloud(taken.law.name, render(without_rendering_aids(taken.file->law), series),
                           Colour::vermillion)}};
}

}  // namespace

Chart choice_chart(const json& all) {
  const bool fidelities = !all.contains("recording");  // of one law: they have as many parameters
  Curve within{.label = "within the JND", .colour = Colour::blue, .mark = Mark::points, .width = 4.0};
  Curve beyond{.label = "passed over", .colour = Colour::grey, .mark = Mark::points, .width = 4.0};
  const bool serves = all.at("choice").value("serves", true);
  Curve taken{
      .label = serves ? "taken" : "best", .colour = Colour::vermillion, .mark = Mark::points, .width = 6.0};
  for (const json& one : all.at("candidates")) {
    if (one.at("held_out_jnd").is_null()) continue;
    Curve& curve = one.at("law") == all.at("choice").at("law") ? taken
                   : one.at("within_jnd").get<bool>()          ? within
                                                               : beyond;
    curve.x.push_back(one.at(fidelities ? "tick_us" : "parameters").get<double>());
    curve.y.push_back(std::max(one.at("held_out_jnd").get<double>(), least_drawn_jnd));
  }
  Chart chart{.title = fidelities ? "Error against the cost of a tick"
                                  : "Error on held-out data against the number of parameters",
              .x_label = fidelities ? "cost of a tick [µs]" : "parameters",
              .y_label = "error [JND]",
              .log_x = true,
              .log_y = true};
  std::pair least{std::numeric_limits<double>::infinity(), 1.0};  // the JND is always seen
  std::pair most{0.0, 1.0};
  for (Curve* curve : {&beyond, &within, &taken}) {
    for (std::size_t i = 0; i < curve->x.size(); ++i) {
      least = {std::min(least.first, curve->x[i]), std::min(least.second, curve->y[i])};
      most = {std::max(most.first, curve->x[i]), std::max(most.second, curve->y[i])};
    }
    if (!curve->x.empty()) chart.curves.push_back(std::move(*curve));
  }
  chart.horizontal.push_back({.at = 1.0, .label = "JND"});
  chart.x_range = {least.first / 1.2, most.first * 1.2};
  chart.y_range = {least.second / 1.5, most.second * 1.5};
  return chart;
}

std::string choice_page(const json& all, const std::filesystem::path& file, const LawChoice& choice) {
  const json& made = all.at("choice");
  const auto name = all.at("name").get<std::string>();
  std::string body = fmt::format("<h1>Which law serves {}</h1>\n<p class=\"soft\">{}</p>\n", escaped(name),
                                 escaped(choice.held_out));
  body += fmt::format("<p class=\"answer{}\">{}.</p>\n", choice.serves ? "" : " bad", escaped(choice.why));
  if (!choice.blame.empty()) body += fmt::format("<p>What is to blame: {}.</p>\n", escaped(choice.blame));
  for (const std::string& warning : choice.warnings)
    body += fmt::format("<p class=\"soft\">{}.</p>\n", escaped(warning));
  if (choice.taken && !file.empty()) {
    const schema::Recording recording = schema::read_recording(file);
    const std::size_t axis = find_axis(recording, all.at("axis").get<std::string>());
    body += html_figure(draw(law_chart(recording, axis, choice)));
    body += "<details><summary>Its parameters</summary>\n" + parameter_table(made.at("parameters")) +
            "</details>\n";
  }
  if (!choice.effects.empty()) body += "<h2>Which effects matter</h2>\n" + effect_table(all);
  body += "<h2>All candidates</h2>\n" + html_figure(draw(choice_chart(all))) + candidate_table(all, choice);
  return html_page(name, body);
}

}  // namespace kerf::bench

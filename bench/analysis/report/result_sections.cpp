#include "report/result_sections.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "html/html.h"
#include "plot/plot.h"
#include "report/fit_view.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;
using Table = std::vector<std::vector<std::string>>;

std::string heading(const char* title, const FoundResult& result) {
  return fmt::format("<h2>{}</h2>\n{}", title, whose(result));
}

std::string yes_no(const json& value) {
  return value.is_boolean() ? (value.get<bool>() ? "yes" : "no") : "not known";
}

std::string soft(const std::string& text) { return "<p class=\"soft\">" + escaped(text) + "</p>\n"; }

double number_or_break(const json& value) { return value.is_number() ? value.get<double>() : line_break; }

Chart cost_chart(const json& chart) {
  Chart picture{.title = "Cost of a tick against error",
                .x_label = "p99.9 of a tick [us]",
                .y_label = "error [JND]",
                .log_x = true,
                .log_y = true,
                .legend_below = true,
                .height_px = 420};
  Curve others{.label = "law and fidelity", .colour = Colour::grey, .mark = Mark::circles, .width = 4.0};
  Curve front{.label = "on the front", .colour = Colour::vermillion, .mark = Mark::crosses, .width = 5.0};
  for (const json& point : chart.at("points")) {
    const double cost_us = 1e-3 * number_or_break(point.at("p999_ns"));
    const double error = number_or_break(point.at("error_jnd"));
    if (!(cost_us > 0.0 && error > 0.0)) continue;
    Curve& curve = point.at("on_front").get<bool>() ? front : others;
    curve.x.push_back(cost_us);
    curve.y.push_back(error);
  }
  for (Curve* curve : {&others, &front}) {
    if (!curve->x.empty()) picture.curves.push_back(std::move(*curve));
  }
  picture.horizontal.push_back({.at = 1.0, .label = "JND"});
  return picture;
}

Chart limits_chart(const json& study) {
  Chart picture{.title = "Where it holds, by strokes",
                .x_label = "depth [mm]",
                .y_label = "rate [Hz]",
                .log_y = true,
                .legend_below = true,
                .height_px = 380};
  Curve holds{.label = "no stroke gains energy", .colour = Colour::blue, .mark = Mark::points, .width = 1.5};
  Curve fails{
      .label = "a stroke gains energy", .colour = Colour::vermillion, .mark = Mark::points, .width = 1.5};
  for (const json& cell : study.at("cells")) {
    Curve& curve = cell.at("stable").get<bool>() ? holds : fails;
    curve.x.push_back(1e3 * cell.at("depth_m").get<double>());
    curve.y.push_back(cell.at("rate_hz").get<double>());
  }
  for (Curve* curve : {&holds, &fails}) {
    if (!curve->x.empty()) picture.curves.push_back(std::move(*curve));
  }
  return picture;
}

}  // namespace

std::string whose(const FoundResult& result) {
  const std::string file = result.file.filename().string();
  if (result.belongs == Belongs::here) return "";
  if (result.belongs == Belongs::elsewhere) return soft(file + " is of another recording.");
  return soft(file + " does not say which recording it is of.");
}

std::string choice_section(const FoundResult& result) {
  const json& choice = result.json;
  const json& made = choice.at("choice");
  const bool serves = made.at("serves").get<bool>();
  const bool doubt = made.value("in_doubt", false);
  std::string text =
      fmt::format("<strong>{}: {}.</strong> {}", serves ? "It serves" : "None serves; the best",
                  made.at("law").is_string() ? escaped(made.at("law").get<std::string>()) : "none",
                  escaped(made.at("why").get<std::string>()));
  if (made.contains("blame") && made.at("blame").is_string())
    text += fmt::format(" What is to blame: {}.", escaped(made.at("blame").get<std::string>()));
  const Answer answer = !serves                                         ? Answer::bad
                        : doubt || result.belongs == Belongs::elsewhere ? Answer::partly
                                                                        : Answer::good;
  std::string html = heading("Choice among all laws", result) + html_answer(answer, text);
  Table rows{{"law", "parameters", "held out [JND]", "within the JND", "tick [us]", "stable", "passed over"}};
  for (const json& one : choice.at("candidates")) {
    rows.push_back({one.at("law").get<std::string>(), fmt::format("{}", one.at("parameters").get<int>()),
                    number_text(one.at("held_out_jnd")), yes_no(one.at("within_jnd")),
                    number_text(one.at("tick_us")), yes_no(one.value("stable", json(nullptr))),
                    one.value("passed_over", std::string())});
  }
  return html + fmt::format("<details><summary>All {} candidates</summary>\n", rows.size() - 1) +
         html_table(rows) + "</details>\n";
}

std::string chart_section(const FoundResult& result) {
  const json& chart = result.json;
  std::string html = heading("Cost against error", result);
  Chart picture = cost_chart(chart);
  if (!picture.curves.empty()) html += html_figure(draw(picture));
  Table rows{{"on the front", "fidelity", "p99.9 of a tick [us]", "error [JND]", "within the JND", "stable"}};
  for (const json& point : chart.at("points")) {
    if (!point.at("on_front").get<bool>()) continue;
    rows.push_back({point.at("law").get<std::string>(), point.at("fidelity").get<std::string>(),
                    number_text(1e-3 * number_or_break(point.at("p999_ns"))),
                    number_text(point.at("error_jnd")), yes_no(point.value("within_jnd", json(nullptr))),
                    yes_no(point.value("stable", json(nullptr)))});
  }
  return html + html_table(rows);
}

std::string stability_section(const FoundResult& result) {
  const json& study = result.json;
  std::string html = heading("Stability", result);
  const auto passive = study.find("passive");
  if (passive != study.end() && passive->is_boolean()) {
    const bool holds = passive->get<bool>();
    const std::string law = escaped(study.value("law", std::string("the law")));
    html +=
        html_answer(!holds                                 ? Answer::bad
                    : result.belongs == Belongs::elsewhere ? Answer::partly
                                                           : Answer::good,
                    holds ? fmt::format("<strong>{}: no stroke that was tried gains energy.</strong>", law)
                          : fmt::format("<strong>{}: not passive.</strong>", law));
  }
  for (const json& line : study.at("in_words")) html += "<p>" + escaped(line.get<std::string>()) + "</p>\n";
  if (study.contains("cells") && study.value("study", std::string()) == "law" && !study.at("cells").empty())
    html += html_figure(draw(limits_chart(study)));
  if (study.contains("conditions")) {
    Table rows{{"figure", "as a condition it is", "for what"}};
    for (const auto& [name, condition] : study.at("conditions").items())
      rows.push_back({name, condition.at("is").get<std::string>(), condition.at("what").get<std::string>()});
    html += html_table(rows);
  }
  return html;
}

std::string replay_section(const FoundResult& result) {
  const json& replay = result.json;
  std::string html = heading("Replayed through laws", result);
  Table errors{{"law", "axis", "rms", "rms [JND]", "worst", "at [s]", "faults"}};
  Table events{{"law", "axis", "event", "recorded", "rendered", "matched", "late [ms]"}};
  for (const json& law : replay.at("laws")) {
    const std::string name = law.at("name").get<std::string>();
    for (const json& axis : law.value("axes", json::array())) {
      const std::string along = axis.at("axis").get<std::string>();
      const std::string unit = " " + axis.value("unit", std::string());
      errors.push_back({name, along, number_text(axis.at("rms")) + unit, number_text(axis.at("rms_jnd")),
                        number_text(axis.at("worst")) + unit, number_text(axis.at("worst_at_s")),
                        fmt::format("{}", law.value("faults", 0))});
      const json kinds = axis.value("events", json::object());
      for (const auto& [kind, count] : kinds.items()) {
        const auto number = [&count = count](const char* key) {
          return fmt::format("{}", count.at(key).get<std::uint64_t>());
        };
        events.push_back({name, along, kind, number("recorded"), number("rendered"), number("matched"),
                          number_text(count.at("mean_late_ms"))});
      }
    }
  }
  html += html_table(errors);
  return events.size() > 1 ? html + html_table(events) : html;
}

std::string missing_section(const std::vector<FoundResult>& results, const std::string& recording) {
  const std::vector<std::pair<ResultKind, std::string>> commands{
      {ResultKind::inspection, fmt::format("kerf inspect {} --json > inspect.json", recording)},
      {ResultKind::choice, fmt::format("kerf choose {} -o choice", recording)},
      {ResultKind::chart, fmt::format("kerf chart {} -o chart", recording)},
      {ResultKind::stability, "kerf stability LAW.law.toml -o stability"},
      {ResultKind::replay, fmt::format("kerf replay {} --through LAW.law.toml -o replay", recording)}};
  std::string html;
  for (const auto& [kind, command] : commands) {
    if (std::ranges::any_of(results, [&](const FoundResult& one) { return one.kind == kind; })) continue;
    html += fmt::format("<p class=\"soft\">No result of {} was given: <code>{}</code> makes one.</p>\n",
                        verb_of(kind), escaped(command));
  }
  return html.empty() ? html : "<h2>Not looked at</h2>\n" + html;
}

}  // namespace kerf::bench

#include "report/results/sections.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "chart/chart_picture.h"
#include "choose/choice_page.h"
#include "html/html.h"
#include "identify/identified_page.h"
#include "plot/plot.h"
#include "report/fit_view.h"
#include "report/results/states.h"
#include "stability/map_pictures.h"
#include "stability/stability_verdict.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;
using Table = std::vector<std::vector<std::string>>;

std::string heading(const char* title, const FoundResult& result) {
  return fmt::format("<h2>{}</h2>\n{}", title, whose(result));
}

std::string within_or_not(const json& point) {
  const auto within = point.find("within_jnd");
  if (within == point.end() || !within->is_boolean()) return "not known";  // of an earlier version
  return within->get<bool>() ? "yes" : "no";
}

std::string stable_or_not(const json& point) {
  const auto stable = point.find("stable");
  return std::string(name_of(stable == point.end() ? Stable::not_judged : stable_from(*stable)));
}

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.') text += '.';
  return escaped(text);
}

std::string candidate_details(const json& candidates) {
  Table rows{{"law", "parameters", "held out [JND]", "within the JND", "tick [µs]", "stable", "passed over"}};
  for (const json& one : candidates) {
    rows.push_back({one.at("law").get<std::string>(), number_text(one.at("parameters"), "{:.0f}"),
                    number_text(one.at("held_out_jnd"), "{:.3g}"), within_or_not(one),
                    number_text(one.at("tick_us"), "{:.3g}"), stable_or_not(one),
                    one.at("passed_over").get<std::string>()});
  }
  return fmt::format("<details><summary>All {} candidates</summary>\n", rows.size() - 1) + html_table(rows) +
         "</details>\n";
}

std::string front_table(const json& points) {
  Table rows{{"on the front", "fidelity", "median of a tick [µs]", "99.9 %", "error [JND]", "within the JND",
              "stable"}};
  const auto in_us = [](const json& ns) {
    return ns.is_number() ? number_text(1e-3 * ns.get<double>(), "{:.3g}") : std::string("-");
  };
  for (const json& point : points) {
    if (!point.at("on_front").get<bool>()) continue;
    rows.push_back({point.at("law").get<std::string>(), point.at("fidelity").get<std::string>(),
                    in_us(point.at("p50_ns")), in_us(point.at("p999_ns")),
                    number_text(point.at("error_jnd"), "{:.3g}"), within_or_not(point),
                    stable_or_not(point)});
  }
  return html_table(rows);
}

/// The map of a study, if it has one. @throws std::invalid_argument that names the file.
std::optional<Chart> map_of(const FoundResult& result) {
  if (result.json.at("study") == "cases") return std::nullopt;
  try {
    return map_picture(result.json);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", result.file.string(), error.what()));
  }
}

}  // namespace

std::string whose(const FoundResult& result) {
  std::string html = fmt::format("<p class=\"soft\">From <code>{}</code>", escaped(result.name));
  if (result.belongs == Belongs::elsewhere) html += ", which is of another recording";
  if (is_outdated(result.state)) html += ", which is " + escaped(outdated_in_words(result));
  if (result.belongs == Belongs::unknown && result.kind != ResultKind::device)
    html += ", which does not say which recording it is of";
  return html + ".</p>\n";
}

std::string choice_section(const FoundResult& result) {
  const json& choice = result.json;
  const json& made = choice.at("choice");
  const bool serves = made.at("serves").get<bool>();
  const bool doubt = made.value("in_doubt", false);
  std::string text =
      fmt::format("<strong>{}: {}.</strong> {}", serves ? "It serves" : "None serves; the best",
                  made.at("law").is_string() ? escaped(made.at("law").get<std::string>()) : "none",
                  sentence(made.at("why").get<std::string>()));
  if (made.contains("blame") && made.at("blame").is_string())
    text += " What is to blame: " + sentence(made.at("blame").get<std::string>());
  const Answer answer = !serves ? Answer::bad
                        : doubt || result.belongs == Belongs::elsewhere || is_outdated(result.state)
                            ? Answer::partly
                            : Answer::good;
  std::string html = heading("Choice among all laws", result) + html_answer(answer, text);
  const Chart picture = choice_chart(choice);
  if (!picture.curves.empty()) html += html_figure(draw(picture));
  return html + candidate_details(choice.at("candidates"));
}

std::string chart_section(const FoundResult& result) {
  const json& points = result.json.at("points");
  std::string html = heading("Cost against error", result);
  if (points.empty()) return html + "<p>It has no point.</p>\n";
  return html + html_figure(draw(chart_picture(result.json))) + front_table(points);
}

std::string stability_section(const FoundResult& result) {
  const json& study = result.json;
  std::string html = heading("Stability", result);
  const auto passive = study.find("passive");
  if (passive != study.end() && passive->is_boolean()) {
    const std::string law = escaped(study.at("law").get<std::string>());
    const bool holds = passive->get<bool>();
    const Answer answer = !holds                                 ? Answer::bad
                          : result.belongs == Belongs::elsewhere ? Answer::partly
                                                                 : Answer::good;
    html += html_answer(
        answer, holds ? fmt::format("<strong>{}: no stroke that was tried gains energy.</strong>", law)
                      : fmt::format("<strong>{}: not passive.</strong>", law));
  }
  if (const auto map = map_of(result)) html += html_figure(draw(*map));
  for (const json& line : study.at("in_words")) html += "<p>" + escaped(line.get<std::string>()) + "</p>\n";
  return html;
}

std::string device_section(const FoundResult& result) {
  try {
    return heading("The device", result) + identified_body(result.json);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", result.file.string(), error.what()));
  }
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
    if (std::ranges::any_of(results, [kind = kind](const FoundResult& one) { return one.kind == kind; }))
      continue;
    html += fmt::format("<p class=\"soft\">No result of {} was given: <code>{}</code> makes one.</p>\n",
                        verb_of(kind), escaped(command));
  }
  return html.empty() ? html : "<h2>Not looked at</h2>\n" + html;
}

}  // namespace kerf::bench

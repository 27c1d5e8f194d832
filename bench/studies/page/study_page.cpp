#include "page/study_page.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/ranges.h>

#include "html/html.h"
#include "page/study_charts.h"

namespace kerf::bench {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Answer answer_of(Conclusion::Says says) {
  if (says == Conclusion::Says::yes) return Answer::good;
  return says == Conclusion::Says::no ? Answer::bad : Answer::partly;
}

std::string jnd_cell(double error, double jnd) {
  return std::isfinite(error) && jnd > 0.0 ? fmt::format("{:.2f}", error / jnd) : "-";
}

std::string conclusions_section(const StudyResults& results) {
  std::string html;
  for (const Conclusion& one : results.conclusions)
    html += html_answer(answer_of(one.says), escaped(one.sentence));
  return html;
}

std::string drawer_section(const StudyResults& results, const std::filesystem::path& folder) {
  std::vector<Chart> charts;
  for (const DrawerRecording& one : results.recordings)
    if (one.result.failure.empty()) charts.push_back(drawer_chart(one, results.plan, folder));
  std::string html = "<h2>The drawer at a glance</h2>\n<div class=\"pair\">\n";
  for (const std::string& svg : draw_all(charts)) html += html_figure(svg);
  html += "</div>\n";
  Rows rows{{"recording", "tissue", "speed", "specimen", "less the blank", "good cycles", "law",
             "held out [JND]", "counts"}};
  for (const DrawerRecording& one : results.recordings) {
    const StudiedRecording& found = one.result;
    const auto good =
        std::ranges::count_if(found.cycles, [](const StudiedCycle& cycle) { return cycle.is_good; });
    const auto law = std::ranges::find(found.laws, found.chosen, &StudiedLaw::model);
    rows.push_back({one.name, one.file.blank ? "blank" : one.file.tissue, one.file.speed,
                    one.file.specimen.empty() ? "not named" : one.file.specimen,
                    found.blank && found.blank->is_taken() ? found.blank->name : "-",
                    found.failure.empty() ? fmt::format("{} of {}", good, found.cycles.size()) : "-",
                    found.chosen.empty() ? "-" : found.chosen,
                    law == found.laws.end() ? "-" : jnd_cell(law->held_out, found.jnd),
                    one.counts() ? "yes" : "no"});
  }
  return html + html_table(rows);
}

std::string laws_section(const StudyResults& results) {
  Rows rows{{"tissue and speed", "law", "parameters", "serves in", "on held-out cycles [JND]",
             "on other specimens or recordings [JND]"}};
  for (const StudiedGroup& group : results.groups) {
    for (const LawInGroup& law : group.laws)
      rows.push_back({group.name(), law.model + (law.model == group.serving ? " (serves)" : ""),
                      fmt::format("{}", law.free_parameters),
                      fmt::format("{} of {}", law.serves, group.counted.size()),
                      in_words(law.held_out, false), in_words(law.on_others, false)});
  }
  return "<h2>Which law serves</h2>\n" + html_table(rows);
}

std::string parameters_section(const StudyResults& results) {
  std::vector<std::string> names;
  for (const StudiedGroup& group : results.groups)
    for (const StudiedQuantity& quantity : group.quantities)
      if (std::ranges::find(names, quantity.name) == names.end() && !quantity.values.empty() &&
          (quantity.name.starts_with(results.law + ".") || quantity.name == "peak" ||
           quantity.name == "work"))
        names.push_back(quantity.name);
  std::vector<Chart> charts;
  for (const std::string& name : names) charts.push_back(quantity_chart(results, name));
  std::string html = fmt::format("<h2>Peak, work and the parameters of {}</h2>\n", escaped(results.law));
  html +=
      "<p class=\"soft\">Intervals are over specimens, or over recordings where specimens are not named; "
      "none "
      "is drawn where one of either is all there is.</p>\n";
  for (const std::string& svg : draw_all(charts)) html += html_figure(svg);
  Rows rows{{"tissue and speed", "quantity", "unit", "mean (95 % interval)", "between specimens",
             "between recordings", "both together"}};
  const auto spread = [](const std::optional<population::Spread>& of) {
    return of ? fmt::format("{:.3g}", of->value) : "-";
  };
  for (const StudiedGroup& group : results.groups)
    for (const StudiedQuantity& quantity : group.quantities)
      rows.push_back({group.name(), quantity.name, quantity.unit,
                      in_words(quantity.estimate, quantity.is_logarithm),
                      spread(quantity.estimate.between_specimens),
                      spread(quantity.estimate.between_recordings), spread(quantity.estimate.together)});
  return html + "<details><summary>All quantities; spreads of positive ones are relative</summary>\n" +
         html_table(rows) + "</details>\n";
}

std::string comparisons_section(const StudyResults& results) {
  if (results.comparisons.empty()) return "";
  Rows rows{
      {"of", "first", "second", "verdict", "n", "first to second (95 %)", "Hedges' g", "p", "p by Holm"}};
  const auto number = [](const std::optional<double>& of) { return of ? fmt::format("{:.2g}", *of) : "-"; };
  for (const StudiedComparison& one : results.comparisons) {
    const population::Comparison& found = one.found;
    const auto value = [&](double of) { return one.is_logarithm ? std::exp(of) : of; };
    std::string difference = "-";
    if (found.difference)
      difference =
          fmt::format("{} {:.3g}", one.is_logarithm ? "ratio" : "difference", value(*found.difference));
    if (found.interval)
      difference +=
          fmt::format(" ({:.3g} to {:.3g})", value(found.interval->lower), value(found.interval->upper));
    rows.push_back({one.quantity, one.first, one.second, population::name_of(found.verdict),
                    fmt::format("{} and {}", found.first_units, found.second_units), difference,
                    number(found.hedges_g), found.test ? number(found.test->p) : "-",
                    found.test ? number(found.holm_p) : "-"});
  }
  return "<h2>Do tissues or speeds differ</h2>\n<p class=\"soft\">By permutation of specimens (of "
         "recordings, where "
         "those are not named), corrected for all comparisons of the study.</p>\n" +
         html_table(rows);
}

std::string files_section(const StudyResults& results) {
  Rows rows{{"file", "what is to be known"}};
  const auto add = [&](const std::string& file, const std::string& text) { rows.push_back({file, text}); };
  for (const DrawerRecording& one : results.recordings) {
    if (!one.result.failure.empty()) add(one.file.path, "could not be used: " + one.result.failure);
    if (one.result.blank && !one.result.blank->is_taken())
      add(one.file.path, "no blank is taken off it: " + one.result.blank->why_none);
    for (const std::string& doubt : one.doubts) add(one.file.path, "doubted: " + doubt);
    if (!one.file.accepted.empty()) add(one.file.path, "counts all the same: " + one.file.accepted);
    if (!one.result.not_fitted.empty()) add(one.file.path, "not fitted: " + one.result.not_fitted);
    for (const StudiedCycle& cycle : one.result.cycles)
      if (!cycle.is_good)
        add(one.file.path, fmt::format("cycle {} is flagged: {}", cycle.number, cycle.reason));
    for (const std::string& warning : one.result.warnings) add(one.file.path, warning);
  }
  for (const DrawerFile& file : results.plan.files)
    if (!file.ignored.empty()) add(file.path, "takes no part: " + file.ignored);
  const std::string blanks =
      results.plan.why_blanks.empty()
          ? ""
          : fmt::format("<p class=\"soft\">Blanks are {}: {}.</p>\n",
                        results.plan.subtracts_blanks ? "taken off" : "only told of, not taken off",
                        escaped(results.plan.why_blanks));
  return "<h2>What is to be known of each file</h2>\n" + blanks + html_table(rows);
}

}  // namespace

std::string study_page(const StudyResults& results, const std::filesystem::path& folder) {
  std::string body = fmt::format("<h1>{}</h1>\n", escaped("Study " + results.name));
  body += conclusions_section(results) + drawer_section(results, folder);
  if (!results.law.empty()) body += laws_section(results) + parameters_section(results);
  body += comparisons_section(results);
  return html_page("Study " + results.name, body + files_section(results));
}

}  // namespace kerf::bench

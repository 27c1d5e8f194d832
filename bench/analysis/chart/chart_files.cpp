#include "chart/chart_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/core.h>
#include <fmt/format.h>

#include "chart/chart_picture.h"
#include "chart/fronts.h"
#include "files/json_file.h"
#include "files/json_number.h"
#include "files/whole_file.h"
#include "html/html.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

std::vector<const ChartPoint*> front_of(const SpeedAccuracy& chart) {
  std::vector<const ChartPoint*> front;
  for (const ChartPoint& point : chart.points) {
    if (point.on_front) front.push_back(&point);
  }
  std::sort(front.begin(), front.end(),
            [](const auto* a, const auto* b) { return a->cost.p50_ns < b->cost.p50_ns; });
  return front;
}

std::vector<const ChartPoint*> cold_front_of(const SpeedAccuracy& chart) {
  std::vector<const ChartPoint*> front;
  for (const ChartPoint& point : chart.points) {
    if (point.on_cold_front) front.push_back(&point);
  }
  std::ranges::sort(front, {},
                    [&](const ChartPoint* point) { return cold_tail_ns(*point, chart.cold_tail); });
  return front;
}

json tail_name(ColdTail tail) {
  if (tail == ColdTail::none) return nullptr;
  return tail == ColdTail::p999 ? "p99.9" : "p99";
}

json to_json(const ColdCost& empty) {
  if (empty.ticks == 0) return nullptr;
  return {{"p50_ns", json_number(empty.p50_ns)},
          {"p99_ns", json_number(empty.p99_ns)},
          {"p999_ns", json_number(empty.p999_ns)},
          {"ticks", empty.ticks}};
}

json to_json(const Convergence& convergence) {
  if (convergence.refinements.empty()) return nullptr;
  json refinements = json::array();
  for (const Refinement& one : convergence.refinements)
    refinements.push_back(
        {{"fidelity", one.label}, {"factor", one.factor}, {"error_jnd", json_number(one.error_jnd)}});
  return {{"refinements", refinements},
          {"converges", convergence.known ? json(convergence.converges) : json(nullptr)},
          {"order", json_number(convergence.order)},
          {"estimate_jnd", json_number(convergence.estimate_jnd)},
          {"expected_third_jnd", json_number(convergence.expected_jnd)}};
}

std::string point_name(const ChartPoint& point) { return point.law + ", " + point.fidelity; }

std::string cost_text(double nanoseconds) {
  return std::isfinite(nanoseconds) ? fmt::format("{:.3f}", 1e-3 * nanoseconds) : std::string("-");
}

std::string stable_text(const StabilityVerdict& verdict) {
  return fmt::format("{}{}{}", name_of(verdict.stable), verdict.why.empty() ? "" : ": ", verdict.why);
}

std::vector<std::string> row_of(const ChartPoint& point) {
  return {point.law,
          point.fidelity,
          fmt::format("{}", point.parameters),
          cost_text(point.cost.p50_ns),
          cost_text(point.cost.p999_ns),
          cost_text(point.cost.cold.p50_ns),
          cost_text(point.cost.cold.p99_ns),
          cost_text(point.cost.cold.p999_ns),
          fmt::format("{}", point.cost.cold.ticks),
          fmt::format("{:.3g}", point.error_n),
          fmt::format("{:.3g}", point.error_jnd),
          fmt::format("{:.1f}", 100.0 * point.jnd_fraction),
          fmt::format("{:.3g}", point.worst_n),
          point.axis,
          stable_text(point.stability)};
}

std::vector<std::string> head_of(const SpeedAccuracy& chart) {
  const std::string& unit = chart.force_unit;
  return {"law",
          "fidelity",
          "parameters",
          "p50 [us]",
          "p99.9 [us]",
          "cold p50 [us]",
          "cold p99 [us]",
          "cold p99.9 [us]",
          "cold ticks",
          fmt::format("error [{}]", unit),
          "error [JND]",
          "outside [%]",
          fmt::format("worst [{}]", unit),
          "axis",
          "stable"};
}

}  // namespace

json chart_as_json(const SpeedAccuracy& chart) {
  json result{{"source", chart.source},
              {"reference", chart.reference},
              {"reference_error", to_json(chart.convergence)},
              {"rate_hz", chart.rate_hz},
              {"jnd_n", json_number(chart.jnd_n)},
              {"jnd_fraction_limit", jnd_fraction_limit},
              {"force_unit", chart.force_unit},
              {"compared_in", chart.one_axis ? chart.force_unit : "JND"},
              {"cold_tail", tail_name(chart.cold_tail)},
              {"empty_cold_tick", to_json(chart.empty_tick)},
              {"points", json::array()},
              {"front", json::array()},
              {"cold_front", json::array()},
              {"notes", chart.notes}};
  if (!chart.recording.empty()) {
    result["recording"] = chart.recording;
    result.update(as_json(chart.of_recording));
  }
  if (chart.contact)
    result["contact"] = {{"position", chart.contact->position}, {"direction", chart.contact->direction}};
  if (chart.cycles) {
    result["cycles"] = in_words(*chart.cycles);
    result["cycles_left_out"] = as_json(chart.cycles_left_out);
  }
  const std::vector<std::string> files = point_file_names(chart);
  auto file = files.begin();
  for (const ChartPoint& point : chart.points) {
    const bool is_unstable = point.stability.stable == Stable::no;
    result["points"].push_back({{"law", point.law},
                                {"fidelity", point.fidelity},
                                {"law_file", *file++},
                                {"parameters", point.parameters},
                                {"rate_hz", point.rate_hz},
                                {"p50_ns", json_number(point.cost.p50_ns)},
                                {"p999_ns", json_number(point.cost.p999_ns)},
                                {"cold_p50_ns", json_number(point.cost.cold.p50_ns)},
                                {"cold_p99_ns", json_number(point.cost.cold.p99_ns)},
                                {"cold_p999_ns", json_number(point.cost.cold.p999_ns)},
                                {"cold_ticks", point.cost.cold.ticks},
                                {"error_n", json_number(point.error_n)},
                                {"error_jnd", json_number(point.error_jnd)},
                                {"jnd_fraction", json_number(point.jnd_fraction)},
                                {"within_jnd", within_jnd(point)},
                                {"worst_n", json_number(point.worst_n)},
                                {"axis", point.axis},
                                {"stable", to_json(point.stability.stable)},
                                {"why_not_stable", is_unstable ? point.stability.why : ""},
                                {"why_not_judged", why_not_judged(point.stability)},
                                {"on_front", point.on_front},
                                {"on_cold_front", point.on_cold_front}});
  }
  for (const ChartPoint* point : front_of(chart)) result["front"].push_back(point_name(*point));
  for (const ChartPoint* point : cold_front_of(chart)) result["cold_front"].push_back(point_name(*point));
  return result;
}

std::string chart_csv(const SpeedAccuracy& chart) {
  std::string csv =
      "law,fidelity,parameters,rate_hz,p50_ns,p999_ns,cold_p50_ns,cold_p99_ns,cold_p999_ns,cold_ticks,error_"
      "n,"
      "error_jnd,jnd_fraction,worst_n,axis,stable,on_front,on_cold_front,force_unit\n";
  for (const ChartPoint& point : chart.points) {
    const Stable stable = point.stability.stable;
    csv += fmt::format(
        "{},{},{},{:g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{},{:.6g},{:.6g},{:.4g},{:.6g},{},{},{},{},{}\n",
        point.law, csv_quoted(point.fidelity), point.parameters, point.rate_hz, point.cost.p50_ns,
        point.cost.p999_ns, point.cost.cold.p50_ns, point.cost.cold.p99_ns, point.cost.cold.p999_ns,
        point.cost.cold.ticks, point.error_n, point.error_jnd, point.jnd_fraction, point.worst_n,
        csv_quoted(point.axis),
        stable == Stable::not_judged ? name_of(stable)
        : stable == Stable::yes      ? "1"
                                     : "0",
        point.on_front ? 1 : 0, point.on_cold_front ? 1 : 0, chart.force_unit);
  }
  return csv;
}

std::vector<std::string> point_file_names(const SpeedAccuracy& chart) {
  std::vector<std::string> names;
  for (const ChartPoint& point : chart.points) {
    std::string label;
    for (const char c : point.law + "-" + point.fidelity) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
      if (plain) label += c;
      if (!plain && !label.empty() && label.back() != '-') label += '-';
    }
    while (label.ends_with('-')) label.pop_back();
    std::string name = fmt::format("points/{}.law.toml", label);
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i)
      name = fmt::format("points/{}-{}.law.toml", label, i);
    names.push_back(name);
  }
  return names;
}

void write_chart(const SpeedAccuracy& chart, const std::filesystem::path& folder) {
  const json result = chart_as_json(chart);
  const std::string page = chart_page(chart);
  const std::string svg = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + draw(chart_picture(result));
  std::filesystem::create_directories(folder / "points");
  const std::vector<std::string> files = point_file_names(chart);
  for (std::size_t i = 0; i < files.size(); ++i) write_law_file(folder / files[i], chart.points[i].file);
  write_whole_file(folder / "chart.svg", svg);
  write_whole_file(folder / "chart.csv", chart_csv(chart));
  write_whole_file(folder / "chart.html", page);
  write_json_file(folder / "chart.json", result);
}

std::string chart_page(const SpeedAccuracy& chart) {
  std::string body = fmt::format("<h1>Speed against accuracy: {}</h1>\n", escaped(chart.source));
  body += fmt::format("<p class=\"soft\">Errors towards {}. A tick is {:.4g} us; the JND is {:.3g} {}.</p>\n",
                      escaped(chart.reference), 1e6 / chart.rate_hz, chart.jnd_n, escaped(chart.force_unit));
  if (!chart.convergence.refinements.empty())
    body += "<p class=\"soft\">" + escaped(convergence_in_words(chart.convergence)) + "</p>\n";
  body += html_figure(draw(chart_picture(chart_as_json(chart)))) + "<h2>The front</h2>\n";
  std::vector<std::vector<std::string>> rows{head_of(chart)};
  const auto front = front_of(chart);
  for (const ChartPoint* point : front) rows.push_back(row_of(*point));
  body += html_table(rows);
  if (chart.cold_tail != ColdTail::none) {
    body += fmt::format("<h2>The front by cold {}</h2>\n", tail_name(chart.cold_tail).get<std::string>());
    rows.resize(1);
    for (const ChartPoint* point : cold_front_of(chart)) rows.push_back(row_of(*point));
    body += html_table(rows);
  }
  const auto enough =
      std::find_if(front.begin(), front.end(), [](const ChartPoint* point) { return within_jnd(*point); });
  body +=
      enough == front.end()
          ? std::string("<p class=\"answer bad\">No stable point is within the JND.</p>\n")
          : fmt::format("<p class=\"answer\">The cheapest within the JND: {}, {} us, {:.3g} {}{}.</p>\n",
                        escaped(point_name(**enough)), cost_text((*enough)->cost.p50_ns), (*enough)->error_n,
                        escaped(chart.force_unit),
                        (*enough)->stability.stable == Stable::yes ? "" : "; its stability was not judged");
  body +=
      "<p class=\"soft\">Costs are percentiles of single ticks, with warm caches and with caches that were "
      "flushed before each tick. A percentile is told where ten ticks lie beyond it. Within the JND is what "
      "errs by no more than a JND, root mean square, and is outside it at no more than 5 % of the ticks in "
      "contact. Costs within 15 % and 3 ns of each other count as equal on a front, and so do errors whose "
      "difference nobody could feel; it then takes the fewest parameters.</p>\n<h2>All points</h2>\n";
  rows.resize(1);
  for (const ChartPoint& point : chart.points) rows.push_back(row_of(point));
  body += html_table(rows);
  if (!chart.notes.empty()) {
    body += "<h2>Left out</h2>\n<ul>\n";
    for (const std::string& note : chart.notes) body += "<li>" + escaped(note) + "</li>\n";
    body += "</ul>\n";
  }
  return html_page("Speed against accuracy: " + chart.source, body);
}

}  // namespace kerf::bench

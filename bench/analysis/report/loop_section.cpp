#include "report/loop_section.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <fmt/core.h>

#include <kerf/schema/recording.h>

#include "html/html.h"
#include "plot/plot.h"
#include "run/check.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

[[noreturn]] void refuse(const json::exception& error) {
  throw std::invalid_argument(fmt::format("the check is not what 'kerf check' writes: {}", error.what()));
}

/// A histogram as the outline of its buckets, four to a power of two, so that counts are comparable by eye.
Curve outline(const json& histogram, const char* label, Colour colour) {
  Curve curve{.label = label, .colour = colour, .width = 2.0};
  const json& edges = histogram.at("edges");
  const json& counts = histogram.at("counts");
  constexpr std::size_t merged = 8;
  const double floor = 0.5;  // an empty bucket on a logarithmic axis
  for (std::size_t begin = 0; begin < counts.size(); begin += merged) {
    const std::size_t end = std::min(begin + merged, counts.size());
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += counts[i].get<double>();
    for (const std::size_t edge : {begin, end}) {
      curve.x.push_back(std::max(edges[edge].get<double>(), 1e-2));
      curve.y.push_back(std::max(sum, floor));
    }
  }
  return curve;
}

std::string histogram_figure(const json& check) {
  const double period_us = 1e6 * check.at("period_s").get<double>();
  Chart chart{.title = "Wake latency and cycle time of every tick",
              .x_label = "duration [µs]",
              .y_label = "ticks",
              .log_x = true,
              .log_y = true};
  chart.curves.push_back(outline(check.at("histograms").at("wake_us"), "wake latency", Colour::blue));
  chart.curves.push_back(
      outline(check.at("histograms").at("cycle_us"), "cycle (read to record)", Colour::vermillion));
  chart.vertical.push_back({.at = period_us, .label = "deadline", .label_after = true});
  if (const json& floor = check.at("floor"); !floor.is_null()) {
    chart.vertical.push_back(
        {.at = std::max(floor.at("wake_us").at("p999").get<double>(), 1e-2), .label = "empty loop, 99.9 %"});
  }
  chart.x_range = {
      1e-2,
      std::max(10.0 * period_us, 1.2 * std::max(chart.curves[0].x.empty() ? 0.0 : chart.curves[0].x.back(),
                                                chart.curves[1].x.empty() ? 0.0 : chart.curves[1].x.back()))};
  return html_figure(draw(chart));
}

std::string stage_table(const json& check) {
  std::vector<std::vector<std::string>> rows{
      {"stage", "mean [µs]", "median", "99 %", "99.9 %", "largest", "missed"}};
  for (const auto* stage : {"wake", "read", "compute", "compute_cpu", "write", "record", "cycle"}) {
    const json& row = check.at(std::string(stage) + "_us");
    const auto number = [&](const char* key) { return fmt::format("{:.2f}", row.at(key).get<double>()); };
    const json& missed = check.at("missed_by");
    rows.push_back({stage, number("mean"), number("p50"), number("p99"), number("p999"), number("max"),
                    missed.contains(stage) ? fmt::format("{}", missed.at(stage).get<std::uint64_t>()) : ""});
  }
  return html_table(rows);
}

std::string floor_paragraph(const json& check) {
  const json& floor = check.at("floor");
  std::string html = fmt::format("<p>{} page faults and {} involuntary context switches in the loop.",
                                 check.at("page_faults").get<std::int64_t>(),
                                 check.at("involuntary_switches").get<std::int64_t>());
  if (!floor.is_null()) {
    html += fmt::format(
        " An empty loop on this machine missed {} of {} deadlines; at 99.9 % it was woken {:.1f} us late, at "
        "worst {:.0f} us.",
        floor.at("missed").get<std::uint64_t>(), floor.at("ticks").get<std::uint64_t>(),
        floor.at("wake_us").at("p999").get<double>(), floor.at("wake_us").at("max").get<double>());
  }
  return html + "</p>\n";
}

/// Ticks in which the bench did something about the force, by what it did.
std::string intervention_table(const json& check) {
  std::vector<std::vector<std::string>> rows{{"intervention", "ticks", "meaning"}};
  for (const schema::FlagInfo& flag : schema::flag_table) {
    const auto ticks = check.at("ticks_with").value(std::string(flag.name), std::uint64_t{0});
    if (ticks > 0)
      rows.push_back({std::string(flag.name), fmt::format("{}", ticks), std::string(flag.meaning)});
  }
  return rows.size() > 1 ? html_table(rows) : "<p>No intervention.</p>\n";
}

}  // namespace

std::string verdict_paragraph(const json& check) {
  try {
    const bool passed = check.at("verdict") == "pass";
    const bool known = check.at("verdict") != not_felt;
    const bool passive = check.at("passive").get<bool>();
    std::string text =
        fmt::format("<strong>Closed loop: {}.</strong> {} ticks at {:.0f} Hz",
                    !known    ? "not known"
                    : !passed ? "FAIL"
                    : passive ? "pass"
                              : "in time, but not passive",
                    check.at("ticks").get<std::uint64_t>(), 1.0 / check.at("period_s").get<double>());
    bool says_missed = false;  // a reason does, with by what
    std::string reasons;
    for (const json& reason : check.at("reasons")) {
      const auto words = reason.get<std::string>();
      says_missed = says_missed || words.find("deadlines missed") != std::string::npos;
      reasons += "; " + escaped(words);
    }
    if (!says_missed) text += fmt::format(", {} missed", check.at("missed").get<std::uint64_t>());
    text += reasons;
    text += '.';
    return html_answer(known && !passed   ? Answer::bad
                       : known && passive ? Answer::good
                                          : Answer::partly,
                       text);
  } catch (const json::exception& error) {
    refuse(error);
  }
}

std::string loop_section(const json& check) {
  try {
    std::string html = "<h2>Closed loop</h2>\n";
    html += fmt::format(
        "<p>{} on <code>{}</code>. The rendering took {:.4g} J out of the hand; it is {}.</p>\n",
        escaped(check.value("law", std::string("the law"))), escaped(check.at("device").get<std::string>()),
        check.at("energy_J").get<double>(), check.at("passive").get<bool>() ? "passive" : "not passive");
    html += stage_table(check) + floor_paragraph(check) + histogram_figure(check) + intervention_table(check);
    std::vector<std::vector<std::string>> measures{{"real-time measure", "obtained", "detail"}};
    for (const json& measure : check.at("realtime")) {
      measures.push_back({measure.at("name").get<std::string>(),
                          measure.at("obtained").get<bool>() ? "yes" : "no",
                          measure.at("detail").get<std::string>()});
    }
    return html + (measures.size() > 1 ? html_table(measures) : "<p class=\"soft\">In virtual time.</p>\n");
  } catch (const json::exception& error) {
    refuse(error);
  }
}

}  // namespace kerf::bench

#include "compare/comparison_page.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>

#include <fmt/core.h>

#include "files/file_names.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_bands = 200;  ///< intervals that are drawn

/// A column over the rows of the expected run.
Curve curve_of(const RunComparison& result, const std::vector<double>& values, const std::string& label,
               Colour colour, double width) {
  Curve curve{.label = label, .y = values, .colour = colour, .width = width};
  curve.x.reserve(values.size());
  for (std::size_t row = 0; row < values.size(); ++row) curve.x.push_back(result.runs.expected.time_of(row));
  return decimated(curve);
}

/// What columns need and a little more; empty where they hold no finite number.
Range range_of(std::initializer_list<std::span<const double>> columns) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const auto& column : columns) {
    for (const double value : column) {
      if (!std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  const double margin = 0.06 * (high - low);
  return high > low ? Range{low - margin, high + margin} : Range{};
}

void mark_outside(Chart& chart, const RunComparison& result, const compare::Tolerance& tolerance,
                  std::size_t channel) {
  const compare::ChannelComparison& about = result.comparison.channels[channel];
  const auto time_of = [&](std::size_t tick) { return result.runs.expected.time_of(tick); };
  for (const compare::Interval& one : about.intervals) {
    if (chart.bands.size() == most_bands) break;
    chart.bands.push_back({.begin = time_of(one.begin), .end = time_of(one.end), .colour = Colour::yellow});
  }
  const auto felt = std::ranges::max_element(about.bands, {}, &compare::BandLevel::thresholds);
  const auto limit = tolerance.of(about.channel.name).vibration_limit();
  if (limit && felt != about.bands.end() && felt->thresholds() > *limit) {
    const double middle = time_of(0) + felt->worst_time_s;
    chart.bands.push_back({.begin = middle - 0.125, .end = middle + 0.125, .colour = Colour::sky});
    chart.vertical.push_back(
        {.at = middle, .label = fmt::format("vibrates, {:.0f}-{:.0f} Hz", felt->from_hz, felt->to_hz)});
  }
  const auto& worst = result.comparison.worst;
  const bool has_worst = worst && worst->channel == channel && about.outside > 0;
  const bool at_once = has_worst && about.first_outside == worst->tick;
  if (about.first_outside)
    chart.vertical.push_back(
        {.at = time_of(*about.first_outside),
         .label = fmt::format("first{}, tick {}", at_once ? " and worst" : "", *about.first_outside),
         .label_after = true});
  if (has_worst && !at_once)
    chart.vertical.push_back(
        {.at = time_of(worst->tick), .label = fmt::format("worst, tick {}", worst->tick)});
}

/// Two drawings below each other as one.
std::string below_each_other(const std::string& above, const std::string& below) {
  const auto placed = [](std::string svg, int y) {
    return svg.replace(svg.find("<svg"), 4, fmt::format("<svg y=\"{}\"", y));
  };
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 680\">{}{}</svg>\n",
                     placed(above, 0), placed(below, 340));
}

std::string agreement_table(const RunComparison& result) {
  std::vector<std::vector<std::string>> rows{{"channel", "outside", "intervals", "largest difference", "JND",
                                              "RMS", "gain", "offset", "drift", "latency [ms]"}};
  for (std::size_t i = 0; i < result.comparison.channels.size(); ++i) {
    const compare::ChannelComparison& about = result.comparison.channels[i];
    const compare::ChannelAgreement& one = result.agreement[i];
    const std::string& unit = one.channel.unit;
    rows.push_back(
        {one.channel.name, fmt::format("{}", about.outside), fmt::format("{}", about.intervals.size()),
         fmt::format("{:.3g} {}", about.largest_difference, unit), fmt::format("{:.2g}", about.largest_jnds),
         fmt::format("{:.3g} {}", one.rms_difference, unit), fmt::format("{:.5g}", one.gain),
         fmt::format("{:+.3g} {}", one.offset, unit), fmt::format("{:+.3g} {}", one.drift, unit),
         one.latency_s ? fmt::format("{:+.4g} +- {:.2g}", 1e3 * *one.latency_s, 1e3 * one.latency_std_error_s)
                       : "unknown"});
  }
  return "<div class=\"scroll\">" + html_table(rows) + "</div>\n";
}

std::string band_table(const RunComparison& result) {
  std::vector<std::vector<std::string>> rows{{"channel", "band [Hz]", "RMS of the difference",
                                              "worst quarter of a second", "times what is felt",
                                              "coherence"}};
  for (std::size_t i = 0; i < result.comparison.channels.size(); ++i) {
    for (const compare::BandLevel& band : result.comparison.channels[i].bands) {
      const auto& coherence = result.agreement[i].coherence;
      const auto same = std::ranges::find(coherence, band.from_hz, &compare::BandCoherence::from_hz);
      const std::string& unit = result.comparison.channels[i].channel.unit;
      rows.push_back({result.comparison.channels[i].channel.name,
                      fmt::format("{:.0f} to {:.0f}", band.from_hz, band.to_hz),
                      fmt::format("{:.3g} {}", band.rms, unit),
                      fmt::format("{:.3g} {}", band.worst_rms, unit),
                      fmt::format("{:.2g}", band.thresholds()),
                      same == coherence.end() ? "" : fmt::format("{:.3f}", same->coherence)});
    }
  }
  return rows.size() == 1 ? ""
                          : "<h2>By frequency</h2>\n<div class=\"scroll\">" + html_table(rows) + "</div>\n";
}

std::string page_of(const RunComparison& result, const std::vector<std::string>& pictures) {
  const bool passed = result.comparison.passed;
  std::string body = fmt::format("<h1>{} beside {}</h1>\n<p class=\"answer{}\">{}</p>\n", escaped(result.got),
                                 escaped(result.expected), passed ? "" : " bad",
                                 passed ? "Within the tolerance." : "Not within the tolerance.");
  for (const std::string& message : result.comparison.messages)
    body += html_answer(Answer::bad, escaped(message) + ".");
  for (const std::string& name : result.names) body += html_answer(Answer::partly, escaped(name) + ".");
  for (const std::string& note : result.notes)
    body += fmt::format("<p class=\"soft\">{}.</p>\n", escaped(note));
  if (const auto& lag = result.runs.lag)
    body += fmt::format("<p>A lag of {:+.4f} ms +- {:.4f} ms is taken out.</p>\n", 1e3 * lag->seconds,
                        1e3 * lag->std_error_s);
  body += agreement_table(result);
  for (const std::string& picture : pictures) body += html_figure(picture);
  return html_page(result.got + " beside " + result.expected, body + band_table(result));
}

}  // namespace

std::array<Chart, 2> channel_charts(const RunComparison& result, const compare::Tolerance& tolerance,
                                    std::size_t channel) {
  const compare::Channel& expected = result.runs.expected.channels[channel];
  const compare::Channel& got = result.runs.got.channels[channel];
  Chart forces{.title = expected.name + ": expected and got",
               .x_label = "time [s]",
               .y_label = fmt::format("force [{}]", expected.unit),
               .curves = {curve_of(result, expected.value, "expected", Colour::blue, 3.0),
                          curve_of(result, got.value, "got", Colour::vermillion, 1.3)},
               .y_range = range_of({expected.value, got.value}),
               .legend_below = true,
               .left_margin = 14};
  mark_outside(forces, result, tolerance, channel);
  std::vector<double> apart;
  std::vector<double> above;
  std::vector<double> below;
  for (std::size_t row = 0; row < expected.value.size(); ++row) {
    apart.push_back(got.value[row] - expected.value[row]);
    above.push_back(tolerance.of(expected.name).allowed(expected.unit, expected.value[row]));
    below.push_back(-above.back());
  }
  Chart between{.title = expected.name + ": got less expected, and what is allowed",
                .x_label = "time [s]",
                .y_label = fmt::format("difference [{}]", expected.unit),
                .curves = {curve_of(result, above, "allowed", Colour::green, 1.2),
                           curve_of(result, below, "", Colour::green, 1.2),
                           curve_of(result, apart, "difference", Colour::vermillion, 1.3)},
                .y_range = range_of({apart, above, below}),
                .legend_below = true,
                .left_margin = 14};
  mark_outside(between, result, tolerance, channel);
  return {std::move(forces), std::move(between)};
}

void write_comparison(const std::filesystem::path& folder, const RunComparison& result,
                      const RunComparisonOptions& options, bool replace) {
  std::vector<Chart> all;
  for (std::size_t i = 0; i < result.runs.expected.channels.size(); ++i) {
    for (Chart& chart : channel_charts(result, options.tolerance, i)) all.push_back(std::move(chart));
  }
  const std::vector<std::string> charts = draw_all(all);
  WholeFolder whole(folder, schema::existing_if(replace));
  std::vector<std::string> pictures;
  NewNames names;
  for (std::size_t i = 0; i + 1 < charts.size(); i += 2) {
    pictures.push_back(below_each_other(charts[i], charts[i + 1]));
    const std::string name = as_file_name(result.runs.expected.channels[i / 2].name);
    write_whole_file(whole.path() / (names.take(name).string() + ".svg"), pictures.back());
  }
  write_whole_file(whole.path() / "compare.html", page_of(result, pictures));
  write_json_file(whole.path() / "compare.json", comparison_as_json(result, options));
  whole.commit();
}

}  // namespace kerf::bench

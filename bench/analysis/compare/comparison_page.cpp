#include "compare/comparison_page.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <tuple>

#include <fmt/core.h>

#include "files/file_names.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "html/html.h"
#include "html/zoom.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_bands = 200;  ///< intervals that are drawn
constexpr double label_share = 0.25;     ///< of the width, that a label may take

/// Rows that are drawn: all of a short run; of a long one what shows every spike, and all around the places
/// that a reader will want to see closer.
std::vector<std::size_t> drawn_rows(const RunComparison& result, std::size_t channel,
                                    std::span<const double> apart) {
  constexpr std::size_t most = 4000;
  constexpr std::size_t around = 500;
  std::vector<std::size_t> rows = decimated_rows(
      {result.runs.expected.channels[channel].value, result.runs.got.channels[channel].value, apart}, most);
  if (rows.size() == apart.size()) return rows;
  const auto add_around = [&](std::size_t row) {
    const std::size_t end = std::min(apart.size(), row + around);
    for (std::size_t i = row - std::min(row, around); i < end; ++i) rows.push_back(i);
  };
  if (const auto first = result.comparison.channels[channel].first_outside) add_around(result.row_of(*first));
  const auto& worst = result.comparison.worst;
  if (worst && worst->channel == channel) add_around(result.row_of(worst->tick));
  std::ranges::sort(rows);
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

/// Columns over the rows of the expected run that are drawn.
struct DrawnColumns {
  const RunComparison& result;
  std::vector<std::size_t> rows;

  [[nodiscard]] Curve curve(const std::vector<double>& values, const std::string& label, Colour colour,
                            double width) const {
    Curve curve{.label = label, .colour = colour, .width = width};
    for (const std::size_t row : rows) {
      curve.x.push_back(result.runs.expected.time_of(row));
      curve.y.push_back(values[row]);
    }
    return curve;
  }
};

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
  const auto time_of = [&](std::size_t tick) { return result.runs.expected.time_of(result.row_of(tick)); };
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
  if (!about.first_outside) return;
  const std::size_t first = *about.first_outside;
  const bool has_worst = worst && worst->channel == channel && worst->tick != first;
  const std::size_t last = has_worst ? worst->tick : first;
  const auto share = [&](std::size_t tick) {
    return static_cast<double>(result.row_of(tick)) / static_cast<double>(result.runs.expected.rows());
  };
  // Outwards from both lines, where there is room for it; on one side of two that are near as one text.
  const bool first_before = share(first) > label_share;
  const bool last_after = share(last) < 1.0 - label_share;
  std::string of_first =
      fmt::format("first{}, tick {}", worst && worst->tick == first ? " and worst" : "", first);
  std::string of_last = fmt::format("worst, tick {}", last);
  if (!has_worst) {
    chart.vertical.push_back({.at = time_of(first), .label = of_first, .label_after = !first_before});
    return;
  }
  if (share(last) - share(first) < label_share && first_before != last_after) {
    std::string& kept = first_before ? of_first : of_last;
    kept = of_first + "; " + of_last;
    (first_before ? of_last : of_first).clear();
  }
  chart.vertical.push_back({.at = time_of(first), .label = of_first, .label_after = !first_before});
  chart.vertical.push_back({.at = time_of(last), .label = of_last, .label_after = last_after});
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

std::string page_of(const RunComparison& result, const std::vector<std::string>& figures) {
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
  if (const std::string unknown = unknown_lag_in_words(result); !unknown.empty())
    body += fmt::format("<p>{}.</p>\n", escaped(unknown));
  body += agreement_table(result);
  for (const std::string& figure : figures) body += figure;
  return html_zoom_page(result.got + " beside " + result.expected, body + band_table(result));
}

}  // namespace

std::string below_each_other(std::span<const std::string> drawings) {
  std::string all;
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    std::string svg = drawings[i];
    all += svg.replace(svg.find("<svg"), 4, fmt::format("<svg y=\"{}\"", 340 * i));
  }
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 {}\">{}</svg>\n",
                     340 * drawings.size(), all);
}

ChannelCharts channel_charts(const RunComparison& result, const compare::Tolerance& tolerance,
                             std::size_t channel) {
  const compare::Channel& expected = result.runs.expected.channels[channel];
  const compare::Channel& got = result.runs.got.channels[channel];
  const compare::Tolerance& own = tolerance.of(expected.name);
  const compare::Jnd jnd = compare::jnd_of(expected.unit);
  std::vector<double> apart;
  std::vector<double> above;
  std::vector<double> below;
  std::vector<double> jnds;
  for (std::size_t row = 0; row < expected.value.size(); ++row) {
    apart.push_back(got.value[row] - expected.value[row]);
    above.push_back(own.allowed(expected.unit, expected.value[row]));
    below.push_back(-above.back());
    jnds.push_back(apart.back() / jnd.at(expected.value[row]));
  }
  const DrawnColumns drawn{result, drawn_rows(result, channel, apart)};
  Chart forces{.title = expected.name + ": expected and got",
               .y_label = fmt::format("force [{}]", expected.unit),
               .curves = {drawn.curve(expected.value, "expected", Colour::blue, 3.0),
                          drawn.curve(got.value, "got", Colour::vermillion, 1.3)},
               .y_range = range_of({expected.value, got.value})};
  Chart between{.title = expected.name + ": got less expected, and what is allowed",
                .y_label = fmt::format("difference [{}]", expected.unit),
                .curves = {drawn.curve(above, "allowed", Colour::green, 1.2),
                           drawn.curve(below, "", Colour::green, 1.2),
                           drawn.curve(apart, "difference", Colour::vermillion, 1.3)},
                .y_range = range_of({apart, above, below})};
  const double line = own.jnd.value_or(1.0);
  const std::string of_line = fmt::format("{:.3g} JND{}", line, own.jnd ? " allowed" : "");
  Chart felt{.title = expected.name + ": the same in JNDs of the expected force",
             .y_label = "difference [JND]",
             .curves = {drawn.curve(jnds, "difference", Colour::vermillion, 1.3)},
             .horizontal = {{.at = line, .label = of_line}, {.at = -line, .label = ""}},
             .y_range = range_of({jnds, std::array{-line, line}})};
  ChannelCharts charts{std::move(forces), std::move(between), std::move(felt)};
  for (Chart& chart : charts) {
    chart.x_label = "time [s]";
    chart.legend_below = true;
    chart.left_margin = 14;
    mark_outside(chart, result, tolerance, channel);
  }
  return charts;
}

void write_comparison(const std::filesystem::path& folder, const RunComparison& result,
                      const RunComparisonOptions& options, bool replace) {
  std::vector<Chart> all;
  for (std::size_t i = 0; i < result.runs.expected.channels.size(); ++i) {
    for (Chart& chart : channel_charts(result, options.tolerance, i)) all.push_back(std::move(chart));
  }
  const std::vector<std::string> drawings = draw_all(all);
  constexpr std::size_t each = std::tuple_size_v<ChannelCharts>;
  WholeFolder whole(folder, schema::existing_if(replace));
  std::vector<std::string> figures;
  NewNames names;
  for (std::size_t i = 0; i < result.runs.expected.channels.size(); ++i) {
    const std::string picture = below_each_other(std::span(drawings).subspan(each * i, each));
    figures.push_back(html_zoom_figure(picture, std::span(all).subspan(each * i, each)));
    const std::string name = as_file_name(result.runs.expected.channels[i].name);
    write_whole_file(whole.path() / (names.take(name).string() + ".svg"), picture);
  }
  write_whole_file(whole.path() / "compare.html", page_of(result, figures));
  write_json_file(whole.path() / "compare.json", comparison_as_json(result, options));
  whole.commit();
}

}  // namespace kerf::bench

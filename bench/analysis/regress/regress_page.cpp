#include "regress/regress_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

#include <fmt/core.h>

#include "compare/comparison_page.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "html/html.h"
#include "html/zoom.h"
#include "laws/placement.h"
#include "regress/context.h"

namespace kerf::bench {
namespace {

constexpr std::size_t ticks_around = 40;
constexpr std::array<const char*, std::tuple_size_v<ChannelCharts>> chart_names{"-whole", "-difference",
                                                                                "-jnd"};
constexpr std::size_t most_channels = 6;  ///< that are drawn of one case

Chart chart_around_worst(const RegressionOutcome& outcome) {
  const ForceDifference& worst = *outcome.comparison.worst;
  const std::size_t columns = outcome.stored.channels.size();
  const std::size_t begin = worst.tick - std::min(worst.tick, ticks_around);
  const std::size_t end =
      std::min(std::max(outcome.stored.rows(), outcome.got.rows()), worst.tick + ticks_around + 1);
  Curve expected{.label = "expected", .colour = Colour::blue, .mark = Mark::steps, .width = 3.0};
  Curve got{.label = "got", .colour = Colour::vermillion, .mark = Mark::steps, .width = 1.5};
  const double period_s = outcome.path.period_s.front();
  const auto time_of = [&](std::size_t tick) {
    return tick < outcome.path.ticks() ? outcome.path.time_s[tick] : static_cast<double>(tick) * period_s;
  };
  for (std::size_t tick = begin; tick < end; ++tick) {
    const auto add = [&](Curve& curve, const std::vector<double>& force) {
      if ((tick + 1) * columns > force.size()) return;
      curve.x.push_back(time_of(tick));
      curve.y.push_back(force[tick * columns + worst.channel]);
    };
    add(expected, outcome.stored.force);
    add(got, outcome.got.force);
  }
  const schema::ForceChannel& channel = outcome.stored.channels[worst.channel];
  return {.title = outcome.about.name + ": around the worst tick",
          .x_label = "time [s]",
          .y_label = fmt::format("force of {} [{}]", channel.name, channel.unit),
          .curves = {expected, got},
          .vertical = {{.at = time_of(worst.tick),
                        .label = fmt::format("tick {}", worst.tick),
                        .label_after = 2 * (worst.tick - begin) < end - begin}}};
}

std::string number_or_empty(double value) { return std::isnan(value) ? "" : fmt::format("{:.9g}", value); }

std::string context_section(const RegressionOutcome& outcome) {
  const auto context = context_of(outcome);
  if (context.empty()) return {};
  const models::LawAxis axis = axes_of(outcome.about)[outcome.comparison.worst->channel];
  std::vector<std::vector<std::string>> rows{
      {"tick", "time [s]", fmt::format("{} [{}]", axis.name, axis.position_unit),
       fmt::format("speed [{}/s]", axis.position_unit), fmt::format("expected [{}]", axis.force_unit),
       fmt::format("got [{}]", axis.force_unit), fmt::format("apart [{}]", axis.force_unit)}};
  for (const ContextRow& row : context) {
    rows.push_back({fmt::format("{}", row.tick), number_or_empty(row.time_s), number_or_empty(row.position),
                    number_or_empty(row.velocity), number_or_empty(row.expected), number_or_empty(row.got),
                    number_or_empty(row.got - row.expected)});
  }
  return "<div class=\"scroll\">" + html_table(rows) + "</div>\n";
}

/// Both runs beside each other, as far as both have ticks.
RunComparison whole_runs(const RegressionOutcome& outcome) {
  const double period_s = outcome.path.period_s.back();
  RunComparison result{.comparison = outcome.comparison};
  result.runs = compare::aligned(series_of(outcome.stored, period_s), series_of(outcome.got, period_s), {});
  for (compare::Series* const one : {&result.runs.expected, &result.runs.got})
    one->time_s.assign(outcome.path.time_s.begin(),
                       outcome.path.time_s.begin() +
                           static_cast<std::ptrdiff_t>(std::min(one->rows(), outcome.path.ticks())));
  return result;
}

/// The worst channel, then the others that are outside.
std::vector<std::size_t> drawn_channels(const ForceComparison& comparison) {
  std::vector<std::size_t> channels{comparison.worst->channel};
  for (std::size_t i = 0; i < comparison.channels.size() && channels.size() < most_channels; ++i) {
    if (i != channels.front() && comparison.channels[i].outside > 0) channels.push_back(i);
  }
  return channels;
}

std::string summary_table(const SuiteOutcome& outcome) {
  std::vector<std::vector<std::string>> rows{{"case", "law", "ticks", "result", "outside the tolerance",
                                              "different at all", "largest difference", "JND", "tick cost",
                                              "stored"}};
  for (const RegressionOutcome& one : outcome.cases) {
    const ChannelComparison* const most = farthest_channel(one.comparison);
    if (!one.error.empty()) {
      rows.push_back({one.about.name, "", "", "ERROR", "", "", "", "", "", ""});
      continue;
    }
    if (one.left_out) {
      rows.push_back({one.about.name, renderer_of(one.about), "", "left out: nothing has changed", "", "", "",
                      "", "", one.stored.date.substr(0, 10)});
      continue;
    }
    rows.push_back({one.about.name, renderer_of(one.about), fmt::format("{}", one.comparison.got_rows),
                    one.passed() ? "passed" : "FAILED", fmt::format("{}", one.comparison.outside),
                    fmt::format("{}", one.comparison.differing), largest_in_words(one.comparison),
                    most ? fmt::format("{:.2g}", most->largest_jnds) : "0",
                    one.tick_cost ? fmt::format("{:.3g}", *one.tick_cost) : "",
                    one.stored.date.substr(0, 10)});
  }
  for (const std::string& name : outcome.dropped)
    rows.push_back({name, "", "", "FAILED: no longer in the suite", "", "", "", "", "", ""});
  return "<div class=\"scroll\">" + html_table(rows) + "</div>\n";
}

/// `figures` and their drawings: the worst tick, then those of each channel, which are one to zoom.
std::string html_figures(std::span<const Figure> figures, std::span<const std::string> drawings) {
  if (figures.empty()) return {};
  std::string html = html_figure(drawings.front());
  constexpr std::size_t each = std::tuple_size_v<ChannelCharts>;
  for (std::size_t i = 1; i + each <= figures.size(); i += each) {
    std::vector<Chart> charts;
    for (const Figure& figure : figures.subspan(i, each)) charts.push_back(figure.chart);
    html += html_zoom_figure(below_each_other(drawings.subspan(i, each)), charts);
  }
  return html;
}

std::string case_section(const RegressionOutcome& outcome, std::span<const Figure> figures,
                         std::span<const std::string> drawings) {
  std::string body = fmt::format("<h2>{}</h2>\n", escaped(outcome.about.name));
  if (!outcome.error.empty()) {
    body += html_answer(Answer::bad, escaped(outcome.error) + ".");
    if (outcome.said.empty()) return body;
    return body +
           fmt::format(
               "<p class=\"soft\">The end of its standard error:</p>\n<pre class=\"scroll\">{}</pre>\n",
               escaped(outcome.said));
  }
  for (const std::string& message : outcome.messages)
    body += html_answer(Answer::bad, escaped(message) + ".");
  body += fmt::format("<p class=\"soft\">{}.</p>\n", escaped(outcome.why));
  return body + html_figures(figures, drawings) + context_section(outcome);
}

}  // namespace

std::vector<Figure> figures_of(const RegressionOutcome& outcome) {
  if (!outcome.comparison.worst) return {};
  const std::string& name = outcome.about.name;
  std::vector<Figure> figures{{.name = name + "-worst", .chart = chart_around_worst(outcome)}};
  const RunComparison runs = whole_runs(outcome);
  for (const std::size_t channel : drawn_channels(outcome.comparison)) {
    const std::string of = figures.size() == 1 ? "" : "-" + outcome.stored.channels[channel].name;
    ChannelCharts charts = channel_charts(runs, outcome.about.tolerance, channel);
    for (std::size_t i = 0; i < charts.size(); ++i) {
      charts[i].title = name + ", " + charts[i].title;
      figures.push_back({.name = name + chart_names[i] + of, .chart = std::move(charts[i])});
    }
  }
  return figures;
}

void write_regress_page(const Suite& suite, const SuiteOutcome& outcome,
                        const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_json_file(folder / "regress.json", outcome_as_json(suite, outcome));
  std::vector<Figure> figures;
  for (const RegressionOutcome& one : outcome.cases) {
    if (one.passed()) continue;
    for (Figure& figure : figures_of(one)) figures.push_back(std::move(figure));
  }
  std::vector<Chart> charts;
  for (const Figure& figure : figures) charts.push_back(figure.chart);
  const std::vector<std::string> pictures = charts.empty() ? std::vector<std::string>{} : draw_all(charts);
  for (std::size_t i = 0; i < figures.size(); ++i)
    write_whole_file(folder / (figures[i].name + ".svg"), pictures[i]);
  const std::size_t failed = outcome.failed();
  const std::size_t all = outcome.cases.size() + outcome.dropped.size() - outcome.left_out();
  std::string body = fmt::format("<h1>{}</h1>\n<p class=\"answer{}\">{}</p>\n", escaped(suite.name),
                                 failed > 0 ? " bad" : "",
                                 failed > 0 ? fmt::format("{} of {} cases did not pass.", failed, all)
                                            : fmt::format("All {} cases passed.", all));
  for (const std::string& note : outcome.notes) body += html_answer(Answer::partly, escaped(note) + ".");
  std::size_t next = 0;
  for (const RegressionOutcome& one : outcome.cases) {
    if (one.passed()) continue;
    const std::size_t count = figures_of(one).size();
    body +=
        case_section(one, std::span(figures).subspan(next, count), std::span(pictures).subspan(next, count));
    next += count;
  }
  body += "<h2>All cases</h2>\n" + summary_table(outcome);
  write_whole_file(folder / "regress.html", html_zoom_page(suite.name, body));
}

}  // namespace kerf::bench

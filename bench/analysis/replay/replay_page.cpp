#include "replay/replay_page.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/core.h>

#include <kerf/fitting/jnd.h>

#include "html/html.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr std::array colours{Colour::blue,   Colour::vermillion, Colour::green, Colour::purple,
                             Colour::orange, Colour::sky,        Colour::black};

std::pair<Chart, Chart> charts_of_axis(const Source& source, const OpenLoopResult& result, std::size_t axis) {
  const schema::Axis& about = source.recording.axes[axis];
  const fitting::Jnd& jnd = fitting::jnd_of(about.force_unit);
  Chart forces{.title = fmt::format("Force on {}, recorded and rendered on the same ticks", about.name),
               .x_label = "time [s]",
               .y_label = fmt::format("force [{}]", about.force_unit),
               .legend_below = true};
  Chart between{.title = "Rendered less recorded",
                .x_label = "time [s]",
                .y_label = "difference [JND]",
                .horizontal = {{.at = 1.0, .label = "1 JND"}, {.at = -1.0, .label = ""}},
                .legend_below = true};
  double max_jnd = 1.3;
  for (std::size_t i = 0; i < result.laws.size(); ++i) {
    for (const AxisComparison& one : result.laws[i].axes) {
      if (one.axis != axis) continue;
      const std::vector<double> time(
          source.recording.time.begin(),
          source.recording.time.begin() + static_cast<std::ptrdiff_t>(one.rendered.size()));
      if (forces.curves.empty()) {
        forces.curves.push_back(decimated(
            {.label = "recorded", .x = time, .y = one.recorded, .colour = Colour::grey, .width = 3.0}));
      }
      Curve law{.label = result.laws[i].name,
                .x = time,
                .y = one.rendered,
                .colour = colours[i % colours.size()],
                .width = 1.2,
                .dashed = i >= colours.size()};
      forces.curves.push_back(decimated(law));
      for (std::size_t row = 0; row < law.y.size(); ++row)
        law.y[row] = (one.rendered[row] - one.recorded[row]) / jnd.at(one.recorded[row]);
      between.curves.push_back(decimated(law));
      max_jnd = std::max(max_jnd, 1.05 * one.worst_jnd);
    }
  }
  between.y_range = {-max_jnd, max_jnd};
  return {std::move(forces), std::move(between)};
}

std::string number(const json& value, const char* format) {
  return value.is_null() ? "-" : fmt::format(fmt::runtime(format), value.get<double>());
}

std::string force_table(const json& all) {
  std::vector<std::vector<std::string>> rows{{"law", "axis", "against", "samples", "rms", "rms [JND]",
                                              "worst", "at [s]", "worst [JND]", "identical rows"}};
  for (const json& law : all.at("laws")) {
    for (const json& one : law.at("axes")) {
      const auto unit = one.at("unit").get<std::string>();
      rows.push_back(
          {law.at("name").get<std::string>(), one.at("axis").get<std::string>(),
           one.at("against").get<std::string>(), fmt::format("{}", one.at("samples").get<std::size_t>()),
           fmt::format("{:.3g} {}", one.at("rms").get<double>(), unit), number(one.at("rms_jnd"), "{:.2f}"),
           fmt::format("{:.3g} {}", one.at("worst").get<double>(), unit),
           number(one.at("worst_at_s"), "{:.3f}"), number(one.at("worst_jnd"), "{:.2f}"),
           one.contains("identical_rows")
               ? fmt::format("{} of {}", one.at("identical_rows").get<std::size_t>(),
                             one.at("untouched_rows").get<std::size_t>())
               : "-"});
    }
  }
  return html_table(rows);
}

std::string event_table(const json& all) {
  std::vector<std::vector<std::string>> rows{
      {"law", "axis", "event", "recorded", "rendered", "matched", "late, mean [ms]", "late, worst [ms]"}};
  for (const json& law : all.at("laws")) {
    for (const json& one : law.at("axes")) {
      for (const auto& [kind, value] : one.at("events").items()) {
        const json& match = value;
        rows.push_back({law.at("name").get<std::string>(), one.at("axis").get<std::string>(), kind,
                        fmt::format("{}", match.at("recorded").get<std::size_t>()),
                        fmt::format("{}", match.at("rendered").get<std::size_t>()),
                        fmt::format("{}", match.at("matched").get<std::size_t>()),
                        number(match.at("mean_late_ms"), "{:.1f}"),
                        number(match.at("worst_late_ms"), "{:.1f}")});
      }
    }
  }
  return html_table(rows);
}

}  // namespace

std::vector<Chart> replay_charts(const Source& source, const OpenLoopResult& result) {
  std::set<std::size_t> axes;
  for (const LawTrace& law : result.laws) {
    for (const AxisComparison& one : law.axes) axes.insert(one.axis);
  }
  std::vector<Chart> charts;
  for (const std::size_t axis : axes) {
    auto [forces, between] = charts_of_axis(source, result, axis);
    charts.push_back(std::move(forces));
    charts.push_back(std::move(between));
  }
  return charts;
}

std::string replay_page(const json& all, const std::vector<std::string>& charts) {
  const auto name = all.at("recording").get<std::string>();
  std::string body = fmt::format(
      "<h1>{} through {} law{}</h1>\n<p class=\"soft\">{} rows from {:g} to {:g} s, one a tick; every law "
      "saw the same motion.</p>\n",
      escaped(name), all.at("laws").size(), all.at("laws").size() == 1 ? "" : "s",
      all.at("rows").get<std::size_t>(), all.at("from_s").get<double>(), all.at("to_s").get<double>());
  for (const json& note : all.at("notes"))
    body += fmt::format("<p class=\"soft\">{}.</p>\n", escaped(note.get<std::string>()));
  for (const std::string& chart : charts) body += html_figure(chart);
  body += "<h2>Forces</h2>\n" + force_table(all) + "<h2>Events</h2>\n" + event_table(all);
  return html_page(name, body);
}

}  // namespace kerf::bench

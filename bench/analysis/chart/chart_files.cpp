#include "chart/chart_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/core.h>
#include <fmt/format.h>

#include "files/json_file.h"
#include "files/json_number.h"
#include "files/whole_file.h"
#include "html/html.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr double least_share_of_jnd = 1e-4;
constexpr double cheapest_us = 2e-3;
constexpr std::array colours{Colour::blue,   Colour::vermillion, Colour::green, Colour::purple,
                             Colour::orange, Colour::sky,        Colour::grey,  Colour::yellow};

double cost_us(const ChartPoint& point) { return std::max(1e-3 * point.cost.p50_ns, cheapest_us); }

/// Error as it is drawn, in N where one axis is judged, else in JNDs.
class Scale {
 public:
  explicit Scale(const SpeedAccuracy& chart)
      : in_newtons_(chart.one_axis), jnd_(chart.one_axis ? chart.jnd_n : 1.0) {}
  [[nodiscard]] double jnd() const { return jnd_; }
  [[nodiscard]] double at(const ChartPoint& point) const {
    const double error = in_newtons_ ? point.error_n : point.error_jnd;
    return std::max(std::isfinite(error) ? error : most(), least());
  }
  [[nodiscard]] double least() const { return least_share_of_jnd * jnd_; }
  [[nodiscard]] double most() const { return 1e3 * jnd_; }
  [[nodiscard]] std::string unit() const { return in_newtons_ ? "N" : "JND"; }

 private:
  bool in_newtons_;
  double jnd_;
};

std::vector<const ChartPoint*> front_of(const SpeedAccuracy& chart) {
  std::vector<const ChartPoint*> front;
  for (const ChartPoint& point : chart.points) {
    if (point.on_front) front.push_back(&point);
  }
  std::sort(front.begin(), front.end(),
            [](const auto* a, const auto* b) { return a->cost.p50_ns < b->cost.p50_ns; });
  return front;
}

std::string point_name(const ChartPoint& point) { return point.law + ", " + point.fidelity; }

void add_laws(const SpeedAccuracy& chart, const Scale& scale, Chart& picture) {
  std::vector<std::string> laws;
  for (const ChartPoint& point : chart.points) {
    if (std::find(laws.begin(), laws.end(), point.law) == laws.end()) laws.push_back(point.law);
  }
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const bool again = i >= colours.size();
    Curve curve{.label = laws[i],
                .colour = colours[i % colours.size()],
                .mark = again ? Mark::circles : Mark::points,
                .width = 4.0};
    for (const ChartPoint& point : chart.points) {
      if (point.law != laws[i]) continue;
      curve.x.push_back(std::min(scale.at(point), scale.most()));
      curve.y.push_back(cost_us(point));
    }
    picture.curves.push_back(curve);
  }
}

void add_unstable(const SpeedAccuracy& chart, const Scale& scale, Chart& picture) {
  Curve crosses{.label = "not stable", .colour = Colour::black, .mark = Mark::crosses, .width = 7.0};
  for (const ChartPoint& point : chart.points) {
    if (point.stable) continue;
    crosses.x.push_back(std::min(scale.at(point), scale.most()));
    crosses.y.push_back(cost_us(point));
  }
  if (!crosses.x.empty()) picture.curves.push_back(crosses);
}

void add_front(const SpeedAccuracy& chart, const Scale& scale, Chart& picture) {
  const auto front = front_of(chart);
  if (front.empty()) return;
  Curve stairs{.label = "front", .colour = Colour::black, .width = 2.0};
  Curve rare{.label = "p99.9, front", .colour = Colour::black, .mark = Mark::circles, .width = 4.0};
  double right = picture.x_range.end;
  for (const ChartPoint* point : front) {
    for (const double x : {right, scale.at(*point)}) {
      stairs.x.push_back(x);
      stairs.y.push_back(cost_us(*point));
    }
    right = scale.at(*point);
    rare.x.push_back(right);
    rare.y.push_back(std::max(cost_us(*point), 1e-3 * point->cost.p999_ns));
    const bool near_left = std::log(right / picture.x_range.begin) <
                           0.45 * std::log(picture.x_range.end / picture.x_range.begin);
    picture.labels.push_back(
        {.x = right, .y = cost_us(*point), .text = point_name(*point), .left = !near_left});
  }
  stairs.x.push_back(right);
  stairs.y.push_back(picture.y_range.end);
  picture.curves.insert(picture.curves.begin(), {stairs, rare});
}

std::string cost_text(double nanoseconds) {
  return std::isfinite(nanoseconds) ? fmt::format("{:.3f}", 1e-3 * nanoseconds) : std::string("-");
}

std::vector<std::string> row_of(const ChartPoint& point) {
  return {point.law,
          point.fidelity,
          fmt::format("{}", point.parameters),
          cost_text(point.cost.p50_ns),
          cost_text(point.cost.p999_ns),
          cost_text(point.cost.cold_p50_ns),
          cost_text(point.cost.cold_p999_ns),
          fmt::format("{:.3g}", point.error_n),
          fmt::format("{:.3g}", point.error_jnd),
          fmt::format("{:.3g}", point.worst_n),
          point.axis,
          point.stable ? "yes" : "no: " + point.why};
}

const std::vector<std::string> head{
    "law",       "fidelity",    "parameters", "p50 [us]", "p99.9 [us]", "cold p50 [us]", "cold p99.9 [us]",
    "error [N]", "error [JND]", "worst [N]",  "axis",     "stable"};

}  // namespace

json chart_as_json(const SpeedAccuracy& chart) {
  json result{{"source", chart.source},
              {"reference", chart.reference},
              {"rate_hz", chart.rate_hz},
              {"jnd_n", json_number(chart.jnd_n)},
              {"compared_in", chart.one_axis ? "N" : "JND"},
              {"points", json::array()},
              {"front", json::array()},
              {"notes", chart.notes}};
  const std::vector<std::string> files = point_file_names(chart);
  auto file = files.begin();
  for (const ChartPoint& point : chart.points) {
    result["points"].push_back({{"law", point.law},
                                {"fidelity", point.fidelity},
                                {"law_file", *file++},
                                {"parameters", point.parameters},
                                {"rate_hz", point.rate_hz},
                                {"p50_ns", json_number(point.cost.p50_ns)},
                                {"p999_ns", json_number(point.cost.p999_ns)},
                                {"cold_p50_ns", json_number(point.cost.cold_p50_ns)},
                                {"cold_p999_ns", json_number(point.cost.cold_p999_ns)},
                                {"error_n", json_number(point.error_n)},
                                {"error_jnd", json_number(point.error_jnd)},
                                {"worst_n", json_number(point.worst_n)},
                                {"axis", point.axis},
                                {"stable", point.stable},
                                {"why_not_stable", point.why},
                                {"on_front", point.on_front}});
  }
  for (const ChartPoint* point : front_of(chart)) result["front"].push_back(point_name(*point));
  return result;
}

std::string chart_csv(const SpeedAccuracy& chart) {
  std::string csv =
      "law,fidelity,parameters,rate_hz,p50_ns,p999_ns,cold_p50_ns,cold_p999_ns,error_n,error_jnd,worst_n,"
      "axis,"
      "stable,on_front\n";
  for (const ChartPoint& point : chart.points) {
    csv += fmt::format("{},{},{},{:g},{:.4g},{:.4g},{:.4g},{:.4g},{:.6g},{:.6g},{:.6g},{},{},{}\n", point.law,
                       csv_quoted(point.fidelity), point.parameters, point.rate_hz, point.cost.p50_ns,
                       point.cost.p999_ns, point.cost.cold_p50_ns, point.cost.cold_p999_ns, point.error_n,
                       point.error_jnd, point.worst_n, csv_quoted(point.axis), point.stable ? 1 : 0,
                       point.on_front ? 1 : 0);
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
  const std::string page = chart_page(chart);
  const std::string svg = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n" + draw(chart_picture(chart));
  std::filesystem::create_directories(folder / "points");
  const std::vector<std::string> files = point_file_names(chart);
  for (std::size_t i = 0; i < files.size(); ++i) write_law_file(folder / files[i], chart.points[i].file);
  write_whole_file(folder / "chart.svg", svg);
  write_whole_file(folder / "chart.csv", chart_csv(chart));
  write_whole_file(folder / "chart.html", page);
  write_json_file(folder / "chart.json", chart_as_json(chart));
}

Chart chart_picture(const SpeedAccuracy& chart) {
  const Scale scale(chart);
  const double tick_us = 1e6 / chart.rate_hz;
  Chart picture{.title = fmt::format("Cost of a tick over error: {}", chart.source),
                .x_label = fmt::format("error, root mean square [{}]", scale.unit()),
                .y_label = "cost of a tick, median [us]",
                .log_x = true,
                .log_y = true,
                .width_px = 1000,
                .height_px = 620};
  double least = scale.jnd();
  double most = scale.jnd();
  double cheapest = 0.1;
  double dearest = tick_us;
  for (const ChartPoint& point : chart.points) {
    least = std::min(least, scale.at(point));
    most = std::max(most, std::min(scale.at(point), scale.most()));
    cheapest = std::min(cheapest, cost_us(point));
    dearest = std::max(dearest, cost_us(point));
  }
  picture.x_range = {0.5 * least, 3.0 * most};
  picture.y_range = {0.5 * cheapest, 3.0 * dearest};
  add_laws(chart, scale, picture);
  add_front(chart, scale, picture);
  add_unstable(chart, scale, picture);
  picture.vertical.push_back({.at = scale.jnd(), .label = "JND", .label_after = true});
  picture.horizontal.push_back({.at = tick_us, .label = fmt::format("a tick at {:g} Hz", chart.rate_hz)});
  picture.horizontal.push_back({.at = 0.5 * tick_us, .label = "half of it"});
  return picture;
}

std::string chart_page(const SpeedAccuracy& chart) {
  std::string body = fmt::format("<h1>Speed against accuracy: {}</h1>\n", escaped(chart.source));
  body += fmt::format("<p class=\"soft\">Errors towards {}. A tick is {:.4g} us; the JND is {:.3g} N.</p>\n",
                      escaped(chart.reference), 1e6 / chart.rate_hz, chart.jnd_n);
  body += html_figure(draw(chart_picture(chart))) + "<h2>The front</h2>\n";
  std::vector<std::vector<std::string>> rows{head};
  const auto front = front_of(chart);
  for (const ChartPoint* point : front) rows.push_back(row_of(*point));
  body += html_table(rows);
  const auto enough = std::find_if(front.begin(), front.end(),
                                   [](const ChartPoint* point) { return point->error_jnd <= 1.0; });
  body +=
      enough == front.end()
          ? std::string("<p class=\"answer bad\">No stable point is within the JND.</p>\n")
          : fmt::format("<p class=\"answer\">The cheapest within the JND: {}, {} us, {:.3g} N.</p>\n",
                        escaped(point_name(**enough)), cost_text((*enough)->cost.p50_ns), (*enough)->error_n);
  body +=
      "<p class=\"soft\">Costs are medians and 99.9th percentiles of single ticks, with warm caches and with "
      "caches that were flushed before each tick. Costs within 15 % and 3 ns of each other, and errors "
      "within 2 "
      "%, count as equal on the front; it then takes the fewest parameters.</p>\n<h2>All points</h2>\n";
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

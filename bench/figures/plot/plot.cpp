#include "plot/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>

#include "plot/colours.h"
#include "plot/gnuplot.h"

namespace kerf::bench {
namespace {

constexpr std::array colours{"#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7",
                             "#E69F00", "#56B4E9", "#F0E442", "#8A8A8A"};

constexpr double letter_px = 7.5;  ///< of the font below, on average

std::string style_of(const Curve& curve) {
  switch (curve.mark) {
    case Mark::line:
      return fmt::format("lines lw {} dt {}", curve.width, curve.dashed ? 2 : 1);
    case Mark::points:
      return fmt::format("points pt 7 ps {}", 0.2 * curve.width);
    case Mark::circles:
      return fmt::format("points pt 6 lw 1.5 ps {}", 0.2 * curve.width);
    case Mark::crosses:
      return fmt::format("points pt 2 lw 2 ps {}", 0.2 * curve.width);
    case Mark::steps:
      return fmt::format("histeps lw {}", curve.width);
    case Mark::boxes:
      return "boxes fs solid 0.6 noborder";
  }
  return "lines";
}

void add_data(std::string& script, const Curve& curve, std::size_t index) {
  auto out = std::back_inserter(script);
  fmt::format_to(out, "$d{} << EOD\n", index);
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i])) {
      fmt::format_to(out, "{:.7g} {:.7g}\n", curve.x[i], curve.y[i]);
    } else {
      script += '\n';
    }
  }
  script += "EOD\n";
}

/// Runs of one colour as one rectangle.
void add_cells(std::string& script, const Cells& cells) {
  if (cells.kind.empty()) return;
  const std::vector<double>& along = cells.upwards ? cells.y_edges : cells.x_edges;
  const std::vector<double>& across = cells.upwards ? cells.x_edges : cells.y_edges;
  const std::size_t in_a_row = along.size() - 1;
  for (std::size_t row = 0; row + 1 < across.size(); ++row) {
    const auto colour = [&](std::size_t i) { return cells.kinds[cells.kind[row * in_a_row + i]].colour; };
    for (std::size_t begin = 0, end = 0; begin < in_a_row; begin = end) {
      while (end < in_a_row && colour(end) == colour(begin)) ++end;
      std::pair left_bottom{along[begin], across[row]};
      std::pair right_top{along[end], across[row + 1]};
      if (cells.upwards) {
        std::swap(left_bottom.first, left_bottom.second);
        std::swap(right_top.first, right_top.second);
      }
      fmt::format_to(std::back_inserter(script),
                     "set object rectangle from first {}, first {} to first {}, first {} behind fc rgb '{}' "
                     "fs solid 0.3 noborder\n",
                     left_bottom.first, left_bottom.second, right_top.first, right_top.second,
                     hex_of(colour(begin)));
    }
  }
}

/// The curves, and one beyond the axes for each colour of cells: the legend names it.
std::vector<Curve> curves_of(const Chart& chart) {
  std::vector<Curve> curves = chart.curves;
  for (const CellKind& kind : chart.cells.kinds) {
    if (kind.dotted) continue;
    curves.push_back({.label = kind.label,
                      .x = {-1.0},
                      .y = {-1.0},
                      .colour = kind.colour,
                      .mark = Mark::points,
                      .width = 8.0});
  }
  return curves;
}

/// One number a decade is hardly any on a logarithmic axis of less than two: 1, 2 and 5 of each, or all
/// digits where those are fewer than three. None for a longer axis.
std::vector<NamedTick> ticks_of_few_decades(const Range& range) {
  if (!(range.begin > 0.0 && range.begin < range.end && range.end < 100.0 * range.begin)) return {};
  const auto ticks_at = [&](std::initializer_list<double> factors) {
    std::vector<NamedTick> ticks;
    for (double decade = std::pow(10.0, std::floor(std::log10(range.begin))); decade <= range.end;
         decade *= 10.0) {
      for (const double factor : factors) {
        const double at = factor * decade;
        if (at >= range.begin && at <= range.end)
          ticks.push_back({.at = at, .name = fmt::format("{:g}", at)});
      }
    }
    return ticks;
  };
  std::vector<NamedTick> ticks = ticks_at({1.0, 2.0, 5.0});
  return ticks.size() < 3 ? ticks_at({1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0}) : ticks;
}

/// Of the numbers that an axis without a range has to hold; of those above zero if it is logarithmic.
Range needed_range(const std::vector<Curve>& curves, std::vector<double> Curve::*numbers, bool logarithmic) {
  constexpr double none = std::numeric_limits<double>::infinity();
  Range range{.begin = none, .end = logarithmic ? 0.0 : -none};
  for (const Curve& curve : curves) {
    for (const double value : curve.*numbers) {
      if (!std::isfinite(value) || (logarithmic && value <= 0.0)) continue;
      range.begin = std::min(range.begin, value);
      range.end = std::max(range.end, value);
    }
  }
  return range;
}

/// Names of ticks are formats of numbers to gnuplot.
std::string without_formats(const std::string& name) {
  std::string plain;
  for (const char c : name) plain += c == '%' ? std::string("%%") : std::string(1, c);
  return plain;
}

/// How long the axis below a chart is: what the numbers and the legend beside it leave.
double x_axis_px(const Chart& chart, const std::vector<Curve>& curves) {
  constexpr double numbers_px = 90.0;
  constexpr double sample_px = 50.0;
  std::size_t longest = 0;
  for (const Curve& curve : curves) longest = std::max(longest, curve.label.size());
  const bool beside = longest > 0 && !chart.legend_below;
  return chart.width_px - numbers_px - (beside ? sample_px + letter_px * static_cast<double>(longest) : 0.0);
}

/// Whether names along a linear axis would run into each other.
bool names_touch(const std::vector<NamedTick>& ticks, const Range& range, double axis_px) {
  constexpr double apart_px = 8.0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    const double way_px = axis_px * std::abs(ticks[i].at - ticks[i - 1].at) / (range.end - range.begin);
    const std::size_t letters = ticks[i].name.size() + ticks[i - 1].name.size();
    if (way_px < 0.5 * letter_px * static_cast<double>(letters) + apart_px) return true;
  }
  return false;
}

std::string ticks_of(char axis, const std::vector<NamedTick>& ticks, bool slanted = false) {
  if (ticks.empty()) return {};
  std::string script = fmt::format("set {}tics {}(", axis, slanted ? "rotate by 30 right " : "");
  for (const NamedTick& tick : ticks) {
    script += fmt::format("{}{} {}", &tick == &ticks.front() ? "" : ", ",
                          gnuplot_text(without_formats(tick.name)), tick.at);
  }
  return script + ")\n";
}

std::string script_of(const Chart& chart, const std::string& output) {
  std::string script = "reset session\n";
  auto out = std::back_inserter(script);
  fmt::format_to(out, "set terminal svg noenhanced size {},{} font 'DejaVu Sans,13' background '#ffffff'\n",
                 chart.width_px, chart.height_px);
  fmt::format_to(out, "set output {}\nset title {}\nset xlabel {}\nset ylabel {}\n", gnuplot_text(output),
                 gnuplot_text(chart.title), gnuplot_text(chart.x_label), gnuplot_text(chart.y_label));
  script +=
      "set encoding utf8\nset border 3 lc rgb '#444444'\nset tics nomirror out\nset format '%.6g'\nset grid "
      "lc rgb '#dddddd' lw "
      "1 dt 1\n"
      "set key outside right top samplen 2 spacing 1.2\nset autoscale noextend\n";
  script +=
      "set offsets graph 0, graph 0, graph 0.05, graph 0.05\n";  // each says of itself that it is a share
  if (chart.legend_below) {
    script += "set key outside below center horizontal\n";
    // An empty line of its own keeps the legend from the label above it.
    fmt::format_to(out, "set xlabel {}.\"\\n \"\n", gnuplot_text(chart.x_label));
  }
  if (chart.log_x) script += "set logscale x\n";
  if (chart.log_y) script += "set logscale y\n";
  if (chart.log_x || chart.log_y) script += "set offsets 0, 0, 0, 0\n";
  for (const auto& [axis, range] : {std::pair{'x', chart.x_range}, std::pair{'y', chart.y_range}}) {
    if (range.begin < range.end) fmt::format_to(out, "set {}range [{}:{}]\n", axis, range.begin, range.end);
  }
  const std::vector<Curve> curves = curves_of(chart);
  if (std::all_of(curves.begin(), curves.end(), [](const Curve& curve) { return curve.label.empty(); }))
    script += "unset key\nset rmargin 3\n";
  if (chart.left_margin > 0) fmt::format_to(out, "set lmargin {}\n", chart.left_margin);
  if (chart.right_margin > 0) fmt::format_to(out, "set rmargin {}\n", chart.right_margin);
  const auto held = [&](const Range& given, bool logarithmic, std::vector<double> Curve::*numbers) {
    return given.begin < given.end ? given : needed_range(chart.curves, numbers, logarithmic);
  };
  const Range x_range = held(chart.x_range, chart.log_x, &Curve::x);
  const Range y_range = held(chart.y_range, chart.log_y, &Curve::y);
  const auto ticks = [&](const std::vector<NamedTick>& given, bool logarithmic, const Range& range) {
    return given.empty() && logarithmic ? ticks_of_few_decades(range) : given;
  };
  const bool slanted = !chart.log_x && names_touch(chart.x_ticks, x_range, x_axis_px(chart, curves));
  script += ticks_of('x', ticks(chart.x_ticks, chart.log_x, x_range), slanted) +
            ticks_of('y', ticks(chart.y_ticks, chart.log_y, y_range));
  for (const Band& band : chart.bands) {
    fmt::format_to(
        out,
        "set object rectangle from first {}, graph 0 to first {}, graph 1 behind fc rgb '{}' fs solid 0.18 "
        "noborder\n",
        band.begin, band.end, hex_of(band.colour));
  }
  add_cells(script, chart.cells);
  for (const Marker& marker : chart.vertical) {
    fmt::format_to(
        out, "set arrow from first {0}, graph 0 to first {0}, graph 1 nohead lc rgb '{1}' lw 1.5 dt 3\n",
        marker.at, hex_of(Colour::vermillion));
    fmt::format_to(out, "set label {} at first {}, graph 0.96 {} textcolor rgb '{}'\n",
                   gnuplot_text(marker.label), marker.at,
                   marker.label_after ? "left offset 0.5,0" : "right offset -0.5,0",
                   hex_of(Colour::vermillion));
  }
  for (const Marker& marker : chart.horizontal) {
    fmt::format_to(out,
                   "set arrow from graph 0, first {0} to graph 1, first {0} nohead lc rgb '{1}' lw 1 dt 3\n",
                   marker.at, hex_of(Colour::grey));
    fmt::format_to(out, "set label {} at graph 0.99, first {} right offset 0,0.6 textcolor rgb '{}'\n",
                   gnuplot_text(marker.label), marker.at, hex_of(Colour::grey));
  }
  for (const PointLabel& label : chart.labels) {
    if (std::isfinite(label.text_x)) {
      fmt::format_to(out,
                     "set arrow from first {}, first {} to first {}, first {} nohead lc rgb '{}' lw 0.7\n",
                     label.x, label.y, label.text_x, label.text_y, hex_of(Colour::grey));
      fmt::format_to(out, "set label {} at first {}, first {} {} front font 'DejaVu Sans,11'\n",
                     gnuplot_text(label.text), label.text_x, label.text_y,
                     label.left ? "right offset -0.3,0" : "left offset 0.3,0");
      continue;
    }
    fmt::format_to(out, "set label {} at first {}, first {} {} front font 'DejaVu Sans,11'\n",
                   gnuplot_text(label.text), label.x, label.y,
                   label.left ? "right offset -0.6,-0.6" : "left offset 0.6,0.6");
  }
  for (std::size_t i = 0; i < curves.size(); ++i) add_data(script, curves[i], i);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Curve& curve = curves[i];
    fmt::format_to(out, "{} $d{} using 1:2 with {} lc rgb '{}' {}", i == 0 ? "plot" : ",", i, style_of(curve),
                   hex_of(curve.colour),
                   curve.label.empty() ? "notitle" : "title " + gnuplot_text(curve.label));
  }
  return script + "\n";
}

/// Where a column is smallest and largest within a stretch; where it is NaN only if it is nothing else.
class Spread {
 public:
  void add(std::size_t row, double value) {
    if (is_first_ || value < smallest_.value || std::isnan(smallest_.value)) smallest_ = {row, value};
    if (is_first_ || value > largest_.value || std::isnan(largest_.value)) largest_ = {row, value};
    is_first_ = false;
  }
  [[nodiscard]] std::size_t smallest() const noexcept { return smallest_.row; }
  [[nodiscard]] std::size_t largest() const noexcept { return largest_.row; }

 private:
  struct Found {
    std::size_t row = 0;
    double value = 0.0;
  };
  Found smallest_;
  Found largest_;
  bool is_first_ = true;
};

}  // namespace

std::string_view hex_of(Colour colour) noexcept { return colours[static_cast<std::size_t>(colour)]; }

std::vector<std::string> draw_all(std::span<const Chart> charts) {
  std::vector<GnuplotScript> scripts;
  for (const Chart& chart : charts)
    scripts.push_back({.title = chart.title,
                       .text = [&chart](const std::string& output) { return script_of(chart, output); }});
  return run_gnuplot(scripts);
}

std::string draw(const Chart& chart) { return draw_all(std::span(&chart, 1)).front(); }

std::vector<std::size_t> decimated_rows(std::initializer_list<std::span<const double>> columns,
                                        std::size_t most) {
  std::vector<ValueOfRow> values;
  for (const std::span<const double> column : columns)
    values.emplace_back([column](std::size_t row) { return column[row]; });
  return decimated_rows(columns.begin()->size(), values, most);
}

std::vector<std::size_t> decimated_rows(std::size_t rows, std::span<const ValueOfRow> columns,
                                        std::size_t most) {
  const std::size_t kept_of_each = 2 + 2 * columns.size();
  const std::size_t stretches = rows <= most ? rows : std::max<std::size_t>(1, most / kept_of_each);
  std::vector<std::size_t> all_kept;
  std::vector<std::size_t> kept;
  std::vector<Spread> spreads(columns.size());
  for (std::size_t stretch = 0; stretch < stretches; ++stretch) {
    const std::size_t begin = stretch * rows / stretches;
    const std::size_t end = (stretch + 1) * rows / stretches;
    spreads.assign(columns.size(), {});
    for (std::size_t row = begin; row < end; ++row) {
      for (std::size_t i = 0; i < spreads.size(); ++i) spreads[i].add(row, columns[i](row));
    }
    kept.assign({begin, end - 1});
    for (const Spread& spread : spreads) kept.insert(kept.end(), {spread.smallest(), spread.largest()});
    std::sort(kept.begin(), kept.end());
    all_kept.insert(all_kept.end(), kept.begin(), std::unique(kept.begin(), kept.end()));
  }
  return all_kept;
}

Curve decimated(const Curve& curve, std::size_t most) {
  if (curve.x.size() <= most) return curve;
  Curve fewer = curve;
  fewer.x.clear();
  fewer.y.clear();
  for (const std::size_t i : decimated_rows({curve.y}, most)) {
    fewer.x.push_back(curve.x[i]);
    fewer.y.push_back(curve.y[i]);
  }
  return fewer;
}

Curve thinned(Curve cloud, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, cloud.x.size() / most);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cloud.x.size(); i += step) {
    cloud.x[kept] = cloud.x[i];
    cloud.y[kept++] = cloud.y[i];
  }
  cloud.x.resize(kept);
  cloud.y.resize(kept);
  return cloud;
}

}  // namespace kerf::bench

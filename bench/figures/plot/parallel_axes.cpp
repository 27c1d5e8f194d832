#include "plot/parallel_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "plot/gnuplot.h"

namespace kerf::bench {
namespace {

constexpr double place_of_unknown = -0.12;

/// Lines as one block, broken between them, each point with the colour of its line.
void add_block(std::string& script, const std::string& name, const std::vector<const ParallelLine*>& lines,
               const ColourSteps& scale) {
  fmt::format_to(std::back_inserter(script), "${} << EOD\n", name);
  for (const ParallelLine* const line : lines) {
    const std::string colour =
        std::isnan(line->value) ? "#d55e00" : scale.colour_of_step(scale.step_of(line->value));
    for (std::size_t axis = 0; axis < line->at.size(); ++axis)
      fmt::format_to(std::back_inserter(script), "{} {:.4f} {}\n", axis,
                     std::isnan(line->at[axis]) ? place_of_unknown : line->at[axis],
                     std::stoi(colour.substr(1), nullptr, 16));
    script += "\n";
  }
  script += "EOD\n";
}

void add_axis(std::string& script, const ParallelAxis& axis, std::size_t place, bool has_unknown) {
  auto out = std::back_inserter(script);
  fmt::format_to(
      out, "set arrow from first {0}, first 0 to first {0}, first 1 nohead front lc rgb '#222222' lw 1.5\n",
      place);
  // By turns higher and lower, so that long names do not meet.
  fmt::format_to(out, "set label {} at first {}, first {} center font 'DejaVu Sans,12'\n",
                 gnuplot_text(axis.label), place, place % 2 == 0 ? 1.07 : 1.15);
  for (const NamedTick& tick : axis.ticks)
    fmt::format_to(
        out, "set label {} at first {}, first {:.4f} left offset 0.4,0 front font 'DejaVu Sans,11' boxed\n",
        gnuplot_text(tick.name), place, tick.at);
  if (has_unknown)
    fmt::format_to(
        out, "set label '?' at first {}, first {} left offset 0.4,0 front font 'DejaVu Sans,11' boxed\n",
        place, place_of_unknown);
}

std::string script_of(const ParallelAxes& axes, const std::string& output) {
  std::string script = fmt::format(
      "reset session\nset terminal svg noenhanced size {},{} font 'DejaVu Sans,13' background '#ffffff'\nset "
      "output "
      "{}\nset encoding utf8\nset title {}\nunset border\nunset tics\nset lmargin 9\nset rmargin 11\nset "
      "bmargin 5\nset "
      "style textbox opaque noborder fillcolor rgb '#ffffff' margins 0.3,0.2\nset xrange [0:{}]\nset yrange "
      "[-0.16:1.2]\nset key below center horizontal samplen 1.5 font 'DejaVu Sans,11' maxrows 2\n",
      axes.width_px, axes.height_px, gnuplot_text(output), gnuplot_text(axes.title), axes.axes.size() - 1);
  std::vector<bool> of_step(axes.colours.steps(), false);
  std::vector<const ParallelLine*> known;
  std::vector<const ParallelLine*> failed;
  std::vector<bool> has_unknown(axes.axes.size(), false);
  for (const ParallelLine& line : axes.lines) {
    if (line.is_failed || std::isnan(line.value)) {
      failed.push_back(&line);
    } else {
      known.push_back(&line);
      of_step[axes.colours.step_of(line.value)] = true;
    }
    for (std::size_t axis = 0; axis < line.at.size(); ++axis)
      if (std::isnan(line.at[axis])) has_unknown[axis] = true;
  }
  for (std::size_t i = 0; i < axes.axes.size(); ++i) add_axis(script, axes.axes[i], i, has_unknown[i]);
  // All in their own order, so that no step hides the others; the legend's lines are beyond the axes.
  std::string plot;
  const auto add = [&](const std::string& what) { plot += (plot.empty() ? "plot " : ", ") + what; };
  if (!known.empty()) {
    add_block(script, "known", known, axes.colours);
    add("$known using 1:2:3 with lines lw 0.8 lc rgb variable notitle");
  }
  for (std::size_t step = 0; step < of_step.size(); ++step) {
    if (!of_step[step]) continue;
    const std::string title =
        fmt::format("{}{:.3g} to {:.3g}",
                    std::ranges::find(of_step, true) == of_step.begin() + static_cast<std::ptrdiff_t>(step)
                        ? axes.colours.label + " "
                        : "",
                    axes.colours.bounds[step], axes.colours.bounds[step + 1]);
    add(fmt::format("-9 with lines lw 2 lc rgb '{}' title {}", axes.colours.colour_of_step(step),
                    gnuplot_text(title)));
  }
  if (!failed.empty()) {
    add_block(script, "failed", failed, axes.colours);
    add("$failed with lines lw 1.2 dt 2 lc rgb '#d55e00' title 'no number'");
  }
  return script + (plot.empty() ? "plot -9 notitle" : plot) + "\n";
}

}  // namespace

std::string draw(const ParallelAxes& axes) {
  const std::array scripts{GnuplotScript{
      .title = axes.title, .text = [&](const std::string& output) { return script_of(axes, output); }}};
  return run_gnuplot(scripts).front();
}

}  // namespace kerf::bench

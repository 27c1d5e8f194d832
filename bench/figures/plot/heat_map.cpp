#include "plot/heat_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "plot/gnuplot.h"

namespace kerf::bench {
namespace {

constexpr const char* no_number = "#e2e2e2";

/// Where everything stands [px], from the top left.
struct Layout {
  explicit Layout(const HeatMap& map) : width(map.width_px) {
    across = std::clamp<std::size_t>(map.across, 1, std::max<std::size_t>(map.panels.size(), 1));
    down = (map.panels.size() + across - 1) / across;
    std::size_t longest = 0;
    for (const NamedTick& tick : map.y.ticks) longest = std::max(longest, tick.name.size());
    left = 48 + 8 * static_cast<int>(std::min<std::size_t>(longest, 24));
    panel_width = (width - left - right - gap * static_cast<int>(across - 1)) / static_cast<int>(across);
    const double parts =
        static_cast<double>(map.y.parts) / static_cast<double>(std::max<std::size_t>(map.x.parts, 1));
    const double wanted = static_cast<double>(panel_width) * std::clamp(parts, 0.3, down > 2 ? 0.7 : 0.9);
    panel_height = std::clamp(static_cast<int>(wanted), 90, 430);
    height = top + static_cast<int>(down) * (panel_height + title_height) + below;
  }
  static constexpr int right = 20;
  static constexpr int gap = 14;
  static constexpr int top = 34;
  static constexpr int title_height = 28;
  static constexpr int below = 156;
  int width;
  std::size_t across;
  std::size_t down;
  int left = 0;
  int panel_width = 0;
  int panel_height = 0;
  int height = 0;

  [[nodiscard]] std::string margins(double from_left, double to_right, double from_top,
                                    double to_bottom) const {
    return fmt::format(
        "set lmargin at screen {:.6f}\nset rmargin at screen {:.6f}\nset tmargin at screen {:.6f}\nset "
        "bmargin at "
        "screen {:.6f}\n",
        from_left / width, to_right / width, 1.0 - from_top / height, 1.0 - to_bottom / height);
  }
};

std::string ticks_script(char axis, const std::vector<NamedTick>& ticks, bool named) {
  std::string script = fmt::format("set {}tics (", axis);
  for (const NamedTick& tick : ticks) {
    std::string name;
    for (const char c : named ? tick.name : "") name += c == '%' ? std::string("%%") : std::string(1, c);
    script += fmt::format("{}{} {:.6g}", &tick == &ticks.front() ? "" : ", ", gnuplot_text(name), tick.at);
  }
  return script + ")\n";
}

/// Whether a tile's number can stand in it.
bool has_room_for_numbers(const HeatMap& map, const Layout& layout) {
  return layout.panel_width / static_cast<int>(std::max<std::size_t>(map.x.parts, 1)) >= 42 &&
         layout.panel_height / static_cast<int>(std::max<std::size_t>(map.y.parts, 1)) >= 18;
}

/// Runs of one colour as one rectangle.
void add_tiles(std::string& script, const HeatMap& map, const HeatPanel& panel) {
  const auto colour = [&](const HeatTile& tile) -> std::string {
    if (!tile.is_there) return {};
    return std::isnan(tile.value) ? no_number : map.colours.colour_of_step(map.colours.step_of(tile.value));
  };
  for (std::size_t row = 0; row < map.y.parts; ++row) {
    const HeatTile* const tiles = &panel.tiles[row * map.x.parts];
    for (std::size_t begin = 0, end = 0; begin < map.x.parts; begin = end) {
      const std::string fill = colour(tiles[begin]);
      while (end < map.x.parts && colour(tiles[end]) == fill) ++end;
      if (fill.empty()) continue;
      fmt::format_to(
          std::back_inserter(script),
          "set object rectangle from first {}, first {} to first {}, first {} behind fc rgb '{}' fs solid "
          "1.0 noborder\n",
          begin, row, end, row + 1, fill);
    }
  }
}

void add_numbers(std::string& script, const HeatMap& map, const HeatPanel& panel) {
  for (std::size_t i = 0; i < panel.tiles.size(); ++i) {
    const HeatTile& tile = panel.tiles[i];
    if (!tile.is_there) continue;
    const bool known = !std::isnan(tile.value);
    const std::size_t row = i / map.x.parts;
    fmt::format_to(
        std::back_inserter(script),
        "set label '{}' at first {}, first {} center front font 'DejaVu Sans,11' textcolor rgb '{}'\n",
        known ? fmt::format("{:.3g}", tile.value) : "?", static_cast<double>(i % map.x.parts) + 0.5,
        static_cast<double>(row) + 0.5,
        known ? map.colours.ink_on_step(map.colours.step_of(tile.value)) : "#000000");
  }
}

/// Crosses and rings, in the corner where numbers are in the middle.
void add_marks(std::string& script, const HeatMap& map, const HeatPanel& panel, bool in_corner) {
  const auto block = [&](const char* name, bool HeatTile::*has) {
    fmt::format_to(std::back_inserter(script), "${} << EOD\n-9 -9\n", name);
    for (std::size_t i = 0; i < panel.tiles.size(); ++i) {
      if (!(panel.tiles[i].*has)) continue;
      const std::size_t row = i / map.x.parts;
      const double corner = in_corner ? 0.82 : 0.5;
      fmt::format_to(std::back_inserter(script), "{} {}\n",
                     static_cast<double>(i % map.x.parts) + (in_corner ? 0.92 : 0.5),
                     static_cast<double>(row) + corner);
    }
    script += "EOD\n";
  };
  block("failed", &HeatTile::has_failed);
  block("missing", &HeatTile::has_missing);
  script +=
      "plot $failed with points pt 2 ps 0.7 lw 3.5 lc rgb '#ffffff' notitle, $failed with points pt 2 ps 0.6 "
      "lw 1.5 "
      "lc rgb '#000000' notitle, $missing with points pt 6 ps 0.7 lw 3.5 lc rgb '#ffffff' notitle, $missing "
      "with points "
      "pt 6 ps 0.7 lw 1.5 lc rgb '#000000' notitle\n";
}

void add_panel(std::string& script, const HeatMap& map, const Layout& layout, std::size_t number) {
  const std::size_t column = number % layout.across;
  const std::size_t row = number / layout.across;
  const double left = layout.left + static_cast<double>(column) * (layout.panel_width + Layout::gap);
  const double top = Layout::top + Layout::title_height +
                     static_cast<double>(row) * (layout.panel_height + Layout::title_height);
  const bool is_lowest = number + layout.across >= map.panels.size();
  script += "unset object\nunset label\n";
  script += layout.margins(left, left + layout.panel_width, top, top + layout.panel_height);
  auto out = std::back_inserter(script);
  fmt::format_to(out, "set title {} offset 0,-0.7 font 'DejaVu Sans,12'\n",
                 gnuplot_text(map.panels[number].title));
  fmt::format_to(out, "set xlabel {}\nset ylabel {}\nset xrange [0:{}]\nset yrange [0:{}]\n",
                 gnuplot_text(is_lowest ? map.x.label : ""), gnuplot_text(column == 0 ? map.y.label : ""),
                 map.x.parts, map.y.parts);
  script += ticks_script('x', map.x.ticks, is_lowest) + ticks_script('y', map.y.ticks, column == 0);
  const bool numbers = has_room_for_numbers(map, layout);
  add_tiles(script, map, map.panels[number]);
  if (numbers) add_numbers(script, map, map.panels[number]);
  add_marks(script, map, map.panels[number], numbers);
}

/// What the marks mean, of those that there are.
std::string legend_of(const HeatMap& map) {
  const auto any = [&](auto is) {
    return std::ranges::any_of(map.panels,
                               [&](const HeatPanel& panel) { return std::ranges::any_of(panel.tiles, is); });
  };
  std::string text;
  const auto add = [&](bool is, const char* what) {
    if (is) text += (text.empty() ? "" : "     ") + std::string(what);
  };
  add(any([](const HeatTile& tile) { return tile.has_failed; }), "× cells failed");
  add(any([](const HeatTile& tile) { return tile.has_missing; }), "○ cells are missing");
  add(any([](const HeatTile& tile) { return tile.is_there && std::isnan(tile.value); }),
      "grey: no number is known");
  return text;
}

void add_scale(std::string& script, const HeatMap& map, const Layout& layout) {
  const ColourSteps& scale = map.colours;
  const double top = layout.height - 80;
  script += "unset object\nunset label\nset title ''\n";
  script += layout.margins(layout.left, layout.width - Layout::right, top, top + 16);
  auto out = std::back_inserter(script);
  fmt::format_to(out, "set xlabel {}\nset ylabel ''\nset xrange [0:{}]\nset yrange [0:1]\nunset ytics\n",
                 gnuplot_text(scale.label), scale.steps());
  for (std::size_t step = 0; step < scale.steps(); ++step)
    fmt::format_to(
        out,
        "set object rectangle from first {}, first 0 to first {}, first 1 behind fc rgb '{}' fs solid 1.0 "
        "noborder\n",
        step, step + 1, scale.colour_of_step(step));
  std::vector<NamedTick> ticks = map.steps_named;
  if (ticks.empty()) {
    for (std::size_t i = 0; i < scale.bounds.size(); ++i)
      ticks.push_back({.at = static_cast<double>(i), .name = fmt::format("{:.4g}", scale.bounds[i])});
  }
  script += ticks_script('x', ticks, true) + "plot -9 notitle\n";
}

std::string script_of(const HeatMap& map, const Layout& layout, const std::string& output) {
  std::string script = fmt::format(
      "reset session\nset terminal svg noenhanced size {},{} font 'DejaVu Sans,13' background '#ffffff'\nset "
      "output "
      "{}\nset encoding utf8\nset multiplot\nset border 15 lc rgb '#444444'\nset tics nomirror out scale "
      "0.5\nunset key\n",
      layout.width, layout.height, gnuplot_text(output));
  for (std::size_t i = 0; i < map.panels.size(); ++i) {
    add_panel(script, map, layout, i);
    if (i > 0) continue;
    // Once the first is drawn, so that nothing is drawn again with the others.
    script += "unset label\n";
  }
  add_scale(script, map, layout);
  // Title and legend stand on a plot of nothing over all.
  script += "unset object\nunset border\nunset xtics\nset xlabel ''\n" +
            layout.margins(0, layout.width, 0, layout.height);
  fmt::format_to(
      std::back_inserter(script),
      "set label {} at screen 0.5, screen {:.6f} center font 'DejaVu Sans,14'\nset label {} at screen 0.5, "
      "screen {:.6f} center font 'DejaVu Sans,12'\nplot -9 notitle\nunset multiplot\n",
      gnuplot_text(map.title), 1.0 - 18.0 / layout.height, gnuplot_text(legend_of(map)),
      94.0 / layout.height);
  return script;
}

}  // namespace

std::string draw(const HeatMap& map) {
  const Layout layout(map);
  const std::array scripts{GnuplotScript{
      .title = map.title, .text = [&](const std::string& output) { return script_of(map, layout, output); }}};
  return run_gnuplot(scripts).front();
}

}  // namespace kerf::bench

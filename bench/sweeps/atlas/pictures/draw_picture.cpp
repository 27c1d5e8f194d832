#include "atlas/pictures/draw_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/psychophysics/binomial.h>

#include "atlas/atlas_answer.h"
#include "atlas/pictures/axis_ticks.h"
#include "plot/heat_map.h"
#include "plot/parallel_axes.h"
#include "plot/plot.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_lines = 300;

std::string what_is_shown(const AtlasQuestion& question, const std::string& unit) {
  if (question.is_share()) return fmt::format("share of cells with {}", in_words(question.share));
  return with_unit(fmt::format("{} {}", name_of(question.statistic), question.of), unit);
}

ColourSteps steps_of(const AtlasPicture& picture, const AtlasAnswer& answer) {
  const std::string label = what_is_shown(picture.question, answer.unit);
  if (!picture.steps.empty()) return {.label = label, .bounds = picture.steps};
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  for (const AtlasTile& tile : answer.tiles) {
    if (!std::isfinite(tile.value)) continue;
    smallest = std::min(smallest, tile.value);
    largest = std::max(largest, tile.value);
  }
  if (!(smallest <= largest)) return share_steps(label);
  const bool is_share =
      picture.question.is_share() || (answer.unit == "1" && smallest >= 0.0 && largest <= 1.0);
  return is_share ? share_steps(label) : round_steps(label, smallest, largest);
}

std::string counts_in_words(const AtlasAnswer& answer) {
  std::uint32_t fewest = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t most = 0;
  for (const AtlasTile& tile : answer.tiles) {
    if (tile.cells() == 0) continue;
    fewest = std::min(fewest, tile.cells());
    most = std::max(most, tile.cells());
  }
  if (most == 0) return "No cell counts.";
  const AtlasTile& all = answer.all;
  std::string text =
      fmt::format("{} cells, {} behind each tile", all.cells(),
                  fewest == most ? fmt::format("{}", most) : fmt::format("{} to {}", fewest, most));
  if (all.computed > all.known) text += fmt::format("; {} have no number", all.computed - all.known);
  if (all.failed > 0) text += fmt::format("; {} failed", all.failed);
  if (all.missing > 0) text += fmt::format("; {} are missing", all.missing);
  return text + ".";
}

std::string part_in_words(const AtlasAxis& axis, std::size_t part) {
  return axis.names.empty() ? fmt::format("{} {} to {}", axis.column, short_number(axis.edges[part]),
                                          short_number(axis.edges[part + 1]))
                            : fmt::format("{} {}", axis.column, name_of_part(axis, part));
}

std::string with_its_unit(const std::string& text, const AtlasAxis& axis) {
  return axis.unit.empty() || axis.unit == "1" ? text : text + " " + axis.unit;
}

DrawnPicture draw_map(SweepAtlas& atlas, const AtlasPicture& picture) {
  const AtlasAnswer found = answer(atlas, picture.question);
  HeatMap map{.title = picture.title,
              .x = {},
              .y = {},
              .across = 1,
              .panels = {},
              .colours = steps_of(picture, found)};
  const std::size_t columns = found.axes[0].parts();
  const std::size_t rows = found.axes[1].parts();
  map.across = found.axes.size() > 2 ? found.axes[2].parts() : 1;
  const std::size_t down = found.axes.size() > 3 ? found.axes[3].parts() : 1;
  if (found.axes.size() == 3 && map.across > 5) map.across = (map.across + 1) / 2;
  map.x = heat_axis(found.axes[0], static_cast<std::size_t>(700 / std::max<std::size_t>(map.across, 1)));
  map.y = heat_axis(found.axes[1], 0);
  const std::size_t panels = found.tiles.size() / (columns * rows);
  for (std::size_t panel = 0; panel < panels; ++panel) {
    HeatPanel& one = map.panels.emplace_back();
    if (found.axes.size() > 2)
      one.title = with_its_unit(part_in_words(found.axes[2], panel % found.axes[2].parts()), found.axes[2]);
    if (down > 1)
      one.title +=
          ", " + with_its_unit(part_in_words(found.axes[3], panel / found.axes[2].parts()), found.axes[3]);
    for (std::size_t i = 0; i < columns * rows; ++i) {
      const AtlasTile& tile = found.tiles[panel * columns * rows + i];
      one.tiles.push_back({.value = tile.value,
                           .is_there = tile.cells() > 0,
                           .has_failed = tile.failed > 0,
                           .has_missing = tile.missing > 0});
    }
  }
  return {.svg = draw(map), .caption = counts_in_words(found)};
}

constexpr std::array series_colours{Colour::blue,   Colour::vermillion, Colour::green,
                                    Colour::purple, Colour::orange,     Colour::sky,
                                    Colour::black,  Colour::grey,       Colour::yellow};

/// Points with their intervals, as a curve of dots and one of strokes between the ends.
struct Points {
  Curve dots;
  Curve ends;

  Points(const std::string& label, std::size_t number) {
    dots.label = label;
    dots.colour = ends.colour = series_colours[number % series_colours.size()];
    dots.mark = number < series_colours.size() ? Mark::points : Mark::circles;
    dots.width = 4.0;
    ends.width = 1.5;
  }
  void add(double x, const AtlasTile& tile, bool is_share) {
    dots.x.push_back(x);
    dots.y.push_back(tile.value);
    if (!is_share || tile.known == 0) return;
    const auto held = static_cast<int>(std::lround(tile.value * tile.known));
    const auto interval = psychophysics::clopper_pearson(
        {.successes = held, .trials = static_cast<int>(tile.known)}, confidence_of_shares);
    for (const double y : {interval.lower, interval.upper}) {
      ends.x.push_back(x);
      ends.y.push_back(y);
    }
    ends.x.push_back(line_break);
    ends.y.push_back(line_break);
  }
  void move_to(Chart& chart) {
    if (!ends.x.empty()) chart.curves.push_back(std::move(ends));
    chart.curves.push_back(std::move(dots));
  }
};

void add_nominal(Chart& chart, double nominal) {
  if (!std::isnan(nominal))
    chart.horizontal.push_back({.at = nominal, .label = fmt::format("{:g}", nominal)});
}

DrawnPicture draw_lines(SweepAtlas& atlas, const AtlasPicture& picture) {
  const AtlasAnswer found = answer(atlas, picture.question);
  const AtlasAxis& x = found.axes[0];
  Chart chart{.title = picture.title, .x_label = with_unit(x.column, x.unit)};
  chart.y_label = what_is_shown(picture.question, found.unit);
  const bool numbered = !x.values.empty() && !std::isnan(x.values.back());
  chart.log_x = numbered && x.is_logarithmic();
  const std::size_t lines = found.axes.size() > 1 ? found.axes[1].parts() : 1;
  for (std::size_t line = 0; line < lines; ++line) {
    Points points(lines > 1 ? part_in_words(found.axes[1], line) : "", line);
    for (std::size_t part = 0; part < x.parts(); ++part) {
      const double at = numbered          ? x.values[part]
                        : x.names.empty() ? (x.edges[part] + x.edges[part + 1]) / 2.0
                                          : static_cast<double>(part);
      points.add(at, found.tiles[line * x.parts() + part], picture.question.is_share());
    }
    points.move_to(chart);
  }
  if (!numbered && !x.names.empty()) {
    chart.x_range = {-0.5, static_cast<double>(x.parts()) - 0.5};
    for (std::size_t part = 0; part < x.parts(); ++part)
      chart.x_ticks.push_back({.at = static_cast<double>(part), .name = name_of_part(x, part)});
  }
  add_nominal(chart, picture.nominal);
  std::string caption = counts_in_words(found);
  if (picture.question.is_share()) caption += " Strokes are exact 99.9 % intervals of a share.";
  return {.svg = draw(chart), .caption = caption};
}

DrawnPicture draw_shares(SweepAtlas& atlas, const AtlasPicture& picture) {
  Chart chart{.title = picture.title, .height_px = 380};
  chart.y_label = "share of cells";
  std::vector<std::string> places;
  std::vector<std::string> names;
  for (const NamedShare& share : picture.shares) {
    if (std::ranges::count(places, share.at) == 0) places.push_back(share.at);
    if (std::ranges::count(names, share.name) == 0) names.push_back(share.name);
  }
  std::vector<Points> points;
  for (std::size_t i = 0; i < names.size(); ++i) points.emplace_back(names[i], i);
  AtlasAnswer all;
  for (const NamedShare& share : picture.shares) {
    const AtlasAnswer found = answer(atlas, share.question);
    const auto place = static_cast<double>(std::ranges::find(places, share.at) - places.begin());
    const auto number = static_cast<std::size_t>(std::ranges::find(names, share.name) - names.begin());
    const double shift =
        0.6 * ((static_cast<double>(number) + 0.5) / static_cast<double>(names.size()) - 0.5);
    points[number].add(place + shift, found.tiles.front(), true);
    all.tiles.push_back(found.tiles.front());
    all.all.computed += found.all.computed;
    all.all.known += found.all.known;
    all.all.failed += found.all.failed;
    all.all.missing += found.all.missing;
  }
  double least = 1.0;
  for (const Points& one : points)
    for (const double y : one.ends.y) least = std::isnan(y) ? least : std::min(least, y);
  chart.y_range = {std::max(-0.02, least - 0.02), 1.005};
  chart.x_range = {-0.5, static_cast<double>(places.size()) - 0.5};
  for (std::size_t i = 0; i < places.size(); ++i)
    chart.x_ticks.push_back({.at = static_cast<double>(i), .name = places[i]});
  for (Points& one : points) one.move_to(chart);
  add_nominal(chart, picture.nominal);
  std::string caption = counts_in_words(all);
  if (const auto at = caption.find("tile"); at != std::string::npos) caption.replace(at, 4, "point");
  return {.svg = draw(chart), .caption = caption + " Strokes are exact 99.9 % intervals of a share."};
}

DrawnPicture draw_parallel(SweepAtlas& atlas, const AtlasPicture& picture) {
  AtlasQuestion question = picture.question;
  question.by.clear();
  std::vector<std::string> columns = picture.columns;
  columns.push_back(question.of);  // the colour
  const AtlasSample taken = sample(atlas, question, columns, most_lines);
  ParallelAxes axes{.title = picture.title, .axes = {}, .lines = {}, .colours = {}};
  std::vector<AtlasScale> scales;
  for (std::size_t i = 0; i + 1 < columns.size(); ++i) {
    scales.push_back(scale_of(taken.columns[i], taken.values[i]));
    axes.axes.push_back(
        {.label = with_unit(taken.columns[i].name, taken.columns[i].unit), .ticks = scales.back().ticks()});
  }
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -smallest;
  for (std::size_t line = 0; line < taken.state.size(); ++line) {
    ParallelLine& one = axes.lines.emplace_back();
    for (std::size_t i = 0; i < scales.size(); ++i) one.at.push_back(scales[i].place(taken.values[i][line]));
    const double of = taken.values.back()[line];
    const AtlasColumn& colour = taken.columns.back();
    one.value = colour.values.empty() ? of : colour.values[static_cast<std::size_t>(of)];
    one.is_failed = !taken.state[line].empty();
    if (!std::isfinite(one.value)) continue;
    smallest = std::min(smallest, one.value);
    largest = std::max(largest, one.value);
  }
  axes.colours =
      !picture.steps.empty()
          ? ColourSteps{.label = with_unit(question.of, taken.columns.back().unit), .bounds = picture.steps}
          : round_steps(with_unit(question.of, taken.columns.back().unit), std::min(smallest, largest),
                        std::max(smallest, largest));
  axes.colours.lightest = 0.8;
  return {.svg = draw(axes),
          .caption = fmt::format("{} of {} cells, taken by chance, a line each. Below an axis: no number.",
                                 taken.state.size(), taken.of)};
}

}  // namespace

DrawnPicture draw_picture(SweepAtlas& atlas, const AtlasPicture& picture) {
  switch (picture.kind) {
    case AtlasPicture::Kind::map:
      return draw_map(atlas, picture);
    case AtlasPicture::Kind::lines:
      return draw_lines(atlas, picture);
    case AtlasPicture::Kind::shares:
      return draw_shares(atlas, picture);
    case AtlasPicture::Kind::parallel:
      break;
  }
  return draw_parallel(atlas, picture);
}

}  // namespace kerf::bench

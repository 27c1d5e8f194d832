#include "plot/chart_json.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "files/json_number.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr std::array colour_names{"black",  "blue", "vermillion", "green", "purple",
                                  "orange", "sky",  "yellow",     "grey"};
constexpr std::array mark_names{"line", "points", "circles", "crosses", "steps", "boxes"};

const char* name_of(Colour colour) { return colour_names[static_cast<std::size_t>(colour)]; }

json as_json(const Curve& curve) {
  return {{"label", curve.label},
          {"x", json_numbers(curve.x)},
          {"y", json_numbers(curve.y)},
          {"colour", name_of(curve.colour)},
          {"mark", mark_names[static_cast<std::size_t>(curve.mark)]},
          {"width", curve.width},
          {"dashed", curve.dashed},
          {"of", curve.of}};
}

json as_json(const Band& band) {
  return {
      {"begin", json_number(band.begin)}, {"end", json_number(band.end)}, {"colour", name_of(band.colour)}};
}

json as_json(const CellKind& kind) {
  return {{"colour", name_of(kind.colour)}, {"label", kind.label}, {"dotted", kind.dotted}};
}

json as_json(const Marker& marker) {
  return {{"at", json_number(marker.at)}, {"label", marker.label}, {"label_after", marker.label_after}};
}

json as_json(const PointLabel& label) {
  return {{"x", json_number(label.x)},
          {"y", json_number(label.y)},
          {"text", label.text},
          {"left", label.left},
          {"text_x", json_number(label.text_x)},
          {"text_y", json_number(label.text_y)}};
}

json as_json(const NamedTick& tick) { return {{"at", json_number(tick.at)}, {"name", tick.name}}; }

json as_json(const Range& range) {
  return range.begin < range.end ? json::array({range.begin, range.end}) : json(nullptr);
}

template <typename Part>
json list_of(const std::vector<Part>& parts) {
  json list = json::array();
  for (const Part& part : parts) list.push_back(as_json(part));
  return list;
}

template <typename Names>
std::size_t number_of(const Names& names, const std::string& name, const char* what) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw std::invalid_argument(fmt::format("a chart has no {} '{}'", what, name));
  return static_cast<std::size_t>(found - names.begin());
}
Colour colour_from(const json& part) {
  return static_cast<Colour>(number_of(colour_names, part.value("colour", std::string("black")), "colour"));
}

double number_in(const json& part, const char* name) {
  const auto found = part.find(name);
  return found == part.end() ? std::numeric_limits<double>::quiet_NaN() : number_from(*found);
}
std::vector<double> numbers_in(const json& part, const char* name) {
  std::vector<double> numbers;
  if (part.contains(name)) {
    for (const json& one : part.at(name)) numbers.push_back(number_from(one));
  }
  return numbers;
}
Range range_in(const json& part, const char* name) {
  const auto found = part.find(name);
  if (found == part.end() || found->is_null()) return {};
  return {.begin = found->at(0).get<double>(), .end = found->at(1).get<double>()};
}
/// Each part of a list by its reader.
template <typename Part>
std::vector<Part> parts_in(const json& of, const char* name, Part (*read)(const json&)) {
  std::vector<Part> parts;
  if (of.contains(name)) {
    for (const json& one : of.at(name)) parts.push_back(read(one));
  }
  return parts;
}

Curve curve_from(const json& part) {
  Curve curve{
      .label = part.value("label", std::string()),
      .x = numbers_in(part, "x"),
      .y = numbers_in(part, "y"),
      .colour = colour_from(part),
      .mark = static_cast<Mark>(number_of(mark_names, part.value("mark", std::string("line")), "mark")),
      .width = part.value("width", 1.5),
      .dashed = part.value("dashed", false),
      .of = part.value("of", std::vector<std::size_t>())};
  if (curve.x.size() != curve.y.size()) {
    throw std::invalid_argument(fmt::format("the curve '{}' of a chart has {} x and {} y", curve.label,
                                            curve.x.size(), curve.y.size()));
  }
  return curve;
}
Band band_from(const json& part) {
  return {.begin = number_in(part, "begin"), .end = number_in(part, "end"), .colour = colour_from(part)};
}
CellKind kind_from(const json& part) {
  return {.colour = colour_from(part),
          .label = part.value("label", std::string()),
          .dotted = part.value("dotted", false)};
}
Marker marker_from(const json& part) {
  return {.at = number_in(part, "at"),
          .label = part.value("label", std::string()),
          .label_after = part.value("label_after", false)};
}
NamedTick tick_from(const json& part) {
  return {.at = number_in(part, "at"), .name = part.value("name", std::string())};
}
PointLabel label_from(const json& part) {
  return {.x = number_in(part, "x"),
          .y = number_in(part, "y"),
          .text = part.value("text", std::string()),
          .left = part.value("left", false),
          .text_x = number_in(part, "text_x"),
          .text_y = number_in(part, "text_y")};
}

Cells cells_in(const json& of) {
  const auto part = of.find("cells");
  if (part == of.end()) return {};
  Cells cells{.x_edges = numbers_in(*part, "x_edges"),
              .y_edges = numbers_in(*part, "y_edges"),
              .upwards = part->value("upwards", false),
              .kinds = parts_in(*part, "kinds", kind_from),
              .kind = part->value("kind", std::vector<std::size_t>())};
  const std::size_t columns = std::max<std::size_t>(cells.x_edges.size(), 1) - 1;
  const std::size_t rows = std::max<std::size_t>(cells.y_edges.size(), 1) - 1;
  const bool is_grid = cells.kind.empty() || cells.kind.size() == columns * rows;
  const bool is_named =
      std::ranges::all_of(cells.kind, [&](std::size_t kind) { return kind < cells.kinds.size(); });
  if (!is_grid || !is_named) throw std::invalid_argument("the cells of a chart are no grid of its kinds");
  return cells;
}

}  // namespace

json chart_to_json(const Chart& chart) {
  return {{"title", chart.title},
          {"x_label", chart.x_label},
          {"y_label", chart.y_label},
          {"curves", list_of(chart.curves)},
          {"bands", list_of(chart.bands)},
          {"cells",
           {{"x_edges", json_numbers(chart.cells.x_edges)},
            {"y_edges", json_numbers(chart.cells.y_edges)},
            {"upwards", chart.cells.upwards},
            {"kinds", list_of(chart.cells.kinds)},
            {"kind", chart.cells.kind}}},
          {"vertical", list_of(chart.vertical)},
          {"horizontal", list_of(chart.horizontal)},
          {"labels", list_of(chart.labels)},
          {"x_ticks", list_of(chart.x_ticks)},
          {"y_ticks", list_of(chart.y_ticks)},
          {"x_range", as_json(chart.x_range)},
          {"y_range", as_json(chart.y_range)},
          {"log_x", chart.log_x},
          {"log_y", chart.log_y}};
}

Chart chart_from_json(const json& from) {
  return {.title = from.value("title", std::string()),
          .x_label = from.value("x_label", std::string()),
          .y_label = from.value("y_label", std::string()),
          .curves = parts_in(from, "curves", curve_from),
          .bands = parts_in(from, "bands", band_from),
          .cells = cells_in(from),
          .vertical = parts_in(from, "vertical", marker_from),
          .horizontal = parts_in(from, "horizontal", marker_from),
          .labels = parts_in(from, "labels", label_from),
          .x_ticks = parts_in(from, "x_ticks", tick_from),
          .y_ticks = parts_in(from, "y_ticks", tick_from),
          .x_range = range_in(from, "x_range"),
          .y_range = range_in(from, "y_range"),
          .log_x = from.value("log_x", false),
          .log_y = from.value("log_y", false)};
}

}  // namespace kerf::bench

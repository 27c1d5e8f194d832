#include "plot/chart_json.h"

#include <array>

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

}  // namespace kerf::bench

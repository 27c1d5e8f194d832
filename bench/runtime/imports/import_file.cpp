#include "imports/import_file.h"

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "files/named_file.h"
#include "laws/law_toml.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_stretches = 1'000'000;

/// A number above zero; 0 where there is none.
double positive_number(const Place& place, const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return 0.0;
  const double value = place.number(*node, fmt::format("'{}'", key));
  if (!(value > 0.0) || !std::isfinite(value))
    place.refuse(*node, "'{}' is {}, expected a number above zero", key, value);
  return value;
}

std::size_t stretch_of(const Place& place, const toml::table& table) {
  const double value = positive_number(place, table, "stretch");
  if (value > static_cast<double>(most_stretches) || value != std::floor(value))
    place.refuse(*table.get("stretch"), "'stretch' is {}, expected a whole number from 1 to {}", value,
                 most_stretches);
  return static_cast<std::size_t>(value);
}

std::array<double, 3> point_of(const Place& place, const toml::node& node, std::string_view key,
                               std::string_view unit = "m") {
  const toml::array* list = node.as_array();
  if (list == nullptr || list->size() != 3) place.refuse(node, "'{}' must be three numbers [{}]", key, unit);
  std::array<double, 3> point{};
  for (std::size_t i = 0; i < point.size(); ++i) {
    point.at(i) = place.number(*list->get(i), fmt::format("'{}'", key));
    if (!std::isfinite(point.at(i))) place.refuse(node, "'{}' must be three finite numbers [{}]", key, unit);
  }
  return point;
}

void append(std::string& text, std::string_view key, const std::array<double, 3>& point) {
  text += fmt::format("{} = [{}, {}, {}]\n", key, point[0], point[1], point[2]);
}

std::string map_of(const Place& place, const toml::table& table) {
  const toml::node* node = table.get("map");
  if (node == nullptr)
    place.refuse(table, "no 'map'; expected for example map = \"time=1[ms],position=2[deg],force=3[N]\"");
  const toml::array* list = node->as_array();
  if (list == nullptr) return place.text(table, "map", "");
  std::string map;
  for (const toml::node& part : *list) {
    if (!part.is_string()) place.refuse(part, "'map' must be a text, or a list of texts");
    map += (map.empty() ? "" : ",") + **part.as_string();
  }
  return map;
}

}  // namespace

ImportFile read_import_file(const std::filesystem::path& file) {
  const toml::table table = parse_toml(read_named_file(file), file.string());
  const Place place(file.string());
  place.allow_only(table,
                   {"map", "sheet", "stretch", "rate", "resample", "velocity_window", "origin", "point",
                    "sensor_rotation", "strict"},
                   "an import file");
  ImportFile read{.map = map_of(place, table), .options = {}};
  try {
    (void)parse_map(read.map);
  } catch (const std::invalid_argument& error) {
    place.refuse(*table.get("map"), "{}", error.what());
  }
  ImportOptions& options = read.options;
  options.sheet = place.text(table, "sheet", "");
  options.stretch = stretch_of(place, table);
  options.rate_hz = positive_number(place, table, "rate");
  options.resample_hz = positive_number(place, table, "resample");
  options.velocity_window_s = positive_number(place, table, "velocity_window");
  options.strict = place.flag(table, "strict", false);
  if (const toml::node* origin = table.get("origin"))
    options.places.origin_m = point_of(place, *origin, "origin");
  if (const toml::node* point = table.get("point")) options.places.point_m = point_of(place, *point, "point");
  if (const toml::node* rotation = table.get("sensor_rotation"))
    options.places.sensor_rotation_rad = radians_of(point_of(place, *rotation, "sensor_rotation", "deg"));
  return read;
}

std::string import_file_text(const ImportFile& file) {
  const ImportOptions& options = file.options;
  std::ostringstream quoted;
  quoted << "map = " << toml::value<std::string>(file.map) << '\n';
  if (!options.sheet.empty()) quoted << "sheet = " << toml::value<std::string>(options.sheet) << '\n';
  std::string text = quoted.str();
  if (options.stretch > 0) text += fmt::format("stretch = {}\n", options.stretch);
  if (options.rate_hz > 0.0) text += fmt::format("rate = {}\n", options.rate_hz);
  if (options.resample_hz > 0.0) text += fmt::format("resample = {}\n", options.resample_hz);
  if (options.velocity_window_s > 0.0)
    text += fmt::format("velocity_window = {}\n", options.velocity_window_s);
  const SpatialPlaces& places = options.places;
  if (places.origin_m != std::array<double, 3>{}) append(text, "origin", places.origin_m);
  if (places.point_m) append(text, "point", *places.point_m);
  if (places.sensor_rotation_rad) {
    std::array<double, 3> degrees = *places.sensor_rotation_rad;
    for (double& angle : degrees) angle *= 180.0 / std::numbers::pi;
    append(text, "sensor_rotation", degrees);
  }
  if (options.strict) text += "strict = true\n";
  return text;
}

std::array<double, 3> radians_of(std::array<double, 3> degrees) {
  for (double& angle : degrees) angle *= std::numbers::pi / 180.0;
  return degrees;
}

bool names_import_file(std::string_view map) {
  return map.ends_with(".toml") && map.find('=') == std::string_view::npos;
}

ImportOptions with_file_behind(ImportOptions given, const ImportOptions& file) {
  if (given.sheet.empty()) given.sheet = file.sheet;
  if (given.stretch == 0) given.stretch = file.stretch;
  if (given.rate_hz == 0.0) given.rate_hz = file.rate_hz;
  if (given.resample_hz == 0.0) given.resample_hz = file.resample_hz;
  if (given.velocity_window_s == 0.0) given.velocity_window_s = file.velocity_window_s;
  given.strict = given.strict || file.strict;
  if (given.places.origin_m == std::array<double, 3>{}) given.places.origin_m = file.places.origin_m;
  if (!given.places.sensor_rotation_rad) given.places.sensor_rotation_rad = file.places.sensor_rotation_rad;
  if (!given.places.point_m) given.places.point_m = file.places.point_m;
  return given;
}

ImportOptions import_options_of(const std::vector<std::string>& maps, ImportOptions given) {
  std::string map;
  bool has_file = false;
  for (const std::string& part : maps) {
    std::string entries = part;
    if (names_import_file(part)) {
      if (has_file) throw std::invalid_argument("--map names two files; expected one, and entries beside it");
      has_file = true;
      const ImportFile file = read_import_file(part);
      entries = file.map;
      given = with_file_behind(std::move(given), file.options);
    }
    map += (map.empty() ? "" : ",") + entries;
  }
  given.map = parse_map(map);
  return given;
}

}  // namespace kerf::bench

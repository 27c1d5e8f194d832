#include "intake/mapping_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include "http/routes.h"

namespace kerf::bench {
namespace {

using Point = std::array<double, 3>;

constexpr double farthest = 1e6;
constexpr double highest = 1e9;
constexpr double most_stretches_given = 1e6;

std::optional<Point> point_in(const nlohmann::json& options, const std::string& name) {
  if (!options.contains(name)) return std::nullopt;
  const std::vector<double> numbers = numbers_in(options, name, 3);
  if (numbers.size() != 3) throw RequestError(400, fmt::format("'{}' is not three numbers", name));
  Point point{};
  std::ranges::copy(numbers, point.begin());
  for (const double number : point) {
    if (!(std::abs(number) <= farthest)) throw RequestError(400, fmt::format("'{}' is too far away", name));
  }
  return point;
}

double degrees_of(double angle) { return angle * 180.0 / std::numbers::pi; }

}  // namespace

ImportFile mapping_in(const nlohmann::json& given, bool needs_map) {
  ImportFile mapping{.map = text_or(given, "map", ""), .options = {}};
  if (needs_map || !mapping.map.empty()) (void)parse_map(mapping.map);
  const auto found = given.find("options");
  if (found == given.end()) return mapping;
  if (!found->is_object()) throw RequestError(400, "'options' is not an object");
  const nlohmann::json& given_options = *found;
  ImportOptions& options = mapping.options;
  options.sheet = text_or(given_options, "sheet", "");
  options.stretch =
      static_cast<std::size_t>(number_or(given_options, "stretch", 0.0, 0.0, most_stretches_given));
  options.rate_hz = number_or(given_options, "rate", 0.0, 0.0, highest);
  options.resample_hz = number_or(given_options, "resample", 0.0, 0.0, highest);
  options.velocity_window_s = number_or(given_options, "velocity_window", 0.0, 0.0, highest);
  options.strict = flag_in(given_options, "strict", false);
  if (const auto origin = point_in(given_options, "origin")) options.places.origin_m = *origin;
  options.places.point_m = point_in(given_options, "point");
  if (const auto rotation = point_in(given_options, "sensor_rotation"))
    options.places.sensor_rotation_rad = radians_of(*rotation);
  return mapping;
}

nlohmann::ordered_json mapping_as_json(const ImportFile& mapping) {
  const ImportOptions& options = mapping.options;
  nlohmann::ordered_json json{{"map", mapping.map}, {"options", nlohmann::ordered_json::object()}};
  nlohmann::ordered_json& told = json["options"];
  if (!options.sheet.empty()) told["sheet"] = options.sheet;
  if (options.stretch > 0) told["stretch"] = options.stretch;
  for (const auto& [name, value] :
       {std::pair{"rate", options.rate_hz}, std::pair{"resample", options.resample_hz},
        std::pair{"velocity_window", options.velocity_window_s}}) {
    if (value > 0.0) told[name] = value;
  }
  if (options.places.origin_m != Point{}) told["origin"] = options.places.origin_m;
  if (options.places.point_m) told["point"] = *options.places.point_m;
  if (options.places.sensor_rotation_rad) {
    Point degrees = *options.places.sensor_rotation_rad;
    std::ranges::transform(degrees, degrees.begin(), degrees_of);
    told["sensor_rotation"] = degrees;
  }
  if (options.strict) told["strict"] = true;
  return json;
}

ImportOptions import_options_of(const ImportFile& mapping) {
  ImportOptions options = mapping.options;
  if (!mapping.map.empty()) options.map = parse_map(mapping.map);
  return options;
}

}  // namespace kerf::bench

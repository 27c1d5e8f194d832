#include "results/law_view.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "files/json_number.h"
#include "laws/render.h"

namespace kerf::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t steps = 1000;  // of a millisecond, each way
constexpr std::size_t shown_every = 5;
constexpr double default_depth_m = 0.01;
constexpr double default_angle_rad = 0.5;

struct PictureRange {
  double end = 0.0;
  std::string why;
};

/// The largest of a law's knots; nothing if it has none.
std::optional<double> last_knot(const LawFile& law) {
  std::optional<double> last;
  const auto parameters = law.law.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].name.starts_with("knot[")) continue;
    last = std::max(last.value_or(law.law.values()[i]), law.law.values()[i]);
  }
  return last;
}

std::optional<double> number_of(const LawFile& law, std::string_view option) {
  const auto& options = law.law.options();
  const auto given = options.find(option);
  if (given == options.end() || !std::holds_alternative<double>(given->second)) return std::nullopt;
  return std::get<double>(given->second);
}

PictureRange range_of(const LawFile& law) {
  if (const auto knot = last_knot(law); knot && *knot > 0.0) return {*knot, "its last knot"};
  constexpr std::array<std::pair<const char*, const char*>, 4> ends{
      {{"last", "the last point of its table"},
       {"most_depth", "the greatest depth of its rules"},
       {"reference_depth", "its reference depth"},
       {"contact_angle", "closed blades"}}};
  for (const auto& [option, why] : ends) {
    if (const auto end = number_of(law, option); end && *end > 0.0) return {*end, why};
  }
  if (law.position_unit == "rad") return {default_angle_rad, "0.5 rad: the law itself has no end"};
  return {default_depth_m, "10 mm: the law itself has no end"};
}

ordered_json options_of(const models::Options& options) {
  ordered_json object = ordered_json::object();
  for (const auto& [name, value] : options)
    object[name] = std::visit([](const auto& one) { return ordered_json(one); }, value);
  return object;
}

ordered_json parameters_of(const LawFile& law) {
  ordered_json list = ordered_json::array();
  const auto parameters = law.law.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const models::ParameterInfo& info = parameters[i];
    list.push_back(
        {{"name", info.name},
         {"value", law.law.values()[i]},
         {"unit", models::unit_of(info.quantity, law.force_unit, law.position_unit)},
         {"std_error", i < law.std_errors.size() ? json_number(law.std_errors[i]) : ordered_json(nullptr)},
         {"meaning", info.meaning}});
  }
  return list;
}

}  // namespace

LawCurve curve_of(const LawFile& file) {
  LawCurve curve;
  if (file.law.is_spatial()) {
    curve.range = "it acts on several axes at once, so that there is no curve of it";
    return curve;
  }
  const auto [end, why] = range_of(file);
  curve.speed = end;  // per second
  curve.range = why;
  std::vector<models::Motion> motion;
  for (std::size_t tick = 0; tick <= 2 * steps; ++tick) {
    const bool is_inwards = tick <= steps;
    const auto at = static_cast<double>(is_inwards ? tick : 2 * steps - tick) / static_cast<double>(steps);
    motion.push_back({.penetration = end * at, .velocity = is_inwards ? end : -end});
  }
  const auto force = without_rendering_aids(file.law).along(
      motion, std::vector(motion.size(), 1.0 / static_cast<double>(steps)));
  for (std::size_t tick = 0; tick <= steps; tick += shown_every) {
    curve.penetration.push_back(end * static_cast<double>(tick) / static_cast<double>(steps));
    curve.closing.push_back(force[tick]);
    curve.opening.push_back(force[2 * steps - tick]);
  }
  return curve;
}

ordered_json law_as_json(const LawFile& law, const std::string& name) {
  const LawCurve curve = curve_of(law);
  return {{"name", name},
          {"model", law.law.model()},
          {"axis", law.axis},
          {"position_unit", law.position_unit},
          {"force_unit", law.force_unit},
          {"contact", {{"position", law.contact.position}, {"direction", law.contact.direction}}},
          {"equation", models::law_info(law.law.model()).equation},
          {"options", options_of(law.law.options())},
          {"parameters", parameters_of(law)},
          {"toml", to_toml(law)},
          {"curve",
           {{"penetration", curve.penetration},
            {"closing", curve.closing},
            {"opening", curve.opening},
            {"speed", curve.speed},
            {"range", curve.range}}}};
}

}  // namespace kerf::bench

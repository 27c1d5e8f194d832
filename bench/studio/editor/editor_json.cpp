#include "editor/editor_json.h"

#include "files/json_number.h"
#include "http/routes.h"

namespace kerf::bench {

nlohmann::ordered_json curve_as_json(const EditorCurve& curve, const std::string& recording) {
  return {{"recording", recording},
          {"axis", curve.axis},
          {"position_unit", curve.position_unit},
          {"force_unit", curve.force_unit},
          {"cycles", curve.cycles},
          {"segmented_here", curve.segmented_here},
          {"contact_position", curve.contact.position},
          {"closing_direction", curve.contact.direction},
          {"penetration", curve.penetration},
          {"closing", json_numbers(curve.closing)},
          {"opening", json_numbers(curve.opening)},
          {"jnd", {{"weber_fraction", curve.jnd.weber_fraction}, {"threshold_n", curve.jnd.threshold}}}};
}

nlohmann::ordered_json knots_as_json(const Knots& knots) {
  return {{"penetration", knots.penetration}, {"closing", knots.closing}, {"opening", knots.opening}};
}

nlohmann::ordered_json law_error_as_json(const LawError& error) {
  return {{"rmse_n", error.rmse_n},
          {"worst_n", error.worst_n},
          {"worst_penetration", error.worst_penetration},
          {"worst_branch", error.worst_is_closing ? "closing" : "opening"},
          {"jnd_n", error.jnd_n},
          {"rmse_jnd", error.rmse_jnd},
          {"worst_jnd", error.worst_jnd}};
}

Knots knots_in(const nlohmann::json& object, const std::string& name) {
  constexpr std::size_t max_numbers = 64;  // check_knots() says how many there may be
  const auto found = object.find(name);
  if (found == object.end() || !found->is_object())
    throw RequestError(400, "'" + name + "' is not an object with the breakpoints of a law");
  Knots knots{.penetration = numbers_in(*found, "penetration", max_numbers),
              .closing = numbers_in(*found, "closing", max_numbers),
              .opening = numbers_in(*found, "opening", max_numbers)};
  check_knots(knots);
  return knots;
}

}  // namespace kerf::bench

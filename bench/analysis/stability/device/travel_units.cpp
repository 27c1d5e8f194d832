#include "stability/device/travel_units.h"

#include "units/units.h"

namespace kerf::bench {

TravelUnits::TravelUnits(const drivers::AxisInfo& axis) {
  if (axis.position_unit != "rad" || axis.lever != 1.0) return;
  position_ = axis.position_unit;
  force_ = axis.force_unit;
}

TravelUnits::TravelUnits(const nlohmann::ordered_json& study) {
  const auto found = study.find("units");
  if (found == study.end()) return;
  position_ = found->at("position").get<std::string>();
  force_ = found->at("force").get<std::string>();
}

std::string TravelUnits::mass() const {
  if (position_ == "m") return "kg";
  return force_ == "N·m" ? "kg·m²" : force_ + "·s²/" + position_;
}

ShownIn TravelUnits::depth() const { return position_ == "m" ? ShownIn{1e3, "mm"} : ShownIn{1.0, position_}; }

ShownIn TravelUnits::energy() const {
  const std::string unit = work_unit(force_, position_);
  return unit == "J" ? ShownIn{1e6, "uJ"} : ShownIn{1.0, unit};
}

nlohmann::ordered_json as_json(const TravelUnits& units) {
  return {{"position", units.position()},   {"speed", units.speed()},     {"force", units.force()},
          {"stiffness", units.stiffness()}, {"damping", units.damping()}, {"mass", units.mass()}};
}

}  // namespace kerf::bench

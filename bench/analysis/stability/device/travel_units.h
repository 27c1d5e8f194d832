#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <kerf/drivers/device.h>

namespace kerf::bench {

/// A number as people read it: times `factor`, in `unit`.
struct ShownIn {
  double factor = 1.0;
  std::string unit;
};

/// Units of an axis' travel and of what acts along it: metres and newtons, or where an angle has no lever
/// (AxisInfo::lever is 1) radians and the unit of its force.
class TravelUnits {
 public:
  TravelUnits() = default;
  explicit TravelUnits(const drivers::AxisInfo& axis);
  /// As as_json() wrote them; metres and newtons of a file of an earlier version.
  explicit TravelUnits(const nlohmann::ordered_json& study);

  [[nodiscard]] const std::string& position() const noexcept { return position_; }
  [[nodiscard]] const std::string& force() const noexcept { return force_; }
  [[nodiscard]] std::string speed() const { return position_ + "/s"; }
  [[nodiscard]] std::string stiffness() const { return force_ + "/" + position_; }
  [[nodiscard]] std::string damping() const { return force_ + "·s/" + position_; }
  [[nodiscard]] std::string mass() const;
  /// A depth: in mm, or in rad.
  [[nodiscard]] ShownIn depth() const;
  /// A step of the encoder and the energy of a stroke: in millionths.
  [[nodiscard]] ShownIn step() const { return {1e6, "u" + position_}; }
  [[nodiscard]] ShownIn energy() const;

 private:
  std::string position_ = "m";
  std::string force_ = "N";
};

/// Which unit each kind of number of a study is in; keys that end in "_m" are of the position's, and so on.
[[nodiscard]] nlohmann::ordered_json as_json(const TravelUnits& units);

}  // namespace kerf::bench

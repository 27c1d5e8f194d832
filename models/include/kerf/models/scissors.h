#pragma once

#include <cmath>
#include <vector>

#include <kerf/models/parameter.h>

namespace kerf::models {

/// Where the blades of a pair of scissors cut, from the angle between them.
///
///     t(theta) = t_max tan(theta/2) / (tan(theta/2) + (t_max - t_min) / l_t)
///     x_c      = t(theta) / sin(theta/2)
///
/// t is half the width of a blade at the cutting point, from t_max at the pivot to t_min at the tip, a length
/// l_t away; x_c is the distance of the cutting point from the pivot. The blades cut only between the angle
/// at which the tips have met, theta = 2 atan(t_min / l_t), and the one at which they lose contact at the
/// wide end.
///
/// Source: [Okamura2003], eqs. 1-2, fig. 3; the limits follow from its section 3.3.
struct ScissorsGeometry {
  double pivot_half_width_m = 4e-3;  ///< t_max, > tip_half_width_m
  double tip_half_width_m = 1e-3;    ///< t_min, > 0
  double blade_length_m = 35e-3;     ///< l_t, > 0
  double widest_angle_rad = 0.7;     ///< angle at which the blades lose contact, < pi

  /// Angle at which the tips have met [rad]; below it there is nothing left to cut.
  [[nodiscard]] double closing_angle() const noexcept {
    return 2.0 * std::atan(tip_half_width_m / blade_length_m);
  }

  /// The options pivot_half_width, tip_half_width, blade_length and widest_angle of a law.
  static std::vector<OptionInfo> options();
  /// Reads them.
  /// @throws std::invalid_argument if one is out of range, or the tip is not the narrower end.
  static ScissorsGeometry make(const OptionReader& reader);
};

/// The cutting point of one geometry, ready for a tick:
///
///     x_c(theta) = t_max / (sqrt(1 + kappa^2) sin(theta/2 + atan kappa)),   kappa = (t_max - t_min) / l_t
///
/// which needs one sine and divides by nothing that vanishes for an angle in (0, pi).
class CuttingPoint {
 public:
  CuttingPoint() : CuttingPoint(ScissorsGeometry{}) {}
  explicit CuttingPoint(const ScissorsGeometry& scissors)
      : taper_rad_(
            std::atan((scissors.pivot_half_width_m - scissors.tip_half_width_m) / scissors.blade_length_m)),
        scale_m_(scissors.pivot_half_width_m * std::cos(taper_rad_)),
        closing_rad_(scissors.closing_angle()),
        widest_rad_(scissors.widest_angle_rad) {}

  /// Whether the blades cut at this angle.
  template <typename Signal>
  [[nodiscard]] bool cuts_at(Signal theta_rad) const noexcept {
    return theta_rad >= closing_rad_ && theta_rad <= widest_rad_;
  }
  /// Distance from the pivot [m]; theta within the cutting angles.
  template <typename Signal>
  [[nodiscard]] Signal operator()(Signal theta_rad) const noexcept {
    using std::sin;
    return scale_m_ / sin(0.5 * theta_rad + taper_rad_);
  }
  /// Half width of a blade there, t(theta) [m].
  [[nodiscard]] double half_width(double theta_rad) const noexcept {
    return (*this)(theta_rad)*std::sin(0.5 * theta_rad);
  }
  /// Half the gap between the cutting edges at a distance from the pivot [m]; negative behind the cutting
  /// point.
  [[nodiscard]] double half_gap(double theta_rad, double distance_m) const noexcept {
    return (distance_m - (*this)(theta_rad)) * std::tan(0.5 * theta_rad + taper_rad_);
  }
  [[nodiscard]] double closing_angle() const noexcept { return closing_rad_; }
  [[nodiscard]] double widest_angle() const noexcept { return widest_rad_; }
  /// atan kappa, by which an edge leans towards the other at zero opening [rad].
  [[nodiscard]] double taper_angle() const noexcept { return taper_rad_; }

 private:
  double taper_rad_;  ///< atan kappa
  double scale_m_;    ///< t_max / sqrt(1 + kappa^2)
  double closing_rad_;
  double widest_rad_;
};

}  // namespace kerf::models

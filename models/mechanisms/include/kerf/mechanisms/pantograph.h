#pragma once

#include <optional>

#include <Eigen/Core>

namespace kerf::mechanisms {

/// A planar five-bar linkage, as Haply's 2DIY: two motors beside each other, each with an arm, whose ends
/// carry the handle on two forearms.
///
/// Frame: the joint of the first motor at (0, 0), of the second at (d, 0), y away from the motors; angles
/// from +x. With arms l and forearms L, and e(a) = (cos a, sin a):
///
///     A = l e(t1),   B = (d, 0) + l e(t2),   |E - A| = |E - B| = L,   E the one with the larger y
///
/// A torque on each motor for a force F of the handle is its part of J^T F, J = dE / d(t1, t2): from the
/// derivative of |E - A|^2 = L^2,
///
///     (E - A) . dE = (E - A) . dA,   (E - B) . dE = (E - B) . dB
///
/// Source: facts of Haply-API-cpp and Haply-API-Java.
class Pantograph {
 public:
  using Vector = Eigen::Vector2d;
  using Matrix = Eigen::Matrix2d;

  struct Dimensions {
    double arm_m = 0.07;       ///< l
    double forearm_m = 0.09;   ///< L
    double between_m = 0.038;  ///< d, between the motors
  };
  explicit Pantograph(const Dimensions& made) noexcept : made_(made) {}

  /// Where the handle is at (t1, t2) [rad]. Not finite where the forearms do not meet.
  [[nodiscard]] Vector handle(const Vector& angles_rad) const noexcept;
  /// d handle / d(t1, t2) [m/rad]. Not finite where the forearms are in line.
  [[nodiscard]] Matrix jacobian(const Vector& angles_rad) const noexcept;
  /// The angles that put the handle there with the first arm bent to the left and the second to the right;
  /// nothing for a place out of reach.
  [[nodiscard]] std::optional<Vector> angles_of(const Vector& handle_m) const noexcept;

 private:
  struct Elbows {
    Vector first;
    Vector second;
  };
  [[nodiscard]] Elbows elbows(const Vector& angles_rad) const noexcept;

  Dimensions made_;
};

}  // namespace kerf::mechanisms

#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <kerf/mechanisms/premium.h>
#include <kerf/models/exponential.h>
#include <kerf/models/fracture.h>
#include <kerf/models/implicit_surface.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/spatial.h>

namespace kerf::models {

/// How the torque of the normal and that of the tangent are kept apart.
enum class Projection : std::uint8_t {
  paper,      ///< P = J+ J and Q = I - P of the joint space itself
  consistent  ///< N = I - H^-1 J^T L J, weighed by the inertia, L = (J H^-1 J^T)^-1
};

/// What the surface does to the device at one pose and speed: J = grad(phi)^T J_tip, the row that takes joint
/// velocities to phi', and its rate.
struct SurfaceContact {
  double phi = 0.0;       ///< [m], < 0 inside
  double phi_rate = 0.0;  ///< [m/s]
  Eigen::RowVector3d jacobian = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d jacobian_rate = Eigen::RowVector3d::Zero();
};

template <ImplicitSurface S>
[[nodiscard]] SurfaceContact contact_with(const S& surface, const mechanisms::Premium::Dynamics& device,
                                          const Eigen::Vector3d& q, const Eigen::Vector3d& qd) {
  const Eigen::Vector3d v = device.jacobian * qd;
  const Eigen::Vector3d normal = surface.gradient(device.tip);
  SurfaceContact contact;
  contact.phi = surface.phi(device.tip);
  contact.phi_rate = normal.dot(v);
  contact.jacobian = normal.transpose() * device.jacobian;
  contact.jacobian_rate = normal.transpose() * mechanisms::Premium::jacobian_rate(q, qd) +
                          gradient_rate(surface, device.tip, v).transpose() * device.jacobian;
  return contact;
}

/// Torque that makes the normal and the tangent of a surface two separate loops:
///
///     consistent:  tau = C q' + g - J^T L J' q' - J^T lambda_d - N^T zeta_d
///     paper:       tau = C q' + g - P H J+ J' q' - Q H Q' q' - J^T lambda_d - Q zeta_d
///
///     phi'' = (J H^-1 J^T)(lambda - lambda_d),   zeta_d = b1 N q' (or b1 Q q')
///
/// With `consistent` these hold exactly, whatever the hand does along the tangent: J H^-1 N^T = 0. With
/// `paper` Q H^-1 J^T is not zero in general, and each loop pushes the other.
///
/// Source: [Sepulveda2008], eqs. 4-10, with the dot on J that eq. 5 omits; `consistent` is the
/// inertia-weighted projector of Khatib [Khatib1987].
/// @param lambda_d force of the normal loop; -lambda_d pushes out of the object [N]
/// @param tangential_damping b1 [N·m·s/rad]
[[nodiscard]] Eigen::Vector3d orthogonal_torque(const SurfaceContact& contact,
                                                const mechanisms::Premium::Dynamics& device,
                                                const Eigen::Vector3d& qd, Projection projection,
                                                double lambda_d, double tangential_damping) noexcept;

/// Orthogonal decomposition on a 3-DOF Phantom Premium 1.5: an object whose normal force is a law of its own
/// and whose tangent is viscous, with the device's own weight and inertia forces taken off.
///
///     lambda_d = B0 phi' - F(-phi)      normal, F the exponential or the fracture law; no B0
///                                       while a crack grows
///     zeta_d   = b1 times the tangential velocity of the joints
///
/// Outside the object (phi >= 0) only weight and inertia forces are compensated; without `compensate` they
/// are not, there or in contact, and the normal and tangential parts are all that is rendered.
///
/// Axes: q1, q2, q3 [rad, N·m] of mechanisms::Premium. Source: [Sepulveda2008], eqs. 4-15; differs from the
/// paper in the sign of F in eq. 12 (as printed the tissue would pull), in B0, which multiplies a speed there
/// and acts as N·s/m here, and in offering both projections.
struct Orthogonal {
  static constexpr std::string_view name = "orthogonal";
  static constexpr std::string_view equation = "tau = C q' + g - J^T L J' q' - J^T lambda_d - N^T zeta_d";
  static constexpr LawFacts facts{.fineness = Fineness::projections};

  Exponential<double> deformation;
  Fracture<double> fracture;
  bool cutting = false;
  double viscosity = 0.0;           ///< B0 [N·s/m]
  double tangential_damping = 0.0;  ///< b1 [N·m·s/rad]
  Projection projection = Projection::consistent;
  bool compensate = true;
  std::variant<Plane, Sphere> surface;
  mechanisms::Premium device;

  struct State {
    Exponential<double>::State deformation;
    Fracture<double>::State fracture;
    double normal_force = 0.0;  ///< -lambda_d of the last tick, what the surface exerts along its normal [N]
  };

  static std::vector<LawAxis> axes() {
    return {{"q1", "rad", "N·m"}, {"q2", "rad", "N·m"}, {"q3", "rad", "N·m"}};
  }
  static std::vector<OptionInfo> options();
  static std::vector<ParameterInfo> parameters(const Options& given);
  static Orthogonal make(std::span<const double> values, const Options& given);

  /// Of the normal law [J]. What compensation does is the device's own weight and inertia, and not the
  /// object's energy.
  [[nodiscard]] double stored_energy(const State& state) const noexcept {
    return cutting ? fracture.stored_energy(state.fracture) : deformation.stored_energy(state.deformation);
  }

  // NOLINTNEXTLINE(bugprone-exception-escape): a surface is never without a value
  AxisValues step(State& state, const SpatialMotion& motion, double period_s) const noexcept;
};

}  // namespace kerf::models

#include "kerf/models/orthogonal.h"

#include <sstream>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

namespace kerf::models {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

Vector3d point_option(const OptionReader& reader, std::string_view option) {
  std::istringstream stream(reader.text(option));
  stream.imbue(std::locale::classic());
  Vector3d point;
  std::string more;
  if (!(stream >> point.x() >> point.y() >> point.z()) || stream >> more || !point.allFinite()) {
    throw std::invalid_argument("law 'orthogonal', option '" + std::string(option) +
                                "': expected three numbers, such as \"0 1 0\", not \"" + reader.text(option) +
                                '"');
  }
  return point;
}

Vector3d paper_torque(const SurfaceContact& contact, const mechanisms::Premium::Dynamics& device,
                      const Vector3d& qd, double b1) noexcept {
  const RowVector3d& j = contact.jacobian;
  const RowVector3d& rate = contact.jacobian_rate;
  const double square = j.squaredNorm();
  const Matrix3d p = j.transpose() * j / square;
  const Matrix3d q = Matrix3d::Identity() - p;
  const Matrix3d cross = rate.transpose() * j / square;
  const Matrix3d q_rate = 2.0 * j.dot(rate) / square * p - cross - cross.transpose();
  return -p * device.inertia * (j.transpose() * (rate.dot(qd) / square)) - q * device.inertia * q_rate * qd -
         b1 * (q * qd);
}

Vector3d consistent_torque(const SurfaceContact& contact, const mechanisms::Premium::Dynamics& device,
                           const Vector3d& qd, double b1) noexcept {
  const Vector3d through = device.inertia.inverse() * contact.jacobian.transpose();  // H^-1 J^T
  const double lambda = 1.0 / contact.jacobian.dot(through);                         // L
  const Vector3d tangential = qd - through * (lambda * contact.jacobian.dot(qd));    // N q'
  const Vector3d damping = b1 * tangential;
  const Vector3d transposed =
      damping - contact.jacobian.transpose() * (lambda * through.dot(damping));  // N^T zeta
  return -contact.jacobian.transpose() * (lambda * contact.jacobian_rate.dot(qd)) - transposed;
}

}  // namespace

Vector3d orthogonal_torque(const SurfaceContact& contact, const mechanisms::Premium::Dynamics& device,
                           const Vector3d& qd, Projection projection, double lambda_d,
                           double tangential_damping) noexcept {
  const Vector3d weight = device.coriolis_torque + device.gravity;
  if (!(contact.jacobian.squaredNorm() > 0.0)) return weight;
  const Vector3d apart = projection == Projection::consistent
                             ? consistent_torque(contact, device, qd, tangential_damping)
                             : paper_torque(contact, device, qd, tangential_damping);
  return weight + apart - contact.jacobian.transpose() * lambda_d;
}

std::vector<OptionInfo> Orthogonal::options() {
  return {
      {"projection", std::string("consistent"), "consistent (weighed by the inertia) or paper"},
      {"interaction", std::string("deformation"), "deformation (exponential) or cutting (fracture)"},
      {"surface", std::string("plane"), "plane or sphere; the object is under the plane or in the sphere"},
      {"point", std::string("0 0 0"), "a point of the plane, or the sphere's centre [m]"},
      {"normal", std::string("0 1 0"), "outward normal of the plane, of any length"},
      {"radius", 0.05, "of the sphere [m]"},
      {"thickness", 0.1, "L0, thickness of the sample [m]"},
      {"compensate", true, "take off the device's own weight and inertia forces"},
      {"payload", 0.0, "mass at the tip [kg]"}};
}

std::vector<ParameterInfo> Orthogonal::parameters(const Options& given) {
  const OptionReader reader(name, options(), given);
  std::vector<ParameterInfo> all{
      {"amplitude", Quantity::load, 1e-15, 1e6, Scale::logarithmic, "alpha, normal force at contact"},
      {"exponent", Quantity::ratio, 1e-6, 1e3, Scale::logarithmic, "beta, stiffening over the thickness L0"},
      {"viscosity", Quantity::dashpot, 0.0, 1e6, Scale::linear, "B0, normal force per speed"},
      {"tangential_damping", Quantity::joint_damping, 0.0, 1e3, Scale::linear, "b1, along the surface"}};
  if (reader.choice("interaction", {"deformation", "cutting"}) == "cutting") {
    all.push_back(
        {"yield_energy", Quantity::energy, 1e-12, 1e6, Scale::logarithmic, "Uy, stored at the fracture"});
    all.push_back(
        {"toughness", Quantity::toughness, 1e-6, 1e9, Scale::logarithmic, "Jc, energy per area of crack"});
    all.push_back({"width", Quantity::length, 1e-9, 1e3, Scale::logarithmic, "w, of the blade"});
  }
  return all;
}

Orthogonal Orthogonal::make(std::span<const double> values, const Options& given) {
  const OptionReader reader(name, options(), given);
  Orthogonal law;
  const double thickness = reader.number("thickness", 1e-9, 1e9);
  law.cutting = reader.choice("interaction", {"deformation", "cutting"}) == "cutting";
  law.deformation = {values[0], values[1], 0.0, thickness, false};
  if (law.cutting) law.fracture = {values[0], values[1], values[4], values[5], values[6], thickness};
  law.viscosity = values[2];
  law.tangential_damping = values[3];
  law.projection = reader.choice("projection", {"consistent", "paper"}) == "paper" ? Projection::paper
                                                                                   : Projection::consistent;
  law.compensate = reader.flag("compensate");
  law.device = mechanisms::Premium({.payload_kg = reader.number("payload", 0.0, 10.0)});
  const Vector3d point = point_option(reader, "point");
  const Vector3d normal = point_option(reader, "normal");
  if (reader.choice("surface", {"plane", "sphere"}) == "sphere") {
    law.surface = Sphere{.centre = point, .radius_m = reader.number("radius", 1e-6, 1e3)};
  } else {
    if (!(normal.stableNorm() > 0.0)) {
      throw std::invalid_argument("law 'orthogonal', option 'normal': has no length");
    }
    law.surface = Plane{.point = point, .normal = normal.stableNormalized()};
  }
  return law;
}

// NOLINTNEXTLINE(bugprone-exception-escape): a surface is never without a value
AxisValues Orthogonal::step(State& state, const SpatialMotion& motion, double period_s) const noexcept {
  const Vector3d q(motion.position[0], motion.position[1], motion.position[2]);
  const Vector3d qd(motion.velocity[0], motion.velocity[1], motion.velocity[2]);
  const auto at = device.dynamics(q, qd);
  const SurfaceContact contact =
      std::visit([&](const auto& one) { return contact_with(one, at, q, qd); }, surface);
  const Motion normal{.penetration = -contact.phi, .velocity = -contact.phi_rate};
  const double resisting = cutting ? fracture.step(state.fracture, normal, period_s)
                                   : deformation.step(state.deformation, normal, period_s);
  const Vector3d weight = at.coriolis_torque + at.gravity;
  Vector3d torque = weight;
  // A cut object holds the tool where its law does; in the opened crack there is nothing.
  const bool held = cutting ? resisting > 0.0 : contact.phi < 0.0;
  // A crack that grows takes a constant force: the viscosity is that of the deformed tissue.
  const bool deforms = !cutting || state.fracture.mode == Fracture<double>::Mode::deformation;
  state.normal_force = held ? resisting - (deforms ? viscosity * contact.phi_rate : 0.0) : 0.0;
  if (held) {
    torque = orthogonal_torque(contact, at, qd, projection, -state.normal_force, tangential_damping);
  }
  if (!compensate) torque -= weight;
  return {torque.x(), torque.y(), torque.z()};
}

}  // namespace kerf::models

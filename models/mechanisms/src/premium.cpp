#include "kerf/mechanisms/premium.h"

#include <cmath>
#include <stdexcept>

namespace kerf::mechanisms {
namespace {

using Vector = Premium::Vector;
using Matrix = Premium::Matrix;

constexpr double l1 = Premium::upper_arm_m;
constexpr double l2 = Premium::forearm_m;
constexpr double l3 = 0.0325;   // from the shoulder to the rod c
constexpr double l5 = -0.0368;  // from the shoulder to the mass centre of be, along the upper arm
constexpr double l6 = 0.0527;   // from the shoulder to the mass centre of df, against the forearm

/// Mass and principal moments; x is the axis of pitch, the upper arm lies along z, the forearm along y.
struct Body {
  double mass_kg;
  double xx;
  double yy;
  double zz;
};
constexpr Body a{0.0202, 0.4864e-4, 0.0018e-4, 0.4864e-4};
constexpr Body c{0.0249, 0.959e-4, 0.959e-4, 0.0051e-4};
constexpr Body be{0.2359, 11.09e-4, 10.06e-4, 0.591e-4};
constexpr Body df{0.1906, 7.11e-4, 0.629e-4, 6.246e-4};
constexpr double base_yy = 11.87e-4;
constexpr double rotor_kg_m2 = 1.08e-6;

/// A mass and where it sits: so far along the upper arm, so far along the forearm.
struct Point {
  double mass_kg;
  double upper_m;
  double fore_m;
};

constexpr double rotor(std::size_t joint) {
  return rotor_kg_m2 * Premium::gear_ratio[joint] * Premium::gear_ratio[joint];
}

}  // namespace

struct Premium::Directions {
  explicit Directions(const Vector& q) noexcept
      : s1(std::sin(q[0])),
        c1(std::cos(q[0])),
        s2(std::sin(q[1])),
        c2(std::cos(q[1])),
        s3(std::sin(q[2])),
        c3(std::cos(q[2])) {}

  [[nodiscard]] double radius() const noexcept { return l1 * c2 + l2 * s3; }
  /// Sine and cosine of q3 - q2.
  [[nodiscard]] double fold_sine() const noexcept { return s3 * c2 - c3 * s2; }
  [[nodiscard]] double fold_cosine() const noexcept { return c3 * c2 + s3 * s2; }

  double s1, c1, s2, c2, s3, c3;
};

Premium::Premium(const Options& options)
    : base_(base_yy + rotor(0)),
      upper_y_(be.yy + c.yy),
      upper_z_(be.zz + c.zz),
      fore_y_(a.yy + df.yy),
      fore_z_(a.zz + df.zz),
      upper_pitch_(be.xx + c.xx + rotor(1)),
      fore_pitch_(a.xx + df.xx + rotor(2)),
      coupling_(0.0),
      upper_weight_n_m_(be.mass_kg * l5),
      fore_weight_n_m_(-df.mass_kg * l6) {
  if (!(options.payload_kg >= 0.0) || !std::isfinite(options.payload_kg)) {
    throw std::invalid_argument("the payload of a Premium must be a mass in kg, zero or more");
  }
  for (const Point& point :
       {Point{a.mass_kg, l1, 0.5 * l2}, Point{c.mass_kg, 0.5 * l1, l3}, Point{options.payload_kg, l1, l2}}) {
    const double upper = point.mass_kg * point.upper_m * point.upper_m;
    const double fore = point.mass_kg * point.fore_m * point.fore_m;
    upper_y_ += upper;
    upper_pitch_ += upper;
    fore_z_ += fore;
    fore_pitch_ += fore;
    coupling_ += point.mass_kg * point.upper_m * point.fore_m;
    upper_weight_n_m_ += point.mass_kg * point.upper_m;
    fore_weight_n_m_ += point.mass_kg * point.fore_m;
  }
  const double weight = options.with_gravity ? gravity_m_s2 : 0.0;
  upper_weight_n_m_ *= weight;
  fore_weight_n_m_ *= weight;
}

Vector Premium::tip(const Directions& at) noexcept {
  const double radius = at.radius();
  return {radius * at.s1, l1 * at.s2 - l2 * at.c3 + l2, radius * at.c1 - l1};
}

Matrix Premium::jacobian(const Directions& at) noexcept {
  const double radius = at.radius();
  const double radius_2 = -l1 * at.s2;  // its derivatives by q2 and q3
  const double radius_3 = l2 * at.c3;
  return (Matrix() << radius * at.c1, radius_2 * at.s1, radius_3 * at.s1,  //
          0.0, l1 * at.c2, l2 * at.s3,                                     //
          -radius * at.s1, radius_2 * at.c1, radius_3 * at.c1)
      .finished();
}

Matrix Premium::jacobian_rate(const Directions& at, const Vector& qd) noexcept {
  const double radius = at.radius();
  const double radius_2 = -l1 * at.s2;
  const double radius_3 = l2 * at.c3;
  const double radius_rate = radius_2 * qd[1] + radius_3 * qd[2];
  const double radius_2_rate = -l1 * at.c2 * qd[1];
  const double radius_3_rate = -l2 * at.s3 * qd[2];
  const double s1_rate = at.c1 * qd[0];
  const double c1_rate = -at.s1 * qd[0];
  return (Matrix() << radius_rate * at.c1 + radius * c1_rate, radius_2_rate * at.s1 + radius_2 * s1_rate,
          radius_3_rate * at.s1 + radius_3 * s1_rate,  //
          0.0, -l1 * at.s2 * qd[1], l2 * at.c3 * qd[2], -radius_rate * at.s1 - radius * s1_rate,
          radius_2_rate * at.c1 + radius_2 * c1_rate, radius_3_rate * at.c1 + radius_3 * c1_rate)
      .finished();
}

Matrix Premium::inertia(const Directions& at) const noexcept {
  const double vertical = base_ + upper_y_ * at.c2 * at.c2 + upper_z_ * at.s2 * at.s2 +
                          fore_y_ * at.c3 * at.c3 + fore_z_ * at.s3 * at.s3 + 2.0 * coupling_ * at.c2 * at.s3;
  const double between = coupling_ * at.fold_sine();
  return (Matrix() << vertical, 0.0, 0.0, 0.0, upper_pitch_, between, 0.0, between, fore_pitch_).finished();
}

Matrix Premium::coriolis(const Directions& at, const Vector& qd) const noexcept {
  // Half the derivatives of H11 by q2 and q3, and the derivative of H23 by q3, which by q2 is its negative.
  const double by_2 = (upper_z_ - upper_y_) * at.c2 * at.s2 - coupling_ * at.s2 * at.s3;
  const double by_3 = (fore_z_ - fore_y_) * at.c3 * at.s3 + coupling_ * at.c2 * at.c3;
  const double between = coupling_ * at.fold_cosine();
  return (Matrix() << by_2 * qd[1] + by_3 * qd[2], by_2 * qd[0], by_3 * qd[0],  //
          -by_2 * qd[0], 0.0, between * qd[2],                                  //
          -by_3 * qd[0], -between * qd[1], 0.0)
      .finished();
}

Vector Premium::gravity(const Directions& at) const noexcept {
  return {0.0, upper_weight_n_m_ * at.c2, fore_weight_n_m_ * at.s3};
}

Vector Premium::tip(const Vector& q) noexcept { return tip(Directions(q)); }

Matrix Premium::jacobian(const Vector& q) noexcept { return jacobian(Directions(q)); }

Matrix Premium::jacobian_rate(const Vector& q, const Vector& qd) noexcept {
  return jacobian_rate(Directions(q), qd);
}

std::optional<Vector> Premium::joint_angles(const Vector& tip) noexcept {
  const double outwards = tip[2] + l1;
  const double radius = std::hypot(tip[0], outwards);
  const double height = tip[1] - l2;
  const double fold_sine = (radius * radius + height * height - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
  if (!(std::abs(fold_sine) <= 1.0)) return std::nullopt;
  // Seen from the upper arm, the tip is l1 + l2 sin(fold) along it and l2 cos(fold) below.
  const double fold_cosine = std::sqrt((1.0 - fold_sine) * (1.0 + fold_sine));
  const double q2 = std::atan2(height, radius) + std::atan2(l2 * fold_cosine, l1 + l2 * fold_sine);
  const Vector q{std::atan2(tip[0], outwards), q2, q2 + std::asin(fold_sine)};
  if (!within_limits(q)) return std::nullopt;
  return q;
}

bool Premium::within_limits(const Vector& q) noexcept {
  const auto inside = [](double value, const Range& range) {
    return value >= range.lower && value <= range.upper;
  };
  return inside(q[0], joint_range_rad[0]) && inside(q[1], joint_range_rad[1]) &&
         inside(q[2], joint_range_rad[2]) && inside(q[2] - q[1], fold_range_rad);
}

Matrix Premium::inertia(const Vector& q) const noexcept { return inertia(Directions(q)); }

Matrix Premium::coriolis(const Vector& q, const Vector& qd) const noexcept {
  return coriolis(Directions(q), qd);
}

Vector Premium::gravity(const Vector& q) const noexcept { return gravity(Directions(q)); }

double Premium::kinetic_energy(const Vector& q, const Vector& qd) const noexcept {
  return 0.5 * qd.dot(inertia(q) * qd);
}

double Premium::potential_energy(const Vector& q) const noexcept {
  return upper_weight_n_m_ * std::sin(q[1]) + fore_weight_n_m_ * (1.0 - std::cos(q[2]));
}

Premium::Dynamics Premium::dynamics(const Vector& q, const Vector& qd) const noexcept {
  const Directions at(q);
  Dynamics all;
  all.inertia = inertia(at);
  all.coriolis = coriolis(at, qd);
  all.coriolis_torque = all.coriolis * qd;
  all.gravity = gravity(at);
  all.jacobian = jacobian(at);
  all.jacobian_rate_times_v = jacobian_rate(at, qd) * qd;
  all.tip = tip(at);
  return all;
}

Vector Premium::acceleration(const Vector& q, const Vector& qd, const Vector& torque) const noexcept {
  const Directions at(q);
  const Matrix h = inertia(at);
  const Vector net = torque - coriolis(at, qd) * qd - gravity(at);
  const double determinant = h(1, 1) * h(2, 2) - h(1, 2) * h(1, 2);
  return {net[0] / h(0, 0), (h(2, 2) * net[1] - h(1, 2) * net[2]) / determinant,
          (h(1, 1) * net[2] - h(1, 2) * net[1]) / determinant};
}

}  // namespace kerf::mechanisms

#include "kerf/mechanisms/woodenhaptics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace kerf::mechanisms {
namespace {

using Configuration = WoodenHaptics::Configuration;
using Planar = Eigen::Vector2d;

constexpr double right_angle = 0.5 * std::numbers::pi;

Planar along(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }
/// Its derivative by the angle.
Planar across(double angle_rad) { return {-std::sin(angle_rad), std::cos(angle_rad)}; }
double angle_of(const Planar& direction) { return std::atan2(direction.y(), direction.x()); }
/// The angle of a triangle between two sides, opposite to the third; not a number if there is none such.
double angle_between(double side, double other, double opposite) {
  return std::acos((side * side + other * other - opposite * opposite) / (2.0 * side * other));
}

std::array<Configuration, 4> make_models() {
  Configuration woody_2016{.name = "woody-2016",
                           .capstan_m = {.010, .010, .010},
                           .body_m = {.160, .120, .120},
                           .length_m = {.080, .205, .245},
                           .origin_m = {.220, 0.0, .080},
                           .torque_constant = {.0259, .0259, .0259},
                           .max_current_a = 3.0,
                           .counts_per_turn = 2000.0,
                           .max_force_n = 5.0,
                           .max_stiffness_n_per_m = 1000.0,
                           .home_rad = {0.0, 0.0, right_angle}};
  Configuration woody_2019 = woody_2016;
  woody_2019.name = "woody-2019";
  woody_2019.torque_constant = {.321, .0603, .0603};
  Configuration aluhaptics{.name = "aluhaptics",
                           .capstan_m = {.0138, .0098, .0098},
                           .body_m = {.116, .076, .076},
                           .length_m = {.111, .140, .111},
                           .origin_m = {.140, 0.0, 0.0},
                           .torque_constant = {.0259, .0259, .0259},
                           .max_current_a = 3.0,
                           .counts_per_turn = 2000.0,
                           .max_force_n = 5.0,
                           .max_stiffness_n_per_m = 1000.0,
                           .home_rad = {0.0, 0.0, right_angle}};
  for (Configuration* one : {&woody_2016, &woody_2019, &aluhaptics}) {
    one->centre_m = WoodenHaptics(*one, {}).home();
  }
  Configuration polhem{
      .name = "polhem-v3",
      .capstan_m = {.0288, .013, .010},
      .body_m = {.175, .100, .100},
      .length_m = {0.0, .165, .1308},
      .origin_m = {.2045, 0.0, .0325},
      .torque_constant = {.0603, .0538, .0538},
      .max_current_a = 3.0,
      .counts_per_turn = 4096.0,
      .max_force_n = 5.0,
      .max_stiffness_n_per_m = 2000.0,
      .linkage = WoodenHaptics::Linkage{.base_m = .034, .crank_m = .025, .coupler_m = .190, .tail_m = .034}};
  // The makers preset the counters where the device is parked, far from the middle of its workspace.
  constexpr std::array parked_counts{8327.0, 10926.0, 27140.0};
  for (std::size_t i = 0; i < 3; ++i) {
    polhem.home_rad[i] = parked_counts[i] / polhem.counts_per_turn * 2.0 * std::numbers::pi *
                         polhem.capstan_m[i] / polhem.body_m[i];
  }
  return {woody_2016, woody_2019, aluhaptics, polhem};
}

}  // namespace

std::span<const Configuration> WoodenHaptics::configurations() noexcept {
  static const std::array<Configuration, 4> models = make_models();
  return models;
}

const Configuration* WoodenHaptics::find(std::string_view name) noexcept {
  const auto models = configurations();
  const auto place = std::ranges::find(models, name, &Configuration::name);
  return place == models.end() ? nullptr : &*place;
}

WoodenHaptics::Vector WoodenHaptics::angles(const std::array<int, 3>& counts) const noexcept {
  Vector all;
  for (std::size_t i = 0; i < 3; ++i) {
    all[static_cast<Eigen::Index>(i)] = made_.home_rad[i] + signs_.encoder[i] * 2.0 * std::numbers::pi *
                                                                counts[i] / made_.counts_per_turn *
                                                                made_.capstan_m[i] / made_.body_m[i];
  }
  return all;
}

std::array<double, 3> WoodenHaptics::counts(const Vector& angles_rad) const noexcept {
  std::array<double, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double turned =
        std::remainder(angles_rad[static_cast<Eigen::Index>(i)] - made_.home_rad[i], 2.0 * std::numbers::pi);
    counts[i] = signs_.encoder[i] * turned / (2.0 * std::numbers::pi) * made_.counts_per_turn *
                made_.body_m[i] / made_.capstan_m[i];
  }
  return counts;
}

WoodenHaptics::Arm WoodenHaptics::arm_in_series(double b_rad, double c_rad) const noexcept {
  const auto& [ln, lb, lc] = made_.length_m;
  const double sb = std::sin(b_rad);
  const double cb = std::cos(b_rad);
  const double sc = std::sin(c_rad);
  const double cc = std::cos(c_rad);
  return {.tip = {lb * sb + lc * sc, ln + lb * cb - lc * cc},
          .by_b = {lb * cb, -lb * sb},
          .by_c = {lc * cc, lc * sc}};
}

WoodenHaptics::Arm WoodenHaptics::arm_as_linkage(const Linkage& linkage, double b_rad,
                                                 double c_rad) const noexcept {
  const double upper_m = made_.length_m[1];
  const double fore_m = made_.length_m[2];
  const Planar knee = Planar(0.5 * linkage.base_m, 0.0) + upper_m * along(b_rad);
  const Planar crank = Planar(-0.5 * linkage.base_m, 0.0) + linkage.crank_m * along(c_rad);
  const Planar between = crank - knee;
  // The tail, opposite to the forearm, stands beside the line to the crank by an angle of the triangle of
  // that line, tail and coupler.
  const double lambda =
      angle_of(between) - std::numbers::pi - angle_between(between.norm(), linkage.tail_m, linkage.coupler_m);
  // The coupler keeps its length: its ends move alike along it.
  const Planar coupler = knee - linkage.tail_m * along(lambda) - crank;
  const double lever = linkage.tail_m * coupler.dot(across(lambda));
  const Planar knee_by_b = upper_m * across(b_rad);
  const double lambda_by_b = coupler.dot(knee_by_b) / lever;
  const double lambda_by_c = -linkage.crank_m * coupler.dot(across(c_rad)) / lever;
  return {.tip = knee + fore_m * along(lambda),
          .by_b = knee_by_b + fore_m * lambda_by_b * across(lambda),
          .by_c = fore_m * lambda_by_c * across(lambda)};
}

WoodenHaptics::Arm WoodenHaptics::arm(double b_rad, double c_rad) const noexcept {
  return made_.linkage ? arm_as_linkage(*made_.linkage, b_rad, c_rad) : arm_in_series(b_rad, c_rad);
}

WoodenHaptics::Vector WoodenHaptics::tip(const Vector& angles_rad) const noexcept {
  const Planar at = arm(angles_rad[1], angles_rad[2]).tip;
  const auto& [ox, oy, oz] = made_.origin_m;
  return {std::cos(angles_rad[0]) * at.x() - ox, std::sin(angles_rad[0]) * at.x() - oy, at.y() - oz};
}

std::optional<WoodenHaptics::Vector> WoodenHaptics::angles_of(const Vector& tip_m) const noexcept {
  const auto& [ln, lb, lc] = made_.length_m;
  const auto& [ox, oy, oz] = made_.origin_m;
  const double forward = tip_m[0] + ox;
  const double aside = tip_m[1] + oy;
  const Planar tip(std::hypot(forward, aside), tip_m[2] + oz);
  const Planar shoulder(made_.linkage ? 0.5 * made_.linkage->base_m : 0.0, ln);
  const double far = (tip - shoulder).norm();
  const double upper = angle_of(tip - shoulder) + angle_between(lb, far, lc);
  const Planar knee = shoulder + lb * along(upper);
  const double lambda = angle_of(tip - knee);
  Vector angles(std::atan2(aside, forward), upper, 0.0);
  if (made_.linkage) {
    const Linkage& linkage = *made_.linkage;
    const Planar pivot(-0.5 * linkage.base_m, 0.0);
    const Planar tail = knee - linkage.tail_m * along(lambda) - pivot;
    angles[2] = angle_of(tail) + angle_between(linkage.crank_m, tail.norm(), linkage.coupler_m);
  } else {
    // From the vertical, the one from above and the other from below.
    angles[1] = right_angle - upper;
    angles[2] = right_angle + lambda;
  }
  return angles.allFinite() ? std::optional(angles) : std::nullopt;
}

WoodenHaptics::Matrix WoodenHaptics::jacobian(const Vector& angles_rad) const noexcept {
  const Arm at = arm(angles_rad[1], angles_rad[2]);
  const double sa = std::sin(angles_rad[0]);
  const double ca = std::cos(angles_rad[0]);
  Matrix rates;
  rates << -sa * at.tip.x(), ca * at.by_b.x(), ca * at.by_c.x(),  //
      ca * at.tip.x(), sa * at.by_b.x(), sa * at.by_c.x(),        //
      0.0, at.by_b.y(), at.by_c.y();
  return rates;
}

WoodenHaptics::Currents WoodenHaptics::currents(const Vector& force_n,
                                                const Vector& angles_rad) const noexcept {
  const Vector torque = jacobian(angles_rad).transpose() * force_n;
  Currents all;
  if (!torque.allFinite()) return {.ampere = {}, .limited = true};
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    all.ampere[i] = signs_.motor[i] * torque[static_cast<Eigen::Index>(i)] * made_.capstan_m[i] /
                    made_.body_m[i] / made_.torque_constant[i];
    largest = std::max(largest, std::abs(all.ampere[i]));
  }
  all.limited = largest > made_.max_current_a;
  if (all.limited) {
    for (double& current : all.ampere) current *= made_.max_current_a / largest;
  }
  return all;
}

WoodenHaptics::Vector WoodenHaptics::force(const std::array<double, 3>& ampere,
                                           const Vector& angles_rad) const noexcept {
  Vector torque;
  for (std::size_t i = 0; i < 3; ++i) {
    torque[static_cast<Eigen::Index>(i)] =
        signs_.motor[i] * ampere[i] * made_.torque_constant[i] * made_.body_m[i] / made_.capstan_m[i];
  }
  return jacobian(angles_rad).transpose().inverse() * torque;
}

}  // namespace kerf::mechanisms

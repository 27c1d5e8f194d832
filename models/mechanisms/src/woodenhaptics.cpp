#include "kerf/mechanisms/woodenhaptics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace kerf::mechanisms {
namespace {

using Configuration = WoodenHaptics::Configuration;

constexpr std::array<Configuration, 4> models{{{"woody-2016",
                                                {.010, .010, .010},
                                                {.160, .120, .120},
                                                {.080, .205, .245},
                                                {.220, 0.0, .080},
                                                {.0259, .0259, .0259},
                                                3.0,
                                                2000.0,
                                                5.0,
                                                1000.0},
                                               {"woody-2019",
                                                {.010, .010, .010},
                                                {.160, .120, .120},
                                                {.080, .205, .245},
                                                {.220, 0.0, .080},
                                                {.321, .0603, .0603},
                                                3.0,
                                                2000.0,
                                                5.0,
                                                1000.0},
                                               {"aluhaptics",
                                                {.0138, .0098, .0098},
                                                {.116, .076, .076},
                                                {.111, .140, .111},
                                                {.140, 0.0, 0.0},
                                                {.0259, .0259, .0259},
                                                3.0,
                                                2000.0,
                                                5.0,
                                                1000.0},
                                               {"polhem-v3",
                                                {.0288, .013, .010},
                                                {.175, .100, .100},
                                                {.100, .165, .1308},
                                                {.2045, 0.0, .0325},
                                                {.0603, .0538, .0538},
                                                3.0,
                                                4096.0,
                                                5.0,
                                                2000.0}}};

constexpr std::array<double, 3> encoder_sign{-1.0, -1.0, 1.0};  // of the encoder and the gear together
constexpr std::array<double, 3> motor_sign{1.0, -1.0, -1.0};

}  // namespace

std::span<const Configuration> WoodenHaptics::configurations() noexcept { return models; }

const Configuration* WoodenHaptics::find(std::string_view name) noexcept {
  const auto* const place =
      std::find_if(models.begin(), models.end(), [&](const Configuration& one) { return one.name == name; });
  return place == models.end() ? nullptr : place;
}

WoodenHaptics::Vector WoodenHaptics::angles(const std::array<int, 3>& counts) const noexcept {
  Vector turn;
  for (std::size_t i = 0; i < 3; ++i) {
    turn[static_cast<Eigen::Index>(i)] = encoder_sign[i] * 2.0 * std::numbers::pi * counts[i] /
                                         made_.counts_per_turn * made_.capstan_m[i] / made_.body_m[i];
  }
  return {turn[0], turn[1], 0.5 * std::numbers::pi - turn[2]};
}

std::array<double, 3> WoodenHaptics::counts(const Vector& angles_rad) const noexcept {
  const Vector turn(angles_rad[0], angles_rad[1], 0.5 * std::numbers::pi - angles_rad[2]);
  std::array<double, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    counts[i] = encoder_sign[i] * turn[static_cast<Eigen::Index>(i)] / (2.0 * std::numbers::pi) *
                made_.counts_per_turn * made_.body_m[i] / made_.capstan_m[i];
  }
  return counts;
}

WoodenHaptics::Vector WoodenHaptics::tip(const Vector& angles_rad) const noexcept {
  const auto& [ln, lb, lc] = made_.length_m;
  const auto& [ox, oy, oz] = made_.origin_m;
  const double reach = lb * std::sin(angles_rad[1]) + lc * std::sin(angles_rad[2]);
  return {std::cos(angles_rad[0]) * reach - ox, std::sin(angles_rad[0]) * reach - oy,
          ln + lb * std::cos(angles_rad[1]) - lc * std::cos(angles_rad[2]) - oz};
}

std::optional<WoodenHaptics::Vector> WoodenHaptics::angles_of(const Vector& tip_m) const noexcept {
  const auto& [ln, lb, lc] = made_.length_m;
  const auto& [ox, oy, oz] = made_.origin_m;
  const double forward = tip_m[0] + ox;
  const double aside = tip_m[1] + oy;
  const double out = std::hypot(forward, aside);
  const double up = tip_m[2] + oz - ln;
  const double square = out * out + up * up;
  const double far = std::sqrt(square);
  const double cos_at_b = (lb * lb + square - lc * lc) / (2.0 * lb * far);
  const double cos_at_c = (lc * lc + square - lb * lb) / (2.0 * lc * far);
  if (!(std::abs(cos_at_b) <= 1.0 && std::abs(cos_at_c) <= 1.0)) return std::nullopt;
  const double from_vertical = std::atan2(out, up);
  return Vector(std::atan2(aside, forward), from_vertical - std::acos(cos_at_b),
                std::numbers::pi - from_vertical - std::acos(cos_at_c));
}

WoodenHaptics::Matrix WoodenHaptics::jacobian(const Vector& angles_rad) const noexcept {
  const double lb = made_.length_m[1];
  const double lc = made_.length_m[2];
  const double sa = std::sin(angles_rad[0]);
  const double ca = std::cos(angles_rad[0]);
  const double sb = std::sin(angles_rad[1]);
  const double cb = std::cos(angles_rad[1]);
  const double sc = std::sin(angles_rad[2]);
  const double cc = std::cos(angles_rad[2]);
  const double reach = lb * sb + lc * sc;
  Matrix rates;
  rates << -sa * reach, lb * ca * cb, lc * ca * cc,  //
      ca * reach, lb * sa * cb, lc * sa * cc,        //
      0.0, -lb * sb, lc * sc;
  return rates;
}

WoodenHaptics::Currents WoodenHaptics::currents(const Vector& force_n,
                                                const Vector& angles_rad) const noexcept {
  const Vector torque = jacobian(angles_rad).transpose() * force_n;
  Currents all;
  if (!torque.allFinite()) return {.ampere = {}, .limited = true};
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    all.ampere[i] = motor_sign[i] * torque[static_cast<Eigen::Index>(i)] * made_.capstan_m[i] /
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
        motor_sign[i] * ampere[i] * made_.torque_constant[i] * made_.body_m[i] / made_.capstan_m[i];
  }
  return jacobian(angles_rad).transpose().inverse() * torque;
}

}  // namespace kerf::mechanisms

#include "prepare/weight.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/models/rotation.h>

#include "prepare/prepare.h"

namespace kerf::bench {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using testing::ThrowsMessage;

const Vector3d centre(0.01, -0.02, 0.05);
const Vector3d force_bias(0.5, -0.3, 0.2);
const Vector3d torque_bias(0.01, 0.02, -0.03);

/// A free tool of 0.2 kg that is tilted about x and y by `tilt` and `tilt_y` [rad], six axes in the sensor's
/// frame.
schema::Recording tilted(double tilt_x, double tilt_y, double noise = 0.0, bool base_frame = false) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal(0.0, 1.0);
  schema::Recording recording;
  for (const char* name : {"x", "y", "z"}) recording.axes.push_back({.name = name});
  for (const char* name : {"rx", "ry", "rz"}) {
    recording.axes.push_back({.name = name, .position_unit = "rad", .force_unit = "N·m"});
  }
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.01 * i;
    const Vector3d turn(tilt_x * std::sin(t), tilt_y * std::sin(1.7 * t), 0.0);
    const double angle = turn.norm();
    const Eigen::Matrix3d r =
        angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
    const Vector3d pull = 0.2 * (r.transpose() * Vector3d(0.0, 0.0, -9.80665));
    Vector3d force = force_bias + pull;
    Vector3d torque = torque_bias + centre.cross(pull);
    if (base_frame) {
      force = r * force;
      torque = r * torque;
    }
    recording.time.push_back(t);
    for (const double x : {0.0, 0.0, 0.0, turn.x(), turn.y(), turn.z()}) recording.position.push_back(x);
    for (const double f : force) recording.force_measured.push_back(f + noise * normal(random));
    for (const double f : torque) recording.force_measured.push_back(f + 0.02 * noise * normal(random));
  }
  recording.velocity.assign(recording.position.size(), 0.0);
  return recording;
}

TEST(Weight, IsFoundAndTakenOffExactly) {
  for (const bool base_frame : {false, true}) {
    schema::Recording recording = tilted(0.5, 0.4, 0.0, base_frame);
    const Weight weight = remove_weight(recording, std::vector<bool>(2000, true), {.base_frame = base_frame});
    EXPECT_NEAR(weight.mass_kg, 0.2, 1e-12);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(weight.centre_m[i], centre[at], 1e-10);
      EXPECT_NEAR(weight.force_bias_n[i], force_bias[at], 1e-10);
      EXPECT_NEAR(weight.torque_bias_nm[i], torque_bias[at], 1e-10);
    }
    for (const double force : recording.force_measured) ASSERT_NEAR(force, 0.0, 1e-10);
  }
}

TEST(Weight, IsTakenOffTorquesOfTheAxesOfARotationVector) {
  schema::Recording recording = tilted(0.5, 0.4, 0.0, true);
  recording.header.device_properties["torques"] = "generalised";  // as an import of six axes says
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const Vector3d turn(&recording.position[6 * row + 3]);
    const Vector3d moment(&recording.force_measured[6 * row + 3]);
    const Vector3d torque = models::left_jacobian(turn).transpose() * moment;
    std::copy_n(torque.data(), 3, &recording.force_measured[6 * row + 3]);
  }
  const Weight weight = remove_weight(recording, std::vector<bool>(2000, true), {});
  EXPECT_NEAR(weight.mass_kg, 0.2, 1e-12);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(weight.centre_m[i], centre[static_cast<Eigen::Index>(i)], 1e-10);
    EXPECT_NEAR(weight.torque_bias_nm[i], torque_bias[static_cast<Eigen::Index>(i)], 1e-10);
  }
  for (const double force : recording.force_measured) ASSERT_NEAR(force, 0.0, 1e-10);
}

TEST(Weight, OfANoisySensorIsWithinItsStandardErrors) {
  schema::Recording recording = tilted(0.5, 0.4, 0.05);
  const Weight weight = remove_weight(recording, std::vector<bool>(2000, true), {});
  EXPECT_NEAR(weight.mass_kg, 0.2, 3.0 * weight.mass_error_kg);
  EXPECT_LT(weight.mass_error_kg, 0.001);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(weight.centre_m[i], centre[static_cast<Eigen::Index>(i)], 3.0 * weight.centre_error_m[i]);
    EXPECT_LT(weight.centre_error_m[i], 0.001);
  }
  EXPECT_NEAR(weight.force_noise_n, 0.05, 0.003);
}

TEST(Weight, ThatIsKnownIsTakenOffWithoutTheBias) {
  schema::Recording recording = tilted(0.5, 0.4);
  const Weight weight = remove_weight(recording, std::vector<bool>(2000, false),
                                      {.mass_kg = 0.2, .centre_m = {0.01, -0.02, 0.05}});
  EXPECT_FALSE(weight.estimated);
  EXPECT_EQ(weight.condition, 0.0) << "no equations were solved";
  for (std::size_t row = 0; row < 2000; ++row) {
    ASSERT_NEAR(recording.force_measured[6 * row + 1], force_bias.y(), 1e-12);
    ASSERT_NEAR(recording.force_measured[6 * row + 5], torque_bias.z(), 1e-12);
  }
}

TEST(Weight, IsToldWithItsErrorWhereItWasEstimated) {
  PrepareOptions options{.weight = true};
  options.contact.free = {{.begin_s = 0.0, .end_s = 20.0}};
  const std::string estimated = prepare(tilted(0.5, 0.4), options).steps.at(0);
  EXPECT_THAT(estimated, HasSubstr("weight of 0.2 kg"));
  EXPECT_THAT(estimated, HasSubstr("estimated with"));
  options.weight_options = {.mass_kg = 0.2, .centre_m = {0.01, -0.02, 0.05}};
  EXPECT_EQ(prepare(tilted(0.5, 0.4), options).steps.at(0),
            "weight of 0.2 kg at 0.01, -0.02, 0.05 m taken off");
}

TEST(Weight, NeedsOrientationsThatDiffer) {
  const std::vector<bool> free(2000, true);
  const auto attempt = [&](double tilt_x, double tilt_y) {
    return [=] {
      schema::Recording recording = tilted(tilt_x, tilt_y);
      (void)remove_weight(recording, free, {});
    };
  };
  EXPECT_THAT(attempt(0.0, 0.0), ThrowsMessage<std::invalid_argument>(HasSubstr("the weight from the bias")));
  EXPECT_THAT(attempt(0.01, 0.01), ThrowsMessage<std::invalid_argument>(HasSubstr("three orientations")));
}

TEST(Weight, NeedsSixAxesAndFreeRows) {
  schema::Recording recording = tilted(0.5, 0.4);
  EXPECT_THAT([&] { (void)remove_weight(recording, std::vector<bool>(2000, false), {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("0 rows are free")));
  recording.axes[4].name = "yaw";
  EXPECT_THAT([&] { (void)remove_weight(recording, std::vector<bool>(2000, true), {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no such axis 'ry'")));
}

}  // namespace
}  // namespace kerf::bench

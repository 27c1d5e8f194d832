#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

#include "run/run.h"
#include "scene/scalpel_paths.h"
#include "scene/scene.h"
#include "support/program.h"

// The scenes in examples/scenes, as docs/scenes.md describes them.

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

Scene shipped(const std::string& name) {
  return read_scene(fs::path(KERF_SOURCE_DIR) / "examples/scenes" / (name + ".scene.toml"));
}

struct Expected {
  std::string name;
  std::string axis;   ///< on which the force is largest
  double least_peak;  ///< of the force measured, 10 s in virtual time [N]
  double max_peak;
};
const std::vector<Expected> all{{"scissors-skin", "theta", 2.5, 4.0},   {"scissors-liver", "theta", 0.4, 1.0},
                                {"scissors-tendon", "theta", 4.0, 6.0}, {"scalpel-t1", "x", 0.2, 0.3},
                                {"scalpel-t2", "x", 1e-3, 5e-3},        {"palpation", "z", 2.0, 3.0}};

std::size_t axis_of(const schema::Recording& recording, const std::string& name) {
  const auto found = std::ranges::find(recording.axes, name, &schema::Axis::name);
  return static_cast<std::size_t>(found - recording.axes.begin());
}

/// One axis of the force measured.
std::vector<double> force_on(const schema::Recording& recording, const std::string& axis) {
  std::vector<double> force;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    force.push_back(recording.force_measured[row * recording.dimensions() + axis_of(recording, axis)]);
  }
  return force;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

class ShippedScenes : public testing::Test {
 protected:
  [[nodiscard]] schema::Recording recorded(const std::string& name) const {
    const fs::path file = folder_ / (name + ".h5");
    const std::string scene = std::string(KERF_SOURCE_DIR) + "/examples/scenes/" + name + ".scene.toml";
    const test::Outcome outcome =
        test::run_kerf({"record", "--scene", scene, "--seconds", "10", "--virtual", "-o", file.string()});
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    return schema::read_recording(file);
  }
  test::TemporaryFolder folder_;
};

TEST_F(ShippedScenes, AreSix) {
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(KERF_SOURCE_DIR) / "examples/scenes")) {
    files += entry.path().extension() == ".toml" ? 1U : 0U;
  }
  EXPECT_EQ(files, all.size());
}

TEST_F(ShippedScenes, SayWhatTheToolDoesAndKeepItWithinReach) {
  for (const Expected& one : all) {
    const Scene scene = shipped(one.name);
    EXPECT_FALSE(scene.name.empty());
    EXPECT_FALSE(scene.tool.empty());
    const drivers::DeviceInfo device = drivers::open_device(device_of(scene))->info();
    const SampledMotion path = tool_path(scene, 1000.0);
    ASSERT_GT(path.ticks(), 1000U) << one.name;
    for (std::size_t tick = 0; tick < path.ticks(); ++tick) {
      for (std::size_t axis = 0; axis < device.axes.size(); ++axis) {
        ASSERT_TRUE(std::isfinite(path.sample[tick].velocity[axis]));
        ASSERT_GE(path.sample[tick].position[axis], device.axes[axis].lower) << one.name;
        ASSERT_LE(path.sample[tick].position[axis], device.axes[axis].upper) << one.name;
      }
    }
  }
}

TEST_F(ShippedScenes, AreFeltAsStrongAsTheySay) {
  for (const Expected& one : all) {
    const schema::Recording recording = recorded(one.name);
    ASSERT_EQ(recording.rows(), 10000U);
    const double peak = largest(force_on(recording, one.axis));
    EXPECT_GT(peak, one.least_peak) << one.name;
    EXPECT_LT(peak, one.max_peak) << one.name;
  }
}

TEST_F(ShippedScenes, OfSkinGiveWayWithinATickAndAreMetAnew) {
  const std::vector<double> force = force_on(recorded("scissors-skin"), "theta");
  int drops = 0;
  for (std::size_t tick = 2; tick < force.size(); ++tick)
    drops += force[tick - 2] - force[tick] > 2.0 ? 1 : 0;
  EXPECT_GE(drops, 4) << "a cut every 2.1 s";
}

TEST_F(ShippedScenes, OfPalpationRelaxInTheHold) {
  const std::vector<double> force = force_on(recorded("palpation"), "z");
  // The hold is from 1.4 to 4.4 s; tip and hand give way together, so that the hand's spring counts too.
  EXPECT_LT(force[4300], 0.9 * largest(force));
  EXPECT_LT(force[4300], force[2000]);
  EXPECT_GT(force[4300], 1.0);
}

TEST_F(ShippedScenes, OfTheTurningScalpelAreFeltAboutItsAxis) {
  const std::vector<double> torque = force_on(recorded("scalpel-t2"), "rz");
  EXPECT_NEAR(largest(torque), 51e-6, 3e-6) << "the figure of `kerf reproduce Henry2004`";
  // The same with the strips of the paper, all of one velocity: none but the edge's own.
  Scene scene = shipped("scalpel-t2");
  auto options = scene.tissue.law.options();
  options["fidelity"] = std::string("paper");
  scene.tissue.law = models::Law::make("blade", scene.tissue.law.values(), options);
  const drivers::Surroundings around = surroundings_of(scene, drivers::open_device("sim:pose6")->info());
  const SampledMotion path = tool_path(scene, 1000.0);
  double most = 0.0;
  for (const auto& [position, velocity] : path.sample) {
    most = std::max(most, std::abs(around.tissue_of_axes(position, velocity, 1e-3)[5]));
  }
  EXPECT_LT(most, 1e-9);
}

TEST_F(ShippedScenes, OfTheScalpelAreThePathsOfThePaper) {
  for (const auto& [name, keyframes] :
       {std::pair{"scalpel-t1", scalpel_t1()}, std::pair{"scalpel-t2", scalpel_t2()}}) {
    const drivers::PosePath paper({.keyframes = keyframes});
    const SampledMotion path = tool_path(shipped(name), 1000.0);
    for (std::size_t tick = 0; 1e-3 * static_cast<double>(tick) < keyframes.back().at_s; ++tick) {
      const auto expected = paper.at(1e-3 * static_cast<double>(tick));
      for (std::size_t axis = 0; axis < drivers::max_axes; ++axis) {
        ASSERT_NEAR(path.sample[tick].position[axis], expected.position[axis], 1e-12) << name;
        ASSERT_NEAR(path.sample[tick].velocity[axis], expected.velocity[axis], 1e-12) << name;
      }
    }
  }
}

}  // namespace
}  // namespace kerf::bench

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace kerf::bench {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

const std::string kelvin = R"(
position_unit = "UNIT"
[tissue.parameters]
parallel_stiffness = { value = 5.0, unit = "N/UNIT" }
series_stiffness = { value = 8.0, unit = "N/UNIT" }
damping = { value = 1.6, unit = "N·s/UNIT" }
)";

/// A scene with a Kelvin tissue on an axis, and what else it says.
Scene scene_on(const std::string& axis, const std::string& unit, const std::string& more) {
  std::string text = "[tissue]\nmodel = \"kelvin\"\naxis = \"" + axis + "\"" + kelvin;
  for (auto at = text.find("UNIT"); at != std::string::npos; at = text.find("UNIT")) {
    text.replace(at, 4, unit);
  }
  return parse_scene(text + more, "scene.toml");
}

const Scene strokes = scene_on("theta", "rad", R"([trajectory]
kind = "strokes"
seconds = { value = 4, unit = "s" }
open = { value = 30, unit = "deg" }
close = { value = 10, unit = "deg" }
stroke = { value = 0.5, unit = "s" }
pause = { value = 0.25, unit = "s" }
variation = 0.1
)");

const Scene indentation = scene_on("z", "m", R"([trajectory]
kind = "indent"
axis = "z"
from = { value = 5, unit = "mm" }
to = { value = -10, unit = "mm" }
stroke = { value = 0.6, unit = "s" }
hold = { value = 2, unit = "s" }
pause = { value = 0.4, unit = "s" }
cycles = 2
)");

const Scene keyframes = scene_on("z", "m", R"([trajectory]
kind = "keyframes"
repeat = true
seconds = { value = 3, unit = "s" }
[[trajectory.keyframe]]
at = { value = 0, unit = "s" }
position = { z = { value = 100, unit = "mm" } }
[[trajectory.keyframe]]
at = { value = 0.8, unit = "s" }
position = { x = { value = -4, unit = "cm" }, rz = { value = 60, unit = "deg" } }
[[trajectory.keyframe]]
at = { value = 2, unit = "s" }
position = { x = { value = 0, unit = "m" }, rz = { value = 0, unit = "rad" } }
)");

TEST(ToolPath, OfStrokesIsHalfwayInTheMiddleOfAStroke) {
  const SampledMotion path = tool_path(strokes, 1000.0);
  EXPECT_EQ(path.period_s[7], 1e-3);
  ASSERT_EQ(path.ticks(), 4000U);
  EXPECT_NEAR(path.sample[100].position[0], 30.0 * degree, 1e-15) << "open during the pause";
  // Minimum jerk in the middle: half of the way, at 1.875 times the mean speed.
  EXPECT_NEAR(path.sample[500].position[0], 20.0 * degree, 1e-12);
  EXPECT_NEAR(path.sample[500].velocity[0], -1.875 * 20.0 * degree / 0.5, 1e-12);
  EXPECT_NEAR(path.sample[850].position[0], 10.0 * degree, 1e-12) << "closed, and without the variation";
  EXPECT_NEAR(path.sample[1250].velocity[0], 1.875 * 20.0 * degree / 0.5, 1e-12) << "opening";
}

TEST(ToolPath, OfAnIndentationHoldsAtTheDepth) {
  const SampledMotion path = tool_path(indentation, 1000.0);
  ASSERT_EQ(path.ticks(), 7200U) << "two cycles";
  EXPECT_NEAR(path.sample[700].position[2], -2.5e-3, 1e-15);
  EXPECT_NEAR(path.sample[700].velocity[2], -1.875 * 15e-3 / 0.6, 1e-12);
  for (const std::size_t tick : {1000U, 2000U, 3000U}) {
    EXPECT_EQ(path.sample[tick].position[2], -0.01);
    EXPECT_EQ(path.sample[tick].velocity[2], 0.0);
  }
  EXPECT_EQ(path.sample[3600].position[2], 0.005);
  EXPECT_EQ(path.sample[700].position[0], 0.0);
}

TEST(ToolPath, OfKeyframesMovesEveryAxisAtOnceAndRepeats) {
  const SampledMotion path = tool_path(keyframes, 1000.0);
  ASSERT_EQ(path.ticks(), 3000U);
  EXPECT_NEAR(path.sample[400].position[0], -0.02, 1e-15);
  EXPECT_NEAR(path.sample[400].velocity[5], 1.875 * 60.0 * degree / 0.8, 1e-12);
  EXPECT_EQ(path.sample[800].position[2], 0.1) << "an axis that is not named stays";
  EXPECT_NEAR(path.sample[2400].position[0], -0.02, 1e-12) << "and again";
}

TEST(ToolPath, HasTheDerivativeOfItsPositionAsVelocity) {
  constexpr double rate_hz = 20000.0;
  for (const Scene* scene : {&strokes, &indentation, &keyframes}) {
    const SampledMotion path = tool_path(*scene, rate_hz);
    double worst = 0.0;
    for (std::size_t tick = 1; tick + 1 < path.ticks(); ++tick) {
      for (std::size_t axis = 0; axis < drivers::max_axes; ++axis) {
        const double difference =
            0.5 * rate_hz * (path.sample[tick + 1].position[axis] - path.sample[tick - 1].position[axis]);
        worst = std::max(worst, std::abs(difference - path.sample[tick].velocity[axis]));
      }
    }
    EXPECT_LT(worst, 1e-6);
  }
}

TEST(ToolPath, IsThatOfTheDeviceIfTheSceneHasNoTrajectory) {
  const SampledMotion path = tool_path(default_scene(), 1000.0);
  EXPECT_EQ(path.ticks(), 10000U);
  EXPECT_NEAR(path.sample[650].position[0], 0.5 * drivers::HandOptions{}.open_rad, 1e-12);
  const SampledMotion named =
      tool_path(scene_on("theta", "rad", "[device]\nuri = \"sim:scissors?open=20deg\"\n"), 1000.0);
  EXPECT_NEAR(named.sample[650].position[0], 10.0 * degree, 1e-12);
  const SampledMotion poses = tool_path(
      scene_on("z", "m", "[device]\nuri = \"sim:pose6?path=0s:0:0:0mm:0:0:0deg,1s:0:0:8mm:0:0:0deg\"\n"),
      1000.0);
  EXPECT_NEAR(poses.sample[500].position[2], 4e-3, 1e-15);
}

TEST(ToolPath, IsRefusedWhereNothingIsKnownOfIt) {
  EXPECT_THROW((void)tool_path(scene_on("z", "m", ""), 1000.0), std::invalid_argument);
  EXPECT_THROW((void)tool_path(strokes, 0.5), std::invalid_argument);
  EXPECT_THROW((void)tool_path(scene_on("theta", "rad", R"([trajectory]
kind = "strokes"
seconds = { value = 1, unit = "min" }
)"),
                               1e6),
               std::invalid_argument)
      << "60 million ticks";
}

}  // namespace
}  // namespace kerf::bench

#include "kerf/drivers/pose_path.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

TEST(PosePath, IsHalfwayInTheMiddleOfALegWithEveryAxis) {
  const PosePath path({.keyframes = {{0.0, {0.01, 0.0, 0.1, 0.0, 0.0, 0.0}},
                                     {0.5, {0.03, 0.0, 0.1, 0.0, 0.0, 1.0}},
                                     {1.5, {0.03, 0.0, 0.1, 0.0, 0.0, 1.0}}}});
  const auto middle = path.at(0.25);
  EXPECT_NEAR(middle.position[0], 0.02, 1e-16);
  EXPECT_NEAR(middle.position[5], 0.5, 1e-15);
  EXPECT_NEAR(middle.velocity[0], 1.875 * 0.02 / 0.5, 1e-15);
  EXPECT_NEAR(middle.velocity[5], 1.875 * 1.0 / 0.5, 1e-14);
  EXPECT_EQ(middle.position[2], 0.1);
  EXPECT_EQ(path.at(1.0).velocity[0], 0.0);
}

TEST(PosePath, StaysAtItsEndOrBeginsAnew) {
  const std::vector<PoseKeyframe> there_and_back{{0.0, {}}, {1.0, {0.02}}, {2.0, {}}};
  EXPECT_EQ(PosePath({.keyframes = there_and_back}).at(3.0).position[0], 0.0);
  const PosePath round({.keyframes = there_and_back, .repeat = true});
  EXPECT_NEAR(round.at(2.5).position[0], 0.01, 1e-15);
  EXPECT_NEAR(round.at(21.0).position[0], 0.02, 1e-15);
  EXPECT_EQ(PosePath({.keyframes = {{0.0, {0.3}}}, .repeat = true}).at(7.0).position[0], 0.3);
}

TEST(PosePath, ReadsMillimetresAndDegrees) {
  const auto keyframes = parse_keyframes("0s:0:0:100mm:0:0:0rad,0.8s:1:-40:100mm:0:0:30deg");
  ASSERT_EQ(keyframes.size(), 2U);
  EXPECT_EQ(keyframes[1].at_s, 0.8);
  EXPECT_DOUBLE_EQ(keyframes[1].position[1], -0.04);
  EXPECT_DOUBLE_EQ(keyframes[1].position[5], 30.0 * degree);
}

TEST(PosePath, IsTheSameAfterBeingWrittenAndRead) {
  const std::vector<PoseKeyframe> path{{0.0, {1e-7, -0.1, 1.0 / 3.0, 0.0, 0.0, 0.0}},
                                       {1.0 / 7.0, {0.0, 0.0, 0.0, 0.1, -1.0 / 3.0, std::numbers::pi}}};
  const auto read = parse_keyframes(to_text(path));
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].at_s, path[i].at_s);
    EXPECT_EQ(read[i].position, path[i].position);
  }
}

TEST(PosePath, RefusesATextThatIsNone) {
  for (const char* text : {"", "0s", "0s:0:0:0mm", "0s:0:0:0mm:0:0:0", "0:0:0:0mm:0:0:0deg",
                           "0s:0:0:0cm:0:0:0deg", "0s:0:0:0mm:0:0:0deg:1", "0s:0:0:0mm:0:0:0deg,",
                           "0s:0:0:nanmm:0:0:0deg", "0s:0:0mm:0:0:0deg", "0s:0:0:0mm:0:0:0degree"}) {
    EXPECT_THROW((void)parse_keyframes(text), DeviceError) << text;
  }
}

TEST(PosePath, RefusesKeyframesOutOfOrderAndARoundThatDoesNotClose) {
  EXPECT_THROW(PosePath({.keyframes = {}}), DeviceError);
  EXPECT_THROW(PosePath({.keyframes = {{0.5, {}}}}), DeviceError);
  EXPECT_THROW(PosePath({.keyframes = {{0.0, {}}, {1.0, {}}, {1.0, {}}}}), DeviceError);
  EXPECT_THROW(PosePath({.keyframes = {{0.0, {}}, {1.0, {0.1}}}, .repeat = true}), DeviceError);
}

}  // namespace
}  // namespace kerf::drivers

#include "stability/tool_way.h"

#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "support/example_laws.h"

namespace kerf::bench {
namespace {

PlacedWay placed(std::string_view model, const char* device, const WayRequest& request) {
  return place_way(request, {.law = test::example(model)}, drivers::open_device(device)->info());
}

TEST(ToolWay, HasADirectionOfUnitLength) {
  const PlacedWay there =
      placed("blade", "sim:pose6", {.along = {"x=3", "z=-4"}, .from = {"z=0.1", "rz=0.5"}});
  EXPECT_DOUBLE_EQ(there.way.direction[0], 0.6);
  EXPECT_DOUBLE_EQ(there.way.direction[2], -0.8);
  EXPECT_DOUBLE_EQ(there.way.force_share[2], -0.8);
  EXPECT_EQ(there.way.from, (models::AxisValues{0.0, 0.0, 0.1, 0.0, 0.0, 0.5}));
  EXPECT_EQ(there.device_axis, 2U) << "whose share is the largest";
}

TEST(ToolWay, IsTheTravelOfTheLeverAndItsForceIsThatOfTheHandle) {
  const drivers::DeviceInfo scissors = drivers::open_device("sim:scissors")->info();
  const PlacedWay closing =
      placed("scissors", "sim:scissors", {.along = {"theta=-1"}, .from = {"theta=0.5"}});
  EXPECT_DOUBLE_EQ(closing.way.direction[0] * scissors.axes[0].lever, -1.0);
  EXPECT_DOUBLE_EQ(closing.way.force_share[0], -1.0);
}

}  // namespace
}  // namespace kerf::bench

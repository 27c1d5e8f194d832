#include "scene/scene.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string spring = R"(name = "a spring"

[tissue]
model = "kelvin"
axis = "theta"
position_unit = "rad"

[tissue.contact]
position = { value = 0.5, unit = "rad" }
direction = "decreasing"

[tissue.parameters]
parallel_stiffness = { value = 10.0, unit = "N/rad" }
series_stiffness = { value = 1e-9, unit = "N/rad" }
damping = { value = 1e-9, unit = "N·s/rad" }
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_scene(text, "liver.toml");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

const drivers::DeviceInfo scissors = drivers::open_device("sim:scissors")->info();

TEST(Scene, IsATissueOnAnAxisThatPushesBack) {
  const Scene scene = parse_scene(spring, "liver.toml");
  EXPECT_EQ(scene.name, "a spring");
  EXPECT_EQ(scene.toml, spring);
  const drivers::Surroundings around = surroundings_of(scene, scissors);
  ASSERT_TRUE(around.tissue[0]);
  EXPECT_FALSE(around.tissue[1]);
  EXPECT_NEAR(around.tissue[0](0.3, -0.1, 50e-6), 10.0 * 0.2, 1e-9) << "it opens blades that have closed";
  EXPECT_EQ(around.tissue[0](0.6, 0.0, 50e-6), 0.0);
}

TEST(Scene, MayBeALawThatActsOnSeveralAxesAtOnce) {
  const Scene scene = parse_scene(R"([tissue]
model = "blade"
[tissue.parameters]
edge_damping = { value = 0, unit = "N·s/m²" }
normal_damping = { value = 20000, unit = "N·s/m³" }
tangential_damping = { value = 4000, unit = "N·s/m³" }
[tissue.fidelity]
thresholds = false
)",
                                  "blade.toml");
  const drivers::Surroundings around = surroundings_of(scene, drivers::open_device("sim:pose6")->info());
  ASSERT_TRUE(around.tissue_of_axes);
  EXPECT_FALSE(around.tissue[0]);
  // The check value of the blade: T1 with its tip 12 mm under the surface.
  const drivers::Axes force =
      around.tissue_of_axes({0.0, 0.0, 0.1, 0.0, 0.0, 0.0}, {0.05, 0.02, 0.0, 0.0, 0.0, 0.0}, 50e-6);
  EXPECT_NEAR(force[0], -0.024, 1e-12);
  EXPECT_NEAR(force[4], 2.544e-3, 1e-12);
  EXPECT_THROW((void)surroundings_of(scene, scissors), std::invalid_argument);
}

TEST(Scene, OnThetaIsGivenByDefault) {
  EXPECT_EQ(default_scene().tissue.axis, "theta");
  EXPECT_TRUE(surroundings_of(default_scene(), scissors).tissue[0]);
}

TEST(Scene, IsRefusedWithFileAndLine) {
  EXPECT_THAT(refusal(replaced(spring, "damping", "dampening")),
              AllOf(HasSubstr("liver.toml:1"), HasSubstr("dampening")));
  EXPECT_THAT(refusal(replaced(spring, "\"N/rad\"", "\"N/m\"")),
              AllOf(HasSubstr("liver.toml:13:"), HasSubstr("N/m")));
  EXPECT_THAT(refusal(replaced(spring, "\"kelvin\"", "\"jelly\"")),
              AllOf(HasSubstr("liver.toml"), HasSubstr("jelly")));
  EXPECT_THAT(refusal(spring + "[weather]\n"), AllOf(HasSubstr("liver.toml:16:"), HasSubstr("'weather'")));
  EXPECT_THAT(refusal("name = \"nothing\"\n"), HasSubstr("[tissue]"));
  EXPECT_THAT(refusal("name = \n"), HasSubstr("liver.toml:1: not TOML"));
}

TEST(Scene, IsRefusedOnADeviceOfOtherUnits) {
  const Scene scene = parse_scene(replaced(spring, "\"theta\"", "\"x_s\""), "liver.toml");
  EXPECT_THROW((void)surroundings_of(scene, scissors), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

#include "scene/scene.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

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

/// Two springs in layers, the first of which gives way.
const std::string layers = R"([tissue]
model = "kelvin"
axis = "theta"
position_unit = "rad"
until = { value = 0.2, unit = "rad" }
[tissue.contact]
position = { value = 0.5, unit = "rad" }
direction = "decreasing"
[tissue.parameters]
parallel_stiffness = { value = 10.0, unit = "N/rad" }
series_stiffness = { value = 1e-9, unit = "N/rad" }
damping = { value = 1e-9, unit = "N·s/rad" }

[[layer]]
model = "kelvin"
from = { value = 0.1, unit = "rad" }
[layer.parameters]
parallel_stiffness = { value = 4.0, unit = "N/rad" }
series_stiffness = { value = 1e-9, unit = "N/rad" }
damping = { value = 1e-9, unit = "N·s/rad" }
)";

TEST(Scene, SumsItsLayersUntilOneIsCutThrough) {
  const Scene scene = parse_scene(layers, "layers.toml");
  ASSERT_EQ(scene.deeper.size(), 1U);
  EXPECT_EQ(scene.deeper[0].from, 0.1);
  EXPECT_EQ(scene.deeper[0].law.position_unit, "rad") << "as the first layer";
  const drivers::Surroundings around = surroundings_of(scene, scissors);
  const auto force_at = [&](double depth) { return around.tissue[0](0.5 - depth, -0.1, 50e-6); };
  EXPECT_NEAR(force_at(0.05), 10.0 * 0.05, 1e-9) << "the second has not been met";
  EXPECT_NEAR(force_at(0.15), 10.0 * 0.15 + 4.0 * 0.05, 1e-9);
  EXPECT_NEAR(force_at(0.25), 4.0 * 0.15, 1e-9) << "the first is cut through";
  EXPECT_NEAR(force_at(0.15), 4.0 * 0.05, 1e-9) << "and stays so on the way back";
  EXPECT_EQ(force_at(-0.01), 0.0);
  EXPECT_NEAR(force_at(0.05), 10.0 * 0.05, 1e-9) << "then the scissors meet fresh tissue";
}

const std::string everything = spring + R"([tool]
description = "scissors"
[device]
uri = "sim:scissors?noise=off"
[hand]
stiffness = { value = 0.4, unit = "N/mm" }
[trajectory]
kind = "strokes"
open = { value = 30, unit = "deg" }
)";

TEST(Scene, NamesDeviceHandAndTrajectory) {
  const Scene scene = parse_scene(everything, "liver.toml");
  EXPECT_EQ(scene.tool, "scissors");
  EXPECT_EQ(scene.device_uri, "sim:scissors?noise=off");
  EXPECT_DOUBLE_EQ(scene.hand.stiffness_n_per_m, 400.0);
  EXPECT_EQ(scene.hand.mass_kg, drivers::HandOptions{}.mass_kg);
  EXPECT_THAT(device_of(scene),
              HasSubstr("?noise=off&mass=0.15kg&damping=5Ns/m&grip=400N/m&open=30deg&close=0deg"));
  EXPECT_NO_THROW((void)drivers::open_device(device_of(scene)));
}

TEST(Scene, IsOfTheDeviceThatItsTissueFits) {
  EXPECT_EQ(device_of(default_scene()), "sim:scissors");
  EXPECT_EQ(device_of(read_scene(std::string(KERF_SOURCE_DIR) + "/examples/blade.scene.toml")), "sim:pose6");
  EXPECT_THROW((void)device_of(parse_scene(replaced(spring, "theta", "elbow"), "liver.toml")),
               std::invalid_argument);
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

struct Refused {
  std::string what;  ///< in the scene
  std::string by;
  std::string line;
  std::string words;
};

void expect_refusals(const std::string& scene, const std::vector<Refused>& all) {
  for (const Refused& one : all) {
    ASSERT_THAT(scene, HasSubstr(one.what));
    const std::string message = refusal(replaced(scene, one.what, one.by));
    EXPECT_THAT(message, AllOf(testing::StartsWith("liver.toml:" + one.line + ": "), HasSubstr(one.words)))
        << one.by;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(Scene, RefusesLayersByLine) {
  expect_refusals(
      layers,
      {{"value = 0.2", "value = 0", "5", "expected more than 0 rad"},
       {"until = { value = 0.2, unit = \"rad\" }", "until = 0.2", "5", "must be written"},
       {"value = 0.1", "value = -0.1", "16", "'from' is -0.1 rad, expected at least 0 rad"},
       {"from = { value = 0.1, unit = \"rad\" }", "", "14", "'from' is missing"},
       {"from =", "until = { value = 0.1, unit = \"rad\" }\nfrom =", "16", "expected more than 0.1 rad"},
       {"from =", "axis = \"theta\"\nfrom =", "16", "no 'axis' of its own"},
       {"from =", "force_unit = \"N·m\"\nfrom =", "19", "expected N·m/rad"},
       {"[[layer]]\nmodel = \"kelvin\"", "[[layer]]\nmodel = \"jelly\"", "15", "jelly"},
       {"[[layer]]", "[layer]", "14", "[[layer]]"},
       {"from =", "untill = 3\nfrom =", "16", "unknown key 'untill' in a law"},
       {"[[layer]]\nmodel = \"kelvin\"", "[[layer]]\nmodel = \"blade\"", "15", "a layer lies on one"}});
  EXPECT_THAT(refusal(layers.substr(0, layers.find("[[layer]]")) + R"([[layer]]
model = "fracture"
from = { value = 0.1, unit = "rad" }
[layer.parameters]
amplitude = { value = 0.0043, unit = "N" }
exponent = { value = 4, unit = "1" }
yield_energy = { value = 0.002, unit = "J" }
toughness = { value = 2000, unit = "J/m²" }
width = { value = 0.001, unit = "m" }
)"),
              AllOf(testing::StartsWith("liver.toml:14: "), HasSubstr("N over m, expected N over rad")));
}

TEST(Scene, RefusesDeviceHandAndTrajectoryByLine) {
  expect_refusals(
      everything,
      {{"[tool]", "[weather]", "16", "unknown key 'weather' in a scene; known are name, tissue, layer, tool"},
       {"description = \"scissors\"", "description = 3", "17", "must be a text"},
       {"description", "length", "17", "unknown key 'length'"},
       {"sim:scissors?noise=off", "falcon:0", "19", "expected a simulated device"},
       {"sim:scissors?noise=off", "sim:scissors?noise=loud", "19", "expected on or off"},
       {"sim:scissors?noise=off", "sim:pose6", "19", "no axis of sim:pose6"},
       {"axis = \"theta\"", "axis = \"tetha\"", "5", "the axes of sim:scissors are theta, x_s"},
       {"uri", "url", "19", "unknown key 'url'"},
       {"?noise=off", "?grip=3N/m", "20", "'grip' stands twice"},
       {"stiffness = { value = 0.4", "stiffness = { value = -1", "21",
        "expected a number from 0 to 5000 N/m"},
       {"N/mm", "kg", "21", "expected N/m"},
       {"stiffness = { value = 0.4", "grip = { value = 0.4", "21", "unknown key 'grip'"},
       {"\"strokes\"", "\"waves\"", "23", "expected \"strokes\", \"indent\" or \"keyframes\""},
       {"\"strokes\"", "\"indent\"", "23", "is for sim:pose6"},
       {"kind = \"strokes\"\n", "", "22", "'kind' is \"\""},
       {"value = 30, unit = \"deg\" }\n", "value = 90, unit = \"deg\" }\n", "24", "expected a number from"},
       {"open = { value = 30", "close = { value = 40", "24", "must be the smaller angle"},
       {"open", "opened", "24", "unknown key 'opened'"},
       {"kind = ", "variation = 0.5\nkind = ", "23", "'variation' is 0.5"},
       {"kind = ", "seconds = { value = 0, unit = \"s\" }\nkind = ", "23", "'seconds' is 0 s"}});
}

TEST(Scene, MayReachTheLimitsOfWhatItAsksFor) {
  const auto accepted = [](const std::string& line) {
    return device_of(parse_scene(everything + line, "liver.toml"));
  };
  EXPECT_THAT(accepted("variation = 0\n"), HasSubstr("variation=0"));
  EXPECT_THAT(accepted("stroke = { value = 100, unit = \"s\" }\n"), HasSubstr("stroke=100s"));
  EXPECT_THAT(accepted("stroke = { value = 50, unit = \"ms\" }\n"), HasSubstr("stroke=0.05s"));
}

const std::string pose = R"([tissue]
model = "kelvin"
axis = "z"
[tissue.parameters]
parallel_stiffness = { value = 10.0, unit = "N/m" }
series_stiffness = { value = 10.0, unit = "N/m" }
damping = { value = 10.0, unit = "N·s/m" }
[trajectory]
)";

TEST(Scene, IndentsOnceUnlessToldHowOften) {
  const std::string indentation = pose + R"(kind = "indent"
from = { value = 3, unit = "mm" }
to = { value = -12, unit = "mm" }
)";
  const auto indentations = [](const std::string& text) {
    const Scene scene = parse_scene(text, "liver.toml");
    const auto& keyframes = std::get<drivers::PosePath::Options>(scene.trajectory.script).keyframes;
    const auto is_deep = [](const drivers::PoseKeyframe& keyframe) { return keyframe.position[2] == -0.012; };
    return std::ranges::count_if(keyframes, is_deep) / 2;  // it comes, and stays
  };
  EXPECT_EQ(indentations(indentation), 1);
  EXPECT_EQ(indentations(indentation + "cycles = 3\n"), 3);
}

TEST(Scene, RefusesAnIndentationByLine) {
  expect_refusals(pose + R"(kind = "indent"
from = { value = 3, unit = "mm" }
to = { value = -12, unit = "mm" }
cycles = 2
)",
                  {{"from = { value = 3", "from = { value = 300", "10", "'from' is 0.3 m"},
                   {"to = { value = -12, unit = \"mm\" }\n", "", "8", "'to' is missing"},
                   {"cycles = 2", "cycles = 2.5", "12", "a whole number from 1 to 100"},
                   {"cycles = 2", "axis = \"w\"", "12", "the axes of sim:pose6 are x, y, z, rx, ry, rz"},
                   {"cycles = 2", "hold = { value = 2, unit = \"m\" }", "12", "expected s"}});
}

TEST(Scene, RefusesKeyframesByLine) {
  expect_refusals(
      pose + R"(kind = "keyframes"
repeat = true
[[trajectory.keyframe]]
at = { value = 0, unit = "s" }
position = { z = { value = 100, unit = "mm" } }
[[trajectory.keyframe]]
at = { value = 1, unit = "s" }
position = { rz = { value = 0, unit = "deg" } }
)",
      {{"value = 0, unit = \"s\"", "value = 0.5, unit = \"s\"", "12", "is at 0.5 s, expected 0 s"},
       {"value = 1,", "value = 0,", "15", "each must be later"},
       {"at = { value = 1, unit = \"s\" }", "", "14", "'at' is missing"},
       {"rz =", "q1 =", "16", "unknown axis 'q1'"},
       {"rz = { value = 0, unit = \"deg\" }", "rz = { value = 0, unit = \"mm\" }", "16", "expected rad"},
       {"rz = { value = 0", "rz = { value = 60", "10", "must be the pose of the first"},
       {"value = 100", "value = 300", "13", "'z' is 0.3 m"},
       {"repeat = true", "repeat = 1", "10", "must be true or false"},
       {"repeat = true", "open = 1", "10", "unknown key 'open'"}});
  EXPECT_THAT(refusal(pose + "kind = \"keyframes\"\n"),
              AllOf(testing::StartsWith("liver.toml:8: "), HasSubstr("[[trajectory.keyframe]]")));
}

TEST(Scene, IsRefusedOnADeviceOfOtherUnits) {
  const Scene scene = parse_scene(replaced(spring, "\"theta\"", "\"x_s\""), "liver.toml");
  EXPECT_THROW((void)surroundings_of(scene, scissors), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench

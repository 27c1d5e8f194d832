#include "session/device_check.h"

#include <atomic>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/whole_file.h"
#include "scene/motion.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

const std::string palpation = R"([tissue]
model = "kelvin"
axis = "z"
position_unit = "m"
contact = { position = { value = 0, unit = "m" }, direction = "decreasing" }
[tissue.parameters]
parallel_stiffness = { value = 5.0, unit = "N/m" }
series_stiffness = { value = 8.0, unit = "N/m" }
damping = { value = 1.6, unit = "N·s/m" }
[trajectory]
kind = "indent"
axis = "z"
from = { value = 5, unit = "mm" }
to = { value = -10, unit = "mm" }
)";

TEST(SamplesOnADevice, AreHeldAsDeepAsTheSceneOfTheMotionGoes) {
  const test::TemporaryFolder folder;
  write_whole_file(folder / "s.scene.toml", palpation);
  Protocol protocol;
  protocol.samples = {{.name = "wall",
                       .law = {.law = models::Law::make("kelvin", std::vector{2e4, 1e4, 100.0}),
                               .contact = {.position = -0.002, .direction = -1.0},
                               .axis = "z"}}};
  protocol.motion = MotionSource{.scene = folder / "s.scene.toml"};
  const std::atomic<bool> stop{false};
  EXPECT_THAT(check_samples(protocol, "sim:pose6?path=0s:0:0:50mm:0:0:0deg", stop),
              testing::ElementsAre(testing::HasSubstr("sample 'wall': pressed to 0.0008 m and held")));
}

}  // namespace
}  // namespace kerf::bench

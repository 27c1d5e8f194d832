#include <atomic>

#include <gtest/gtest.h>

#include "device_model/kept_models.h"
#include "laws/law_file.h"
#include "run/check.h"
#include "support/device_models.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

constexpr const char* spring = R"(model = "kelvin"
axis = "x"
position_unit = "m"
force_unit = "N"
[contact]
position = { value = 0, unit = "m" }
direction = "increasing"
[parameters]
parallel_stiffness = { value = 100, unit = "N/m" }
series_stiffness = { value = 50, unit = "N/m" }
damping = { value = 5, unit = "N·s/m" }
)";

nlohmann::ordered_json checked(const std::string& device_model, bool passivity_control) {
  const std::atomic<bool> go_on{false};
  RunOptions options;
  options.device_uri = "sim:axis?tells=off&sway=10mm";
  options.seconds = 0.2;
  options.virtual_time = true;
  options.law = parse_law_file(spring, "spring.law.toml");
  options.passivity_control = passivity_control;
  options.device_model = device_model;
  const RunResult result = run_on_device(options, go_on);
  return check_as_json(result, judge(result)).at("device_model");
}

TEST(CheckedModel, IsNamedByTheCheckWhoseControllerTookIt) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "x.device.toml").string();
  write_model_file(file, test::model_of("sim:axis?tells=off&sway=10mm"));
  const auto named = checked(file, true);
  EXPECT_EQ(named.at("file"), file);
  EXPECT_EQ(named.at("axes"), nlohmann::ordered_json({"x"}));
  EXPECT_TRUE(checked("", false).is_null()) << "nothing counts on it";
}

}  // namespace
}  // namespace kerf::bench

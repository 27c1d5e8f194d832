#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/measured_data.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

json recording_of(const json& study, const std::string& name) {
  for (const json& one : study.at("recordings"))
    if (one.at("name") == name) return one;
  return nullptr;
}

// What a person who looks at these recordings sees: blanks, the tool put down, a sensor at its end.
TEST(MeasuredDrawer, IsSeenAsItIs) {
  KERF_NEEDS_DATA("meniscus/8_blank_fast_1821.txt", "meniscus/14_quadriceps_tendon_fast_1853.txt");
  const test::TemporaryFolder folder;
  const fs::path drawer = folder / "drawer";
  fs::create_directory(drawer);
  for (const char* name : {"8_blank_fast_1821.txt", "14_quadriceps_tendon_fast_1853.txt"})
    fs::copy_file(test::measured_file(std::string("meniscus/") + name), drawer / name);
  const std::string study = (folder / "S").string();
  ASSERT_EQ(test::run_kerf({"study", "new", drawer.string(), "--map",
                            "time=5[ms],position=4[deg],force=2[gf]", "--laws", "kelvin", "-o", study})
                .exit_status,
            0);
  // What the blank meets differs from cycle to cycle by more than it is.
  std::string plan = test::read_text(folder / "S/study.toml");
  EXPECT_THAT(plan, HasSubstr("blank = \"leave\"\nwhy = \"8_blank_fast_1821.txt meets "));
  const test::Outcome run = test::run_kerf({"study", "run", study + "/study.toml"});
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const json found = json::parse(test::read_text(folder / "S/study.json"));
  EXPECT_TRUE(recording_of(found, "8_blank_fast_1821").at("blank").get<bool>());
  EXPECT_FALSE(recording_of(found, "8_blank_fast_1821").at("counts").get<bool>());
  EXPECT_THAT(run.output,
              HasSubstr("14_quadriceps_tendon_fast_1853: the sensor is clipped at 7.355 N in 99 rows."));
  EXPECT_THAT(run.output, HasSubstr("the tool was put down"));
  EXPECT_THAT(run.output, HasSubstr("2 of 2 recordings have a dead zone"));
  EXPECT_THAT(run.output, HasSubstr("quadriceps tendon, fast: no law serves in any of 1 recording"));
  // Taken off all the same, it says so, and the sensor is still clipped in 99 rows.
  const std::string leave = "blank = \"leave\"";
  plan.replace(plan.find(leave), leave.size(), "blank = \"subtract\"");
  test::write_text(folder / "S/study.toml", plan);
  const test::Outcome less = test::run_kerf({"study", "run", study + "/study.toml"});
  EXPECT_THAT(less.output,
              HasSubstr("8_blank_fast_1821 off 14_quadriceps_tendon_fast_1853 (0.185 of 0.926 N rms"));
  EXPECT_THAT(less.output, HasSubstr("is hardly known"));
  EXPECT_THAT(less.output, HasSubstr("the sensor is clipped at 7.355 N in 99 rows."));
  EXPECT_THAT(less.output, HasSubstr("cycle 11: the sensor is clipped in 4 rows"));
}

}  // namespace
}  // namespace kerf::bench

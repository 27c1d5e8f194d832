#include <cstdint>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"

// From a simulated device to a verdict, through the program as a user runs it.

namespace kerf {
namespace {

using nlohmann::json;
using test::run_kerf;

constexpr auto liver_law = R"(model = "kelvin"
axis = "theta"
position_unit = "rad"

[contact]
position = { value = 0.5, unit = "rad" }
direction = "decreasing"

[parameters]
parallel_stiffness = { value = 4.0, unit = "N/rad" }
series_stiffness = { value = 3.0, unit = "N/rad" }
damping = { value = 0.9, unit = "N·s/rad" }
)";

TEST(SimulatedCut, IsRecordedTheSameTwiceInVirtualTime) {
  const test::TemporaryFolder folder;
  std::string dumps[2];
  for (const int i : {0, 1}) {
    const auto file = (folder / (i == 0 ? "first.h5" : "second.h5")).string();
    const auto outcome =
        run_kerf({"record", "--device", "sim:scissors?seed=3", "--virtual", "--seconds", "4", "-o", file});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
    const auto valid = run_kerf({"validate", file, "--json"});
    EXPECT_EQ(valid.exit_status, 0) << valid.output;
    const json info = json::parse(run_kerf({"info", file, "--json"}).output);
    EXPECT_EQ(info.at("samples"), 4000);
    EXPECT_EQ(info.at("gaps"), 0);
    dumps[i] = info.at("channels").dump();
  }
  EXPECT_EQ(dumps[0], dumps[1]);
}

TEST(SimulatedCut, CheckAccountsForEveryTick) {
  const test::TemporaryFolder folder;
  const auto law = (folder / "liver.law.toml").string();
  test::write_text(law, liver_law);
  const auto outcome = run_kerf({"check", law, "--device", "sim:scissors", "--seconds", "10", "--json"});
  ASSERT_LE(outcome.exit_status, 1)
      << outcome.errors;  // a loaded machine may fail the verdict, not the accounts
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result.at("ticks"), 10000);
  EXPECT_EQ(result.at("period_s"), 1e-3);
  std::int64_t missed = 0;
  for (const auto& [stage, count] : result.at("missed_by").items()) missed += count.get<std::int64_t>();
  EXPECT_EQ(result.at("missed"), missed);
  double stages_us = 0.0;
  for (const auto* stage : {"read_us", "compute_us", "write_us", "record_us"}) {
    stages_us += result.at(stage).at("mean").get<double>();
  }
  EXPECT_NEAR(stages_us / result.at("cycle_us").at("mean").get<double>(), 1.0, 1e-3);
}

TEST(Demo, GoesOnFromALabsTextFile) {
  const test::TemporaryFolder folder;
  const std::string out = (folder / "demo").string();
  const auto outcome =
      run_kerf({"demo", "--text", KERF_SOURCE_DIR "/examples/data/punch.txt", "-o", out, "--seconds", "0.2"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, testing::HasSubstr("5. And now a text file, as a lab has it: "));
  EXPECT_THAT(outcome.output,
              testing::HasSubstr("force_measured: column 2 'force [gf]', in gf as the file says"));
  EXPECT_THAT(outcome.output, testing::HasSubstr("what is wrong with it: 1 lines are not data: 1802"));
  EXPECT_THAT(outcome.output, testing::HasSubstr("4666 samples in SI, 7 closings"));
  for (const char* file : {"report.html", "inspect.json", "punch.h5", "punch.html", "punch-inspect.json",
                           "punch-fits/fit.json", "punch-fits/kelvin.law.toml"})
    EXPECT_TRUE(std::filesystem::exists(folder / "demo" / file)) << file;
  for (const char* page : {"report.html", "punch.html"}) {
    const std::string html = test::read_text(folder / "demo" / page);
    EXPECT_THAT(html, testing::Not(testing::HasSubstr("of which recording"))) << page;
    EXPECT_THAT(html, testing::Not(testing::HasSubstr("writing")))
        << "the name that the folder had on the way";
  }
  EXPECT_THAT(test::read_text(folder / "demo" / "report.html"),
              testing::HasSubstr("From <code>choice/choose.json</code>"));
}

}  // namespace
}  // namespace kerf

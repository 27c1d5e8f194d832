#include "support/program.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "support/recordings.h"

namespace kerf::bench {
namespace {

using test::read_text;
using test::run_kerf;
using test::TemporaryFolder;
using test::write_text;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

constexpr auto scene = R"(name = "between the blades"
[tissue]
model = "kelvin"
axis = "theta"
position_unit = "rad"
force_unit = "N"
[tissue.contact]
position = { value = 30, unit = "deg" }
direction = "decreasing"
[tissue.parameters]
parallel_stiffness = { value = 5.0, unit = "N/rad" }
series_stiffness = { value = 8.0, unit = "N/rad" }
damping = { value = 1.6, unit = "N·s/rad" }
)";

TEST(ChartProgram, WritesPictureTableJsonAndPageOfAScene) {
  const TemporaryFolder folder;
  write_text(folder / "a.scene.toml", scene);
  const std::string out = (folder / "chart").string();
  const auto outcome = run_kerf({"chart", "--scene", (folder / "a.scene.toml").string(), "--laws",
                                 "exponential", "--no-cold", "--json", "-o", out});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["source"], "between the blades");
  EXPECT_GT(json["points"].size(), 10U);
  EXPECT_FALSE(json["front"].empty());
  EXPECT_THAT(read_text(folder / "chart/chart.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(read_text(folder / "chart/chart.csv"), HasSubstr("kelvin,\"semi-implicit\""));
  EXPECT_THAT(read_text(folder / "chart/chart.html"), HasSubstr("between the blades"));
  EXPECT_EQ(nlohmann::json::parse(read_text(folder / "chart/chart.json")), json);
  const auto again = run_kerf({"chart", "--scene", (folder / "a.scene.toml").string(), "-o", out});
  EXPECT_EQ(again.exit_status, 2);
  EXPECT_THAT(again.errors, HasSubstr("--force"));
}

TEST(ChartProgram, ChartsARecording) {
  const TemporaryFolder folder;
  const std::string cut = (folder / "cut.h5").string();
  ASSERT_EQ(run_kerf({"record", "--device", "sim:scissors", "--seconds", "4", "--rate", "200", "--virtual",
                      "-o", cut})
                .exit_status,
            0);
  const auto outcome = run_kerf({"chart", cut, "--laws", "kelvin,exponential", "--no-folds", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_NEAR(json["rate_hz"].get<double>(), 1000.0, 1e-6) << "of the loop, not of the recording";
  for (const auto& point : json["points"]) EXPECT_GT(point["error_jnd"].get<double>(), 0.0);
}

TEST(ChartProgram, SaysTheUnitOfATorqueEverywhere) {
  const TemporaryFolder folder;
  schema::Recording recording = test::punch({.seconds = 3.0});
  recording.axes = {{.name = "grip", .position_unit = "rad", .force_unit = "N·m"}};
  for (double& torque : recording.force_measured) torque *= 0.08;
  schema::write_recording(folder / "g.h5", recording);
  const auto outcome = run_kerf({"chart", (folder / "g.h5").string(), "--laws", "kelvin", "--no-folds",
                                 "--no-cold", "-o", (folder / "c").string()});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, ContainsRegex("JND [0-9.e-]+ N·m\n.*error N·m"));
  const auto json = nlohmann::json::parse(read_text(folder / "c/chart.json"));
  EXPECT_EQ(json["compared_in"], "N·m");
  EXPECT_EQ(json["force_unit"], "N·m");
  EXPECT_GT(json["jnd_n"].get<double>(), 0.0);
  EXPECT_THAT(read_text(folder / "c/chart.csv"), HasSubstr(",force_unit\n"));
  EXPECT_THAT(read_text(folder / "c/chart.csv"), HasSubstr(",N·m\n"));
  EXPECT_THAT(read_text(folder / "c/chart.svg"), HasSubstr("root mean square [N·m]"));
  const std::string page = read_text(folder / "c/chart.html");
  for (const auto* part : {"worst [N·m]", "error [N·m]", " N·m.</p>"}) EXPECT_THAT(page, HasSubstr(part));
  EXPECT_THAT(page, Not(HasSubstr("[N]")));
}

TEST(ChartProgram, TakesAContactInPlaceOfTheRecordings) {
  const TemporaryFolder folder;
  schema::write_recording(folder / "p.h5", test::punch({.seconds = 3.0}));
  const auto chart = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"chart", (folder / "p.h5").string(), "--laws", "kelvin", "--no-folds",
                               "--no-cold", "--json", "-o", (folder / "c").string(), "--force"});
    const auto outcome = run_kerf(more);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  };
  const double there = chart({})["points"][0]["error_n"].get<double>();
  const auto moved = chart({"--contact", "0.002"});
  EXPECT_EQ(moved["contact"]["position"], 0.002);
  EXPECT_GT(moved["points"][0]["error_n"].get<double>(), 2.0 * there) << "the tissue begins at 0";
  const std::string law = read_text(folder / "c" / moved["points"][0]["law_file"].get<std::string>());
  EXPECT_THAT(law, HasSubstr("0.002"));
}

TEST(ChartProgram, RefusesBadInputInOneLine) {
  const TemporaryFolder folder;
  write_text(folder / "a.scene.toml", scene);
  const std::string file = (folder / "a.scene.toml").string();
  const std::vector<std::vector<std::string>> wrong{
      {"chart"},
      {"chart", "x.h5", "--scene", file},
      {"chart", "--scene", file, "--laws", "magic"},
      {"chart", "--scene", file, "--rate", "5"},
      {"chart", "--scene", file, "--axis", "theta"},
      {"chart", "--scene", file, "--contact", "0.1"},
  };
  for (const auto& arguments : wrong) {
    const auto outcome = run_kerf(arguments);
    EXPECT_EQ(outcome.exit_status, 2) << outcome.errors;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  }
}

}  // namespace
}  // namespace kerf::bench

#include "support/program.h"

#include <array>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/models/law.h>
#include <kerf/schema/recording.h>

#include "known_cuts.h"
#include "known_laws.h"
#include "support/measured_data.h"

namespace kerf {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;

class ProgramChoose : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  std::string write(const schema::Recording& recording) {
    schema::write_recording(path("cut.h5"), recording);
    return path("cut.h5");
  }
  void expect_refusal(std::vector<std::string> arguments, int status, const std::string& says) {
    arguments.insert(arguments.begin(), "choose");
    const Outcome outcome = run_kerf(std::move(arguments));
    EXPECT_EQ(outcome.exit_status, status) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr(says));
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(ProgramChoose, WritesTheLawItsTablesAndAPage) {
  const std::string cut = write(test::cut_of(test::known_kelvin()));
  const Outcome outcome =
      run_kerf({"choose", cut, "-o", path("choice"), "--most-segments", "2", "--no-loop", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result.at("choice").at("law"), "kelvin");
  EXPECT_EQ(result.at("axis"), "theta");
  EXPECT_TRUE(result.at("device").is_null());
  EXPECT_EQ(json::parse(test::read_text(path("choice") + "/choose.json")), result);
  EXPECT_THAT(test::read_text(path("choice") + "/choose.csv"), HasSubstr("maxwell-2,maxwell,5,"));
  EXPECT_THAT(test::read_text(path("choice") + "/choose.html"),
              AllOf(HasSubstr("<svg"), HasSubstr("Which effects matter"), HasSubstr("kelvin")));
  EXPECT_THAT(test::read_text(path("choice") + "/kelvin.law.toml"), HasSubstr("sha256 = '"));
  expect_refusal({cut, "-o", path("choice"), "--no-loop"}, 2, "--force");
  ASSERT_EQ(run_kerf({"report", cut, path("choice"), "-o", path("page.html")}).exit_status, 0);
  EXPECT_THAT(test::read_text(path("page.html")),
              AllOf(HasSubstr("<p class=\"answer\"><strong>It serves: kelvin.</strong>"),
                    HasSubstr("Error on held-out data against the number of parameters"),
                    HasSubstr("Holds</strong>: choice: kelvin serves.")));
}

TEST_F(ProgramChoose, RunsTheLawInClosedLoop) {
  const std::string cut = write(test::cut_of(test::known_kelvin()));
  const Outcome outcome = run_kerf({"choose", cut, "--most-segments", "1", "--seconds", "0.3", "--json"});
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result.at("choice").at("law"), "kelvin");
  EXPECT_EQ(result.at("device"), "sim:scissors");
  // A machine that is late leaves the choice in doubt.
  EXPECT_EQ(outcome.exit_status, result.at("choice").at("serves").get<bool>() ? 0 : 1);
  for (const json& one : result.at("candidates")) {
    if (one.at("law") != "kelvin") continue;
    EXPECT_TRUE(one.at("stable").get<bool>());
    EXPECT_EQ(one.at("deadline").at("ticks"), 300);
  }
}

TEST_F(ProgramChoose, ExitsWithOneWhereNoneIsWithinTheJnd) {
  const std::string cut = write(test::cut_of(test::known_kelvin()));
  const Outcome outcome =
      run_kerf({"choose", cut, "--no-loop", "--most-segments", "1", "--weber", "0", "--threshold", "0.01"});
  EXPECT_EQ(outcome.exit_status, 1) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("None is within the JND of 0.01 N"));
}

TEST_F(ProgramChoose, MakesARecordingOfAScene) {
  test::write_text(path("a.scene.toml"), R"(name = "rubber"
[tissue]
model = "hunt_crossley"
axis = "theta"
position_unit = "rad"
force_unit = "N"
[tissue.contact]
position = { value = 30, unit = "deg" }
direction = "decreasing"
[tissue.fidelity]
reference_depth = 0.4
[tissue.parameters]
reference_force = { value = 4.0, unit = "N" }
reference_damping = { value = 0.5, unit = "N·s/rad" }
exponent = { value = 1.8, unit = "1" }
)");
  const Outcome outcome = run_kerf({"choose", "--scene", path("a.scene.toml"), "-o", path("choice"),
                                    "--most-segments", "1", "--no-loop", "--record-seconds", "10", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  EXPECT_LE(result.at("choice").at("parameters").size(), 3U);
  EXPECT_TRUE(std::filesystem::exists(path("choice") + "/cut.h5"));
}

TEST_F(ProgramChoose, NamesTheFidelityThatABladeNeeds) {
  const std::string scene = std::string(KERF_SOURCE_DIR) + "/examples/scenes/scalpel-t1.scene.toml";
  const Outcome outcome = run_kerf({"choose", "--scene", scene, "-o", path("choice"), "--no-loop", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  // All are within the JND there; which of them is the cheapest, the machine says.
  const std::string law = result.at("choice").at("law").get<std::string>();
  EXPECT_THAT(law, testing::StartsWith("blade-"));
  EXPECT_EQ(result.at("effects").at(0).at("effect"), "rotation");
  EXPECT_EQ(result.at("effects").at(0).at("verdict"), "does not matter");
  EXPECT_THAT(test::read_text(path("choice") + "/choose.html"), HasSubstr("cost of a tick"));
  EXPECT_THAT(test::read_text(path("choice") + "/" + law + ".law.toml"), HasSubstr("fidelity = "));
}

TEST_F(ProgramChoose, RefusesWithOneLine) {
  schema::Recording recording = test::cut_of(test::known_kelvin());
  const std::string cut = write(recording);
  expect_refusal({}, 2, "name a recording, or a scene");
  expect_refusal({"missing.h5"}, 2, "missing.h5");
  expect_refusal({cut, "--device", "sim:spoon"}, 3, "sim:spoon");
  expect_refusal({cut, "--device", "sim:premium"}, 2, "no axis of sim:premium");
  expect_refusal({cut, "--axis", "phi"}, 2, "theta");
  const std::string scenes = std::string(KERF_SOURCE_DIR) + "/examples/scenes/";
  expect_refusal({"--scene", scenes + "palpation.scene.toml"}, 2, "-o");
  for (const auto& [option, value] :
       {std::pair{"--device-model", "none.device.toml"}, std::pair{"--grip", "firm"},
        std::pair{"--margin", "0.2"}, std::pair{"--seconds", "2"}, std::pair{"--device", "sim:axis"}}) {
    expect_refusal({cut, "--no-loop", option, value}, 2, std::string(option) + " says nothing to --no-loop");
  }
  expect_refusal({cut, "--record-seconds", "2"}, 2, "it is for --scene");
  recording.force_measured.clear();
  expect_refusal({write(recording), "--no-loop"}, 2, "holds no force");
}

TEST_F(ProgramChoose, SaysThatARecordingIsNotSegmented) {
  const std::string cut = write(test::cut_of(test::known_line(), {.with_cycles = false}));
  const Outcome outcome = run_kerf({"choose", cut, "--no-loop", "--most-segments", "1"});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, HasSubstr("'kerf segment' finds cycles"));
}

TEST_F(ProgramChoose, OfAMeniscusTakesFewSegmentsOrSaysWhyNot) {
  const std::string name = "meniscus/9_meniscus_slow_1824.txt";
  KERF_NEEDS_DATA(name);
  const std::string data = test::measured_file(name).string();
  ASSERT_EQ(run_kerf({"import", data, "--map", "time=5[ms],position=4[deg],force=2[gf]", "-o", path("m.h5")})
                .exit_status,
            0);
  ASSERT_EQ(run_kerf({"segment", path("m.h5")}).exit_status, 0);
  const Outcome outcome = run_kerf({"choose", path("m.h5"), "--no-loop", "--most-segments", "7", "--json"});
  EXPECT_EQ(outcome.exit_status, 1);
  const json choice = json::parse(outcome.output).at("choice");
  // No law is within the JND: the cycles differ by more. A branch for each direction fits them best, and is
  // worse than one for both where a loop's velocity, which lags, switches it.
  EXPECT_FALSE(choice.at("serves").get<bool>());
  EXPECT_THAT(choice.at("why").get<std::string>(), HasSubstr("None is within the JND of 0.269 N"));
  EXPECT_EQ(choice.at("as_good"), "hunt_crossley");
  EXPECT_THAT(choice.at("blame").get<std::string>(),
              HasSubstr("the spread from cycle to cycle is most to blame"));
}

}  // namespace
}  // namespace kerf

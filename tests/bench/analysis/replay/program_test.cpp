#include "support/program.h"

#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "motion.h"

namespace kerf {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;

const std::string examples = std::string(KERF_SOURCE_DIR) + "/examples/";

class ProgramReplay : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return (folder_ / name).string(); }
  static Outcome replay(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "replay");
    return run_kerf(std::move(arguments));
  }
  static void expect_refusal(std::vector<std::string> arguments, int status, const std::string& says) {
    const Outcome outcome = replay(std::move(arguments));
    EXPECT_EQ(outcome.exit_status, status) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr(says));
  }
  std::string sine() {
    schema::write_recording(path("sine.h5"), test::sine_of_scissors());
    return path("sine.h5");
  }
  std::string cut() {
    EXPECT_EQ(run_kerf({"record", "--virtual", "--seconds", "8", "-o", path("cut.h5")}).exit_status, 0);
    EXPECT_EQ(run_kerf({"segment", path("cut.h5")}).exit_status, 0);
    return path("cut.h5");
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(ProgramReplay, GivesTheForcesOfACheckAgainBitForBit) {
  const std::string law = examples + "kelvin.law.toml";
  ASSERT_EQ(
      run_kerf({"check", law, "--virtual", "--seconds", "3", "--floor", "0", "--record", path("loop.h5")})
          .exit_status,
      0);
  const Outcome outcome = replay({path("loop.h5"), "--through", law, "--through",
                                  examples + "exponential.law.toml", "-o", path("out"), "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  const json& own = result.at("laws").at(0).at("axes").at(0);
  EXPECT_EQ(own.at("identical_rows"), own.at("untouched_rows"));
  EXPECT_EQ(own.at("untouched_rows"), 2750);
  EXPECT_GT(result.at("laws").at(1).at("axes").at(0).at("rms_jnd"), 1.0);
  EXPECT_EQ(json::parse(test::read_text(path("out") + "/replay.json")), result);
  EXPECT_THAT(test::read_text(path("out") + "/replay.html"),
              AllOf(HasSubstr("<svg"), HasSubstr("2750 of 2750")));
  EXPECT_EQ(schema::read_recording(path("out") + "/exponential.h5").rows(), 3000U);
  EXPECT_EQ(run_kerf({"validate", path("out") + "/kelvin.h5"}).exit_status, 0);
  expect_refusal({path("loop.h5"), "--through", law, "-o", path("out")}, 2, "--force");
}

TEST_F(ProgramReplay, RendersATableTheSameTwice) {
  const std::string file = cut();
  for (const char* name : {"one.h5", "two.h5"}) {
    const Outcome outcome = replay({file, "--as", "table", "--cycles", "2-4", "--virtual", "--seconds", "3",
                                    "--record", path(name), "--json"});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
    const json result = json::parse(outcome.output);
    EXPECT_EQ(result.at("law_options").at("loop"), true);
    EXPECT_EQ(result.at("law_options").at("velocity_corner"), 10.0);
    EXPECT_GT(result.at("law_options").at("ramp_band"), 0.0);
    EXPECT_GT(result.at("law_options").at("reversal_scale"), 0.0);
  }
  const schema::Recording one = schema::read_recording(path("one.h5"));
  const schema::Recording two = schema::read_recording(path("two.h5"));
  EXPECT_EQ(one.force_commanded, two.force_commanded);
  EXPECT_GT(*std::max_element(one.force_commanded.begin(), one.force_commanded.end()), 0.5);
}

TEST_F(ProgramReplay, HoldsADeviceToAPathFromWhereverItIs) {
  const std::vector<std::string> command{sine(),      "--as",     "path", "--device", "sim:scissors?hand=off",
                                         "--virtual", "--record", "REC",  "--json",   "--speed",
                                         "0.5"};
  std::vector<std::vector<double>> forces;
  for (const char* name : {"one.h5", "two.h5"}) {
    std::vector<std::string> arguments = command;
    arguments[7] = path(name);
    const Outcome outcome = replay(arguments);
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
    const json result = json::parse(outcome.output);
    EXPECT_TRUE(result.at("played_to_its_end"));
    EXPECT_LT(result.at("axes").at(0).at("error_rms"), 0.01);
    EXPECT_LT(result.at("axes").at(0).at("largest_reference_speed"), 0.5 * 0.63);
    const schema::Recording recording = schema::read_recording(path(name));
    forces.push_back(recording.force_commanded);
    EXPECT_LT(std::abs(recording.force_commanded[0]), 0.05);
    EXPECT_LT(std::abs(recording.force_commanded.end()[-2]), 0.05);
    EXPECT_NEAR(recording.position.end()[-2], 0.4, 0.02);
  }
  EXPECT_EQ(forces[0], forces[1]);
}

TEST_F(ProgramReplay, GoesOnInALoopForAsLongAsItIsTold) {
  const Outcome outcome = replay({sine(), "--as", "path", "--device", "sim:scissors?hand=off", "--virtual",
                                  "--loop", "--to", "0.4", "--seconds", "6", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result.at("check").at("ticks"), 6000);
  EXPECT_FALSE(result.at("played_to_its_end"));
  EXPECT_GT(result.at("playing_ticks"), 800);
}

TEST_F(ProgramReplay, OfAPathThatWasNotReachedIsNoPass) {
  const Outcome outcome = replay({sine(), "--as", "path", "--device", "sim:scissors?hand=off", "--virtual",
                                  "--seconds", "0.05", "--json"});
  EXPECT_EQ(outcome.exit_status, 1) << outcome.errors;
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result.at("playing_ticks"), 0);
  EXPECT_NE(result.at("check").at("verdict"), "pass");
  EXPECT_THAT(result.at("check").at("reasons").dump(), HasSubstr("no tick of it was played"));
}

TEST_F(ProgramReplay, TellsOfGaps) {
  schema::write_recording(path("gap.h5"), test::without_rows(test::sine_of_scissors(), 100, 200));
  const std::string law = examples + "kelvin.law.toml";
  EXPECT_THAT(replay({path("gap.h5"), "--through", law}).errors, HasSubstr("kept as they are"));
  const Outcome outcome = replay({path("gap.h5"), "--through", law, "--bridge", "--json"});
  EXPECT_THAT(outcome.errors, HasSubstr("bridged by straight lines"));
  EXPECT_EQ(json::parse(outcome.output).at("rows"), 2001);
}

TEST_F(ProgramReplay, RefusesOptionsOfOtherModes) {
  const std::string file = sine();
  const std::string law = examples + "kelvin.law.toml";
  using Words = std::vector<std::string>;
  const auto refused = [&](const Words& mode, const std::vector<Words>& options, const std::string& says) {
    for (const Words& option : options) {
      Words words{file};
      words.insert(words.end(), mode.begin(), mode.end());
      words.insert(words.end(), option.begin(), option.end());
      expect_refusal(words, 2, option.front() + " says nothing to " + says);
    }
  };
  const std::vector<Words> of_path{
      {"--stiffness", "3"}, {"--damping", "1"}, {"--limit", "1"}, {"--approach", "0.2"}, {"--loop"}};
  const std::vector<Words> of_device{{"--rate", "500"},       {"--ramp", "1"},
                                     {"--passivity-control"}, {"--virtual"},
                                     {"--sensor", "u6:0"},    {"--device-model", "x.device.toml"},
                                     {"--seconds", "3"},      {"--device", "sim:scissors"},
                                     {"--record", "x.h5"}};
  const std::vector<Words> of_through{
      {"--match", "3"}, {"--contact-force", "1"}, {"--drop-window", "9"}, {"--realtime"}};
  refused({"--through", law}, of_path, "--through; it is for --as path");
  refused({"--through", law}, of_device, "--through; ");
  refused({"--as", "table"}, of_path, "--as table; it is for --as path");
  refused({"--as", "table"}, of_through, "--as table; it is for --through");
  refused({"--as", "path"}, of_through, "--as path; it is for --through");
}

// Every second row is half way between two of the recording, where its noise averages out.
TEST_F(ProgramReplay, FindsNoDropsInNoiseAtHalfTheSpeed) {
  schema::Recording noisy = test::sine_of_scissors(6001);
  std::mt19937_64 random(3);
  std::normal_distribution<double> rough(0.0, 0.02);
  for (double& force : noisy.force_measured) force += rough(random);
  schema::write_recording(path("noisy.h5"), noisy);
  for (const char* speed : {"1", "0.5", "0.7"}) {
    const Outcome outcome =
        replay({path("noisy.h5"), "--through", examples + "kelvin.law.toml", "--speed", speed, "--json"});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
    EXPECT_EQ(
        json::parse(outcome.output).at("laws").at(0).at("axes").at(0).at("events").at("drop").at("recorded"),
        0)
        << speed;
  }
}

TEST_F(ProgramReplay, RefusesBadInputInOneLine) {
  const std::string file = sine();
  const std::string law = examples + "kelvin.law.toml";
  expect_refusal({path("none.h5"), "--as", "path"}, 2, "none.h5");
  expect_refusal({file}, 2, "give one of --as table, --as path and --through LAW");
  expect_refusal({file, "--as", "path", "--through", law}, 2, "give one of");
  expect_refusal({file, "--through", law, "--loop"}, 2, "--loop says nothing to --through");
  expect_refusal({file, "--through", law, "--cycles", "2"}, 2, "kerf segment");
  expect_refusal({file, "--through", law, "--from", "9"}, 2, "from 0 to 2 s");
  expect_refusal({file, "--through", path("no.law.toml")}, 2, "no.law.toml");
  expect_refusal({file, "--as", "path", "--virtual", "--loop"}, 2, "give --seconds");
  expect_refusal({file, "--as", "path", "--speed", "11"}, 2, "--speed");
  expect_refusal({file, "--as", "path", "--limit", "theta=8"}, 2, "may exert, 7.58");
  expect_refusal({file, "--as", "path", "--device", "sim:pose6", "--axis", "x"}, 2, "theta");
  expect_refusal({file, "--as", "path", "--device", "sim:none"}, 3, "sim:none");
}

}  // namespace
}  // namespace kerf

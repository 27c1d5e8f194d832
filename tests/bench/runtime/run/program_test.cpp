#include "support/program.h"

#include <csignal>
#include <cstring>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "support/kelvin_law.h"

// devices, record and check as a user runs them.

namespace kerf {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;

constexpr auto kelvin = test::kelvin_law;

class LoopProgram : public testing::Test {
 protected:
  LoopProgram() { test::write_text(folder_ / "k.law.toml", kelvin); }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Outcome record(std::vector<std::string> more) const {
    more.insert(more.begin(), {"record", "--virtual", "--seconds", "2", "-o", at("r.h5")});
    return run_kerf(more);
  }
  [[nodiscard]] Outcome check(std::vector<std::string> more) const {
    more.insert(more.begin(), {"check", at("k.law.toml")});
    return run_kerf(more);
  }
  void expect_refusal(const Outcome& outcome, int exit_status, const std::string& words) const {
    EXPECT_EQ(outcome.exit_status, exit_status) << outcome.errors;
    EXPECT_THAT(outcome.errors, AllOf(testing::StartsWith("kerf: "), HasSubstr(words)));
    EXPECT_EQ(outcome.output, "");
    EXPECT_FALSE(std::filesystem::exists(at("r.h5")));
    EXPECT_FALSE(std::filesystem::exists(at("r.h5.partial")));
  }

  test::TemporaryFolder folder_;
};

TEST_F(LoopProgram, ListsDevicesWithTheirAxes) {
  const json devices = json::parse(run_kerf({"devices", "--json"}).output).at("devices");
  EXPECT_EQ(devices.at(0).at("uri"), "sim:scissors");
  EXPECT_EQ(devices.at(0).at("degrees_of_freedom"), 2);
  EXPECT_EQ(devices.at(0).at("axes").at(0).at("force_limit"), 7.58);
  EXPECT_THAT(run_kerf({"devices"}).output, HasSubstr("x_s"));
}

TEST_F(LoopProgram, RecordsByTheWallClock) {
  const Outcome outcome = run_kerf({"record", "--seconds", "0.3", "-o", at("r.h5"), "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json info = json::parse(outcome.output);
  const schema::Recording recording = schema::read_recording(at("r.h5"));
  EXPECT_EQ(recording.header.status, "complete");
  EXPECT_EQ(recording.rows() + info.at("missed").get<std::size_t>(), 300U);
  EXPECT_EQ(info.at("samples"), recording.rows());
}

TEST_F(LoopProgram, RecordsTheSeedAndAnotherCutForAnother) {
  ASSERT_EQ(record({"--seed", "7"}).exit_status, 0);
  const schema::Recording seven = schema::read_recording(at("r.h5"));
  EXPECT_EQ(seven.header.device_uri, "sim:scissors?seed=7");
  ASSERT_EQ(record({"--seed", "8", "--force"}).exit_status, 0);
  EXPECT_NE(schema::read_recording(at("r.h5")).force_measured, seven.force_measured);
}

TEST_F(LoopProgram, RendersALawWhileItRecords) {
  ASSERT_EQ(record({"--law", at("k.law.toml")}).exit_status, 0);
  EXPECT_THAT(schema::read_recording(at("r.h5")).force_commanded, testing::Contains(testing::Gt(0.1)));
}

TEST_F(LoopProgram, KeepsAnExistingRecordingUnlessForced) {
  test::write_text(at("r.h5"), "precious");
  const Outcome outcome = record({});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("r.h5"), HasSubstr("--force")));
  EXPECT_EQ(test::read_text(at("r.h5")), "precious");
  EXPECT_EQ(record({"--force"}).exit_status, 0);
}

TEST_F(LoopProgram, RefusesWhatItCannotRun) {
  expect_refusal(record({"--device", "sim:saw"}), 3, "no device 'sim:saw'");
  expect_refusal(record({"--device", "sim:scissors?sed=3"}), 3, "no option 'sed'");
  expect_refusal(record({"--rate", "20"}), 2, "between 100 and 10000 Hz");
  expect_refusal(record({"--scene", at("none.toml")}), 2, "none.toml");
  test::write_text(at("bad.toml"), "name = 3\n");
  expect_refusal(record({"--scene", at("bad.toml")}), 2, "bad.toml:1: 'name' must be a text");
  expect_refusal(check({"--device", "toaster:0"}), 3, "no device 'toaster:0'");
  expect_refusal(run_kerf({"check", at("none.law.toml")}), 2, "none.law.toml");
  expect_refusal(run_kerf({"record", "--virtual", "-o", at("no/folder/r.h5")}), 4, "no/folder");
}

TEST_F(LoopProgram, RefusesARecordingThatNoDiskHoldsBeforeItBegins) {
  const auto outcome = run_kerf({"record", "--device", "sim:pose6?truth=on", "--seconds", "1e6", "--rate",
                                 "10000", "--virtual", "-o", at("r.h5")});
  expect_refusal(outcome, 4, "GiB of the disk for 10000000000 rows");
}

TEST_F(LoopProgram, RefusesALawOfOtherUnitsThanTheAxis) {
  test::write_text(at("k.law.toml"), R"(model = "exponential"
axis = "theta"
[parameters]
amplitude = { value = 4.3e-7, unit = "N" }
exponent = { value = 13, unit = "1" }
viscosity = { value = 20, unit = "N·s/m" }
)");
  expect_refusal(check({"--virtual"}), 2, "N over m, but axis 'theta' of sim:scissors has N over rad");
}

TEST_F(LoopProgram, ChecksALawAndAddsUp) {
  const Outcome outcome = check({"--seconds", "0.5", "--json", "-o", at("c.json"), "--record", at("r.h5")});
  ASSERT_LE(outcome.exit_status, 1) << outcome.errors;  // a loaded machine may fail the verdict
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result, json::parse(test::read_text(at("c.json"))));
  EXPECT_NE(result.at("verdict"), "pass") << "in half a second nothing is felt of it";
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_EQ(result.at("ticks"), 500);
  EXPECT_EQ(result.at("executed").get<int>() + result.at("missed").get<int>(), 500);
  int missed = 0;
  for (const auto& [stage, count] : result.at("missed_by").items()) missed += count.get<int>();
  EXPECT_EQ(result.at("missed"), missed);
  double stages_us = 0.0;
  for (const auto* stage : {"read_us", "compute_us", "write_us", "record_us"}) {
    stages_us += result.at(stage).at("mean").get<double>();
  }
  EXPECT_NEAR(stages_us / result.at("cycle_us").at("mean").get<double>(), 1.0, 1e-9);
  EXPECT_EQ(schema::read_recording(at("r.h5")).rows() + result.at("rows_lost").get<std::size_t>(),
            result.at("executed").get<std::size_t>());
  EXPECT_EQ(result.at("realtime").size(), 6U) << "of the loop five, and the watchdog";
  for (const auto& measure : result.at("realtime")) EXPECT_NE(measure.at("detail"), "");
}

TEST_F(LoopProgram, PassesInVirtualTimeWithEveryDurationZero) {
  const Outcome outcome = check({"--virtual", "--seconds", "10", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  EXPECT_EQ(result.at("ticks"), 10000);
  EXPECT_EQ(result.at("missed"), 0);
  EXPECT_EQ(result.at("cycle_us").at("max"), 0.0);
  EXPECT_EQ(result.at("verdict"), "pass");
}

class Interrupted : public LoopProgram, public testing::WithParamInterface<int> {};

TEST_P(Interrupted, EndsARecordingCleanly) {
  const std::string program = KERF_PROGRAM;
  // The shell sends the signal once the recording has begun, and answers with the program's own status.
  const Outcome outcome = test::run({"sh", "-c",
                                     R"("$1" record --seconds 60 -o "$2" & child=$!
          while ! [ -e "$2.partial" ]; do sleep 0.05; done; sleep 0.5
          kill -"$3" $child; wait $child)",
                                     "sh", program, at("r.h5"), std::to_string(GetParam())});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const schema::Recording recording = schema::read_recording(at("r.h5"));
  EXPECT_EQ(recording.header.status, "complete");
  EXPECT_GT(recording.rows(), 0U);
  EXPECT_LT(recording.rows(), 60'000U);
  ASSERT_FALSE(recording.events.empty());
  EXPECT_EQ(recording.events.back().kind, "stop");
  EXPECT_FALSE(std::filesystem::exists(at("r.h5.partial")));
}
INSTANTIATE_TEST_SUITE_P(By, Interrupted, testing::Values(SIGTERM, SIGINT, SIGQUIT, SIGHUP),
                         [](const auto& tested) { return std::string("SIG") + sigabbrev_np(tested.param); });

const std::string examples = std::string(KERF_SOURCE_DIR) + "/examples/";

TEST(KerfCheck, RendersLawsThatActOnSeveralAxes) {
  for (const auto& [law, device] :
       {std::pair{"blade", "sim:pose6"}, std::pair{"fuzzy_kelvin_3d", "sim:pose6"},
        std::pair{"scissors", "sim:scissors"}, std::pair{"scissors_mesh", "sim:scissors"},
        std::pair{"orthogonal", "sim:premium"}}) {
    const Outcome outcome =
        run_kerf({"check", examples + law + ".law.toml", "--device", device, "--virtual", "--seconds", "2"});
    EXPECT_EQ(outcome.exit_status, 0) << law << ": " << outcome.errors;
  }
}

TEST(KerfCheck, DoesNotPassALawThatIsNeverFelt) {
  const Outcome far =
      run_kerf({"check", examples + "kelvin.law.toml", "--contact=-1000", "--virtual", "--seconds", "1"});
  EXPECT_EQ(far.exit_status, 1);
  EXPECT_THAT(far.output,
              AllOf(HasSubstr("the law was never felt"), HasSubstr("not known: kelvin at 1000 Hz")));
}

TEST(KerfCheck, RefusesWhatNeverHappensInItsRun) {
  const std::string law = examples + "kelvin.law.toml";
  const auto refusal = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"check", law, "--virtual", "--seconds", "2"});
    const Outcome outcome = run_kerf(more);
    EXPECT_EQ(outcome.exit_status, 2);
    return outcome.errors;
  };
  EXPECT_THAT(refusal({"--switch", law + "@5"}), HasSubstr("it is at 5 s of 2 s, and never happens"));
  EXPECT_THAT(refusal({"--switch", law + "@2"}), HasSubstr("it is at 2 s of 2 s"));
  EXPECT_THAT(refusal({"--floor", "1"}), HasSubstr("--floor says nothing to --virtual"));
}

TEST(KerfCheck, GivesSuchALawNoContactAndNoOtherDevice) {
  const Outcome contact = run_kerf({"check", examples + "blade.law.toml", "--device", "sim:pose6",
                                    "--virtual", "--seconds", "1", "--contact", "0.1"});
  EXPECT_EQ(contact.exit_status, 2);
  EXPECT_THAT(contact.errors, HasSubstr("law 'blade' acts on axes of its own"));
  const Outcome device = run_kerf({"check", examples + "orthogonal.law.toml", "--virtual", "--seconds", "1"});
  EXPECT_EQ(device.exit_status, 2);
  EXPECT_THAT(device.errors, HasSubstr("acts on axis 'q1', and sim:scissors has none of that name"));
  EXPECT_THAT(device.errors, HasSubstr(".law.toml: law '")) << "the file is named";
}

}  // namespace
}  // namespace kerf

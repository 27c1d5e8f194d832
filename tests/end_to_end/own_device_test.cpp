// A device that is not Kerf's, from an empty folder to a recording, a probe and a verdict; and one that
// breaks on the way.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "support/program.h"
#include "support/running_box.h"

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::HasSubstr;

class OwnDevice : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  void begin(const std::string& name, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words{"device", "new", name, "-o", at(name)};
    words.insert(words.end(), options.begin(), options.end());
    expect(run_kerf(words), 0);
    expect(run_kerf({"device", "build", at(name + "/" + name + ".c"), "-o", at(name + ".so")}), 0);
  }
  static void expect(const Outcome& outcome, int status) {
    EXPECT_EQ(outcome.exit_status, status) << outcome.output << outcome.errors;
  }
  [[nodiscard]] std::string uri(const std::string& name, const std::string& port) const {
    return fmt::format("plugin:{}?port={}", at(name + ".so"), port);
  }

  test::TemporaryFolder folder_;
};

std::vector<std::vector<std::string>> cells_of(const std::string& file) {
  std::ifstream lines(file);
  std::vector<std::vector<std::string>> all;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream text(line);
    all.emplace_back();
    for (std::string cell; std::getline(text, cell, ',');) all.back().push_back(cell);
  }
  return all;
}

double figure_in(const schema::Recording& recording, const std::string& name) {
  const auto found = recording.header.device_properties.find(name);
  return found == recording.header.device_properties.end() ? std::nan("") : std::get<double>(found->second);
}

TEST_F(OwnDevice, IsRecordedAsItMoved) {
  begin("slider");
  const test::RunningSerialDevice board("slider?trace=" + at("trace.csv"));
  expect(run_kerf({"record", "--device", uri("slider", board.path()), "--seconds", "2", "-o", at("a.h5")}),
         0);
  const schema::Recording recording = schema::read_recording(at("a.h5"));
  EXPECT_GT(recording.rows(), 1000U);  // all, but for deadlines that a loaded machine missed
  EXPECT_THAT(recording.header.device_toml, AllOf(HasSubstr("plugin = "), HasSubstr("sha256 = ")));
  EXPECT_EQ(figure_in(recording, "reports_missing"), 0.0);
  // Each position was one of the carriage's, to the step of its encoder.
  std::vector<double> positions;
  for (const auto& row : cells_of(at("trace.csv"))) {
    if (row.size() > 6 && row[2] == "frame") positions.push_back(std::stod(row[6]));
  }
  ASSERT_GT(positions.size(), 2000U);
  std::sort(positions.begin(), positions.end());
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    const auto above = std::lower_bound(positions.begin(), positions.end(), recording.position[i] - 0.51e-5);
    ASSERT_NE(above, positions.end());
    ASSERT_NEAR(*above, recording.position[i], 0.52e-5) << i;
  }
}

TEST_F(OwnDevice, PushesTheWayThatItShould) {
  begin("slider");
  const test::RunningSerialDevice board("slider?sway=0mm");
  const std::string device = uri("slider", board.path());
  setenv("XDG_DATA_HOME", folder_.path().c_str(),
         1);  // NOLINT(concurrency-mt-unsafe): before any thread reads it
  const Outcome probe = run_kerf({"devices", "--probe", device, "--yes"});
  expect(probe, 0);
  EXPECT_THAT(probe.output, HasSubstr("x"));
}

TEST_F(OwnDevice, FeelsTheForceOfTheLaw) {
  begin("slider");
  const test::RunningSerialDevice board("slider?sway=20mm&trace=" + at("trace.csv"));
  const std::string wall = KERF_SOURCE_DIR "/tests/end_to_end/slider_wall.law.toml";
  expect(run_kerf({"record", "--device", uri("slider", board.path()), "--law", wall, "--seconds", "4", "-o",
                   at("a.h5")}),
         0);
  const schema::Recording recording = schema::read_recording(at("a.h5"));
  const double most = *std::max_element(recording.force_commanded.begin(), recording.force_commanded.end());
  EXPECT_GT(most, 0.2);
  double felt = 0.0;
  for (const auto& row : cells_of(at("trace.csv"))) {
    if (row.size() > 3 && row[2] == "force") felt = std::max(felt, std::stod(row[3]));
  }
  EXPECT_NEAR(felt, most, 0.0011);  // the board takes whole millinewtons
}

TEST_F(OwnDevice, LosesRowsWhereItsBoardLosesFrames) {
  begin("slider");
  const test::RunningSerialDevice board("slider", "drop@0.5:25");
  expect(run_kerf({"record", "--device", uri("slider", board.path()), "--seconds", "2", "-o", at("a.h5")}),
         0);
  EXPECT_EQ(figure_in(schema::read_recording(at("a.h5")), "reports_missing"), 25.0);
}

TEST_F(OwnDevice, ThatIsUnpluggedEndsTheRunAndKeepsWhatThereIs) {
  begin("slider");
  const test::RunningSerialDevice board("slider", "unplug@1.0");
  const Outcome outcome =
      run_kerf({"record", "--device", uri("slider", board.path()), "--seconds", "5", "-o", at("a.h5")});
  expect(outcome, 3);
  EXPECT_THAT(outcome.errors,
              AllOf(HasSubstr("the device was lost after"), HasSubstr("what was recorded is kept")));
  const schema::Recording recording = schema::read_recording(at("a.h5"));
  EXPECT_GT(recording.rows(), 500U);
  EXPECT_THAT(recording.header.status, HasSubstr("aborted: the device was lost"));
}

TEST_F(OwnDevice, ThatCrashesIsNamed) {
  const Outcome outcome =
      run_kerf({"record", "--device", "plugin:" KERF_TEST_DEVICES "/moody.so?mood=crash_read", "--seconds",
                "5", "-o", at("a.h5")});
  expect(outcome, 3);
  EXPECT_THAT(outcome.errors, HasSubstr("it crashed: SIGSEGV in read()"));
  EXPECT_GT(schema::read_recording(at("a.h5")).rows(), 50U);
}

TEST_F(OwnDevice, OneAtATimeHasThePort) {
  begin("slider");
  const test::RunningSerialDevice board("slider");
  const auto first = drivers::open_device(uri("slider", board.path()));
  const Outcome second =
      run_kerf({"record", "--device", uri("slider", board.path()), "--seconds", "1", "-o", at("a.h5")});
  expect(second, 3);
  EXPECT_THAT(second.errors, HasSubstr("another program has it"));
}

TEST_F(OwnDevice, ASensorIsNumberedAndItsLossesAreInTheFile) {
  begin("gauge", {"--sensor"});
  const test::RunningSerialSensor board("gauge?trace=" + at("trace.csv"), "drop@1.0:20");
  expect(run_kerf({"record", "--device", "none", "--sensor", uri("gauge", board.path()), "--seconds", "3",
                   "-o", at("a.h5")}),
         0);
  const schema::Recording recording = schema::read_recording(at("a.h5"));
  EXPECT_EQ(figure_in(recording, "frames_lost"), 20.0);
  EXPECT_NEAR(figure_in(recording, "frame_rate_Hz"), 300.0, 5.0);
  // And beside a device, whose axis z has its component.
  const test::RunningSerialSensor other("gauge");
  expect(run_kerf({"record", "--device", "sim:pose6", "--sensor", uri("gauge", other.path()), "--seconds",
                   "1", "-o", at("b.h5")}),
         0);
}

TEST_F(OwnDevice, OfBadSourceIsRefusedByTheCompilersFirstError) {
  std::ofstream(at("bad.c")) << "int main(void) { return x; }\n";
  const Outcome outcome = run_kerf({"device", "build", at("bad.c"), "-o", at("bad.so")});
  expect(outcome, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("does not compile it"));
  std::ofstream(at("none.c")) << "int f(void) { return 1; }\n";
  const Outcome none = run_kerf({"device", "build", at("none.c"), "-o", at("none.so")});
  expect(none, 2);
  EXPECT_THAT(none.errors, HasSubstr("exports no kerf_plugin_device()"));
  EXPECT_FALSE(std::filesystem::exists(at("none.so")));
  expect(run_kerf({"device", "new", "Mine"}), 2);
}

}  // namespace
}  // namespace kerf

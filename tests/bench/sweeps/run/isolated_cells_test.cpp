// A cell that goes wrong is one cell.

#include <map>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

using test::Outcome;
using testing::HasSubstr;

class IsolatedCells : public test::SweepFolder {
 protected:
  /// Lines of failed.csv by their cell.
  [[nodiscard]] std::map<int, std::string> failed() const {
    std::istringstream lines(merged("w.shards", 1).at("failed.csv"));
    std::map<int, std::string> found;
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) found[std::stoi(line)] = line;
    return found;
  }
};

TEST_F(IsolatedCells, AreRecordedWithTheirReasonAndTakeNoOther) {
  (void)plan_of(test::walls("limits = { seconds = 0.5, megabytes = 400 }\n"));
  const Outcome outcome = run_with("crash@3,hang@7,memory@12", {"-j", "2", "--json"});
  EXPECT_EQ(outcome.exit_status, 1) << outcome.errors;
  const auto told = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(told.at("done"), 20);
  EXPECT_EQ(told.at("failed"), 3);
  const auto why = failed();
  ASSERT_EQ(why.size(), 3U);
  EXPECT_THAT(why.at(3), HasSubstr("crashed,its worker ended by signal 9"));
  EXPECT_THAT(why.at(7), HasSubstr("too long,it takes longer than 0.5 s"));
  EXPECT_THAT(why.at(12), HasSubstr("no memory,it takes more than 400 MB"));
}

TEST_F(IsolatedCells, AreTriedAgainWhereThatIsAskedFor) {
  (void)plan_of(test::walls());
  EXPECT_EQ(run_it({"-j", "1"}).exit_status, 0);
  const auto right = merged();
  std::filesystem::remove_all(file("w.shards"));
  EXPECT_EQ(run_with("crash@3,memory@12", {"-j", "1"}).exit_status, 1);
  EXPECT_EQ(run_it().exit_status, 1) << "they stay what they are";
  const Outcome again = run_it({"--failed", "--json"});
  EXPECT_EQ(again.exit_status, 0) << again.errors;
  EXPECT_EQ(nlohmann::json::parse(again.output).at("computed"), 2);
  EXPECT_EQ(merged(), right);
}

TEST_F(IsolatedCells, SayWhyTheyHaveNoAnswer) {
  schema::Recording recording = test::punch({.seconds = 2.0});
  recording.axes[0].position_unit = "rad";
  recording.axes[0].force_unit = "N·m";
  schema::write_recording(file("r.h5"), recording);
  (void)plan_of(
      "version = 1\nverb = \"fit\"\n[cells]\nrecording = \"r.h5\"\nlaw = [\"fracture\", \"kelvin\"]\naxis = "
      "[\"\", \"y\"]\nfolds = 0\n");
  EXPECT_EQ(run_it({"-j", "1"}).exit_status, 1);
  const auto why = failed();
  EXPECT_THAT(why.begin()->second, HasSubstr("no answer"));
  for (const auto& [cell, line] : why) {
    if (line.find(",y,") == std::string::npos) continue;
    EXPECT_THAT(line, HasSubstr("'y'"));
  }
}

}  // namespace
}  // namespace kerf::bench

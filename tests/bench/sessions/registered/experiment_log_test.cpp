#include "registered/experiment_log.h"

#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/sealed/sealed_session.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

class ExperimentLogTest : public testing::Test {
 protected:
  ExperimentLogTest() {
    kerf::test::write_text(
        file_, ExperimentLog::begun(
                   kerf::test::key_of('k'), {}, {{"experiment", "a \"plan\"\n"}},
                   {{"assigned", {{"participant", "S01"}}}, {"assigned", {{"participant", "S02"}}}}));
  }
  [[nodiscard]] ExperimentLog log(char key = 'k') const { return {file_, kerf::test::key_of(key)}; }
  [[nodiscard]] std::vector<std::string> kinds() const {
    std::vector<std::string> kinds;
    const ExperimentLog now = log();
    for (const LogLine& line : now.lines()) kinds.push_back(line.kind);
    return kinds;
  }
  /// The log without some of its lines, counted from 0.
  void take_out(std::size_t number) const {
    std::istringstream lines(kerf::test::read_text(file_));
    std::string kept;
    std::size_t at = 0;
    for (std::string line; std::getline(lines, line); ++at) {
      if (at != number) kept += line + "\n";
    }
    kerf::test::write_text(file_, kept);
  }
  void expect_refused(const std::string& why) const {
    EXPECT_THAT([&] { (void)log(); }, ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  }

  kerf::test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "experiment.log";
};

TEST_F(ExperimentLogTest, KeepsWhatIsAddedInItsOrder) {
  ExperimentLog first = log();
  ExperimentLog second = log();
  first.append("look", {{"look", 1}});
  second.append("dropped", {{"participant", "S02"}, {"reason", "\"ill\"\n"}});
  EXPECT_THAT(kinds(), ElementsAre("registered", "assigned", "assigned", "look", "dropped"))
      << "also of two that have it open";
  EXPECT_EQ(log().registered().facts["experiment"], "a \"plan\"\n");
  EXPECT_EQ(log().lines().back().facts["reason"], "\"ill\"\n");
  EXPECT_EQ(second.receipt(), log().receipt());
  EXPECT_NE(first.receipt(), log().receipt());
}

TEST_F(ExperimentLogTest, FindsALineThatWasTakenOut) {
  log().append("look", {{"look", 1}});
  log().append("look", {{"look", 2}});
  take_out(3);
  expect_refused("experiment.log:4: was changed, or a line before it was taken out");
}

TEST_F(ExperimentLogTest, FindsALineThatWasChanged) {
  kerf::test::replace_in(file_, "S02", "S03");
  expect_refused("experiment.log:3: was changed");
}

TEST_F(ExperimentLogTest, FindsLinesThatWereExchangedOrRepeated) {
  std::istringstream lines(kerf::test::read_text(file_));
  std::string first;
  std::string second;
  std::string third;
  std::getline(lines, first);
  std::getline(lines, second);
  std::getline(lines, third);
  kerf::test::write_text(file_, first + "\n" + third + "\n" + second + "\n");
  expect_refused("experiment.log:2: was changed");
  kerf::test::write_text(file_, first + "\n" + second + "\n" + second + "\n");
  expect_refused("experiment.log:3: was changed");
  kerf::test::write_text(file_, second + "\n");
  expect_refused("experiment.log:1: ");
}

TEST_F(ExperimentLogTest, IsForgedByNobodyWithoutTheKey) {
  EXPECT_THAT([&] { (void)log('x'); }, ThrowsMessage<std::invalid_argument>(
                                           HasSubstr("experiment.log:1: does not open with this key")));
}

TEST_F(ExperimentLogTest, IsHeldAgainstAReceiptThatWasKept) {
  const std::string before = log().receipt();
  log().append("look", {{"look", 1}});
  const std::string after = log().receipt();
  EXPECT_TRUE(log().bears_out(before));
  EXPECT_TRUE(log().bears_out(after));
  take_out(3);
  EXPECT_TRUE(log().bears_out(before));
  EXPECT_FALSE(log().bears_out(after)) << "the end was cut off, which the log itself cannot tell";
  for (const char* none :
       {"", "3", "3/", "0/0fec241f4a6f0311", "3/0fec", "x/0fec241f4a6f0311", "3/0FEC241F4A6F0311"})
    EXPECT_THROW((void)log().bears_out(none), std::invalid_argument) << none;
}

TEST_F(ExperimentLogTest, DropsALastLineThatACrashHasTorn) {
  const std::string whole = kerf::test::read_text(file_);
  kerf::test::write_text(file_, whole + R"({"kind":"look","ti)");
  EXPECT_THAT(log().warnings(), ElementsAre(HasSubstr("experiment.log:4: the last line is torn")));
  log().append("look", {{"look", 1}});
  EXPECT_THAT(log().warnings(), IsEmpty());
  EXPECT_THAT(kinds(), SizeIs(4));
}

TEST_F(ExperimentLogTest, RefusesWhatIsNoLog) {
  kerf::test::write_text(file_, "");
  expect_refused("is empty");
  kerf::test::write_text(file_, "look 1\n");
  expect_refused("experiment.log:1: is no line of an experiment's log");
  kerf::test::write_text(file_, "{}\n");
  EXPECT_THAT([&] { (void)ExperimentLog::derivation_of(file_); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("is no line")));
}

}  // namespace
}  // namespace kerf::bench

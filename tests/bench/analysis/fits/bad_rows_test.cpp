#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>
#include <kerf/schema/recording_writer.h>

#include "support/program.h"
#include "support/recordings.h"

// What every verb says of a recording that tells nothing, or less than it seems to.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;
using testing::Not;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

class BadRows : public testing::Test {
 protected:
  void keep(const schema::Recording& recording) { schema::write_recording(file_, recording); }
  /// A punch whose force is another.
  template <typename Force>
  static schema::Recording with(Force&& force) {
    schema::Recording recording = test::punch();
    for (std::size_t i = 0; i < recording.force_measured.size(); ++i)
      recording.force_measured[i] = force(i, recording.force_measured[i]);
    return recording;
  }
  [[nodiscard]] Outcome fit() const {
    return run_kerf({"fit", file_, "--models", "kelvin,friction", "-o", folder_ / "fits"});
  }
  [[nodiscard]] Outcome choose() const {
    return run_kerf({"choose", file_, "--no-loop", "--most-segments", "1"});
  }
  [[nodiscard]] Outcome chart() const { return run_kerf({"chart", file_, "--laws", "kelvin", "--no-cold"}); }
  [[nodiscard]] Outcome segment() const { return run_kerf({"segment", file_}); }
  [[nodiscard]] Outcome report() const { return run_kerf({"report", file_, "-o", folder_ / "page.html"}); }

  static void expect_refused(const Outcome& outcome, const std::string& why) {
    EXPECT_EQ(outcome.exit_status, 2) << outcome.errors;
    EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr(why));
  }

  const test::TemporaryFolder folder_;
  const std::string file_ = folder_ / "r.h5";
  std::string errors_;
};

double noise(std::size_t row) { return 0.01 * std::sin(12.9898 * static_cast<double>(row * row % 7919)); }

TEST_F(BadRows, OfNoForceThatIsFeltAreNeitherChartedNorChosenBy) {
  keep(with([](std::size_t row, double) { return noise(row); }));
  expect_refused(chart(), "no force at all is within the JND of 0.05 N too");
  expect_refused(choose(), "no force at all is within the JND of 0.05 N too");
  const Outcome fitted = fit();
  EXPECT_THAT(fitted.errors, HasSubstr("warning: no force at all is within the JND of 0.05 N too"));
  EXPECT_THAT(fitted.output, Not(HasSubstr("choice: ")));
}

TEST_F(BadRows, OfAForceThatNeverChangesSayNothingOfTheMotion) {
  keep(with([](std::size_t row, double) { return 2.5 + noise(row); }));
  const std::string doubt = "warning: a force of 2.5 N that never changes is within the JND of 0.175 N too";
  EXPECT_THAT(fit().errors, HasSubstr(doubt));
  EXPECT_THAT(choose().errors, HasSubstr(doubt));
  EXPECT_THAT(chart().errors, HasSubstr(doubt));
  EXPECT_THAT(segment().errors, HasSubstr("which of them is closing is a guess"));
}

TEST_F(BadRows, ThatAreHeldAreSaidToBe) {
  double held = 0.0;
  keep(with([&](std::size_t row, double force) { return row % 10 == 0 ? held = force + noise(row) : held; }));
  EXPECT_THAT(fit().errors,
              HasSubstr("the force changes only every 10 rows: it was sampled at 100 Hz and held"));
}

TEST_F(BadRows, OfWhichOneDecidesAreNamed) {
  keep(with([](std::size_t row, double force) { return row == 1500 ? force - 45.0 : force + noise(row); }));
  EXPECT_THAT(fit().errors, HasSubstr("one row stands out from both neighbours, most of all at 1.5 s by"));
}

TEST_F(BadRows, OfAForceWithItsSignTurnedAreAskedAbout) {
  keep(with([](std::size_t row, double force) { return -force + noise(row); }));
  const std::string doubt = "the more the force helps it in, up to ";
  for (const Outcome& outcome : {fit(), choose(), chart()}) {
    EXPECT_THAT(outcome.errors, HasSubstr(doubt));
    EXPECT_THAT(outcome.errors, HasSubstr("is its sign turned? --map 'force=COLUMN[-1 N]' turns it"));
  }
  keep(with([](std::size_t row, double force) { return force + noise(row); }));
  EXPECT_THAT(fit().errors, Not(HasSubstr(doubt)));
}

TEST_F(BadRows, OfAPositionThatJumpsSetNoContact) {
  schema::Recording recording = test::punch();
  const auto fitted_stiffness = [&] {
    keep(recording);
    const Outcome outcome = run_kerf(
        {"fit", file_, "--models", "kelvin", "--no-folds", "--json", "--force", "-o", folder_ / "fits"});
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    errors_ = outcome.errors;
    return nlohmann::json::parse(outcome.output)["fits"][0]["parameters"]["parallel_stiffness"]["value"]
        .get<double>();
  };
  const double whole = fitted_stiffness();
  EXPECT_THAT(errors_, Not(HasSubstr("jumps")));
  const double range = *std::ranges::max_element(recording.position);
  recording.position[1203] -= 0.6 * range;
  EXPECT_NEAR(fitted_stiffness() / whole, 1.0, 0.02);
  EXPECT_THAT(errors_, HasSubstr("the position jumps there and back in one row, most of all at 1.203 s by"));
}

TEST_F(BadRows, OfAToolThatTurnsAtOnceJumpNowhere) {
  schema::Recording recording = test::punch();
  for (std::size_t row = 0; row < recording.position.size(); ++row) {  // at rest but for one knock
    const double since = static_cast<double>(row) - 1500.0;
    recording.position[row] = std::max(0.0, 0.004 - 1e-4 * since * since) + 1e-9 * noise(row);
    recording.force_measured[row] = 300.0 * recording.position[row] + noise(row);
  }
  keep(recording);
  EXPECT_THAT(fit().errors, Not(HasSubstr("jumps")));
}

TEST_F(BadRows, ThatAreMissingAreSaidToBeWhereALawRemembers) {
  schema::Recording recording = test::punch();
  for (std::size_t row = 900; row < recording.time.size(); ++row) recording.time[row] += 1.5;
  keep(recording);
  for (const Outcome& outcome : {fit(), choose(), chart()})
    EXPECT_THAT(outcome.errors, HasSubstr("rows are missing once, for 1.5 s from 0.899 s on"));
}

TEST_F(BadRows, AreCountedOnceWhereSeveralGapsAreFollowedByTheSame) {
  schema::Recording recording = test::punch();
  const auto rows_told = [&](std::size_t gaps) {
    schema::Recording late = recording;
    for (std::size_t gap = 0; gap < gaps; ++gap)
      for (std::size_t row = 900 + gap; row < late.time.size(); ++row) late.time[row] += 1.5;
    keep(late);
    std::filesystem::remove_all(folder_ / "fits");
    const std::string said = fit().errors;
    const std::string words = " rows until the tool is free again";
    const std::size_t end = said.find(words);
    EXPECT_NE(end, std::string::npos) << said;
    const std::size_t begin = said.rfind(' ', end - 1) + 1;
    return std::stoul(said.substr(begin, end - begin));
  };
  const std::size_t after_one = rows_told(1);
  EXPECT_EQ(rows_told(3), after_one);
}

TEST_F(BadRows, ThatAreInTwoRecordingsAreSaidToCountTwice) {
  keep(test::punch());
  schema::Recording again = test::punch();
  schema::write_recording(folder_ / "again.h5", again);
  const auto fitted_with_it = [&] {
    return run_kerf({"fit", file_, folder_ / "again.h5", "--models", "kelvin", "--no-folds", "--force", "-o",
                     folder_ / "both"});
  };
  EXPECT_THAT(fitted_with_it().errors, HasSubstr("hold the same rows, which count twice"));
  again.force_measured[700] += 0.01;
  std::filesystem::remove(folder_ / "again.h5");
  schema::write_recording(folder_ / "again.h5", again);
  EXPECT_THAT(fitted_with_it().errors, Not(HasSubstr("hold the same rows")));
}

TEST_F(BadRows, OfASensorAtItsEndAreSaidToBeWhereALawIsChosen) {
  keep(with([](std::size_t, double force) { return std::min(force, 1.0); }));
  EXPECT_THAT(choose().errors, HasSubstr("the sensor may be saturated there"));
}

TEST_F(BadRows, OfOneForceThroughoutAreRefused) {
  keep(with([](std::size_t, double) { return 2.5; }));
  for (const Outcome& outcome : {fit(), choose(), chart()})
    expect_refused(outcome, "the force is 2.5 throughout");
}

TEST_F(BadRows, OfAColumnOfZerosAreRefused) {
  keep(with([](std::size_t, double) { return 0.0; }));
  for (const Outcome& outcome : {fit(), choose()}) expect_refused(outcome, "the force is zero throughout");
  expect_refused(chart(), "no force at all is within the JND of 0.05 N too");
  EXPECT_THAT(segment().errors, HasSubstr("which of them is closing is a guess"));
  schema::Recording still = test::punch();
  std::ranges::fill(still.position, 0.0);
  keep(still);
  for (const Outcome& outcome : {fit(), choose(), chart()})
    expect_refused(outcome, "the position is constant");
  expect_refused(segment(), "no cycle of opening and closing");
}

TEST_F(BadRows, OfOneCycleSayNothingOfTheNext) {
  schema::Recording recording = test::punch({.seconds = 1.24});  // in and out again
  keep(recording);
  ASSERT_THAT(segment().output, HasSubstr("1 closings and 1 openings"));
  const std::string doubt =
      "warning: there is only one cycle: errors are held out by blocks of time within it";
  EXPECT_THAT(fit().errors, HasSubstr(doubt));
  EXPECT_THAT(choose().errors, HasSubstr(doubt));
  EXPECT_THAT(chart().errors, HasSubstr(doubt));
  keep(test::punch());
  ASSERT_EQ(segment().exit_status, 0);
  EXPECT_THAT(choose().errors, Not(HasSubstr("only one cycle")));
}

TEST_F(BadRows, ThatAreNotFiniteAreCounted) {
  keep(with([](std::size_t row, double force) { return row >= 500 && row < 550 ? no_value : force; }));
  for (const Outcome& outcome : {fit(), choose(), chart()})
    EXPECT_THAT(outcome.errors, HasSubstr("warning: 50 rows are not finite and are left out"));
  expect_refused(segment(), "row 500 is not finite");
}

TEST_F(BadRows, OfWhichNoneIsFiniteAreRefusedByEveryVerb) {
  keep(with([](std::size_t, double) { return no_value; }));
  expect_refused(fit(), "there are only 0 samples");
  expect_refused(choose(), "the recording has no row that is finite");
  expect_refused(chart(), "the recording has no row that is finite");
  expect_refused(segment(), "row 0 is not finite");
  expect_refused(report(), "no row has a position and a force that are finite");
}

TEST_F(BadRows, OfWhichOneIsBeyondAllOthersAreRefused) {
  keep(with([](std::size_t row, double force) { return row == 1234 ? 1e9 : force; }));
  for (const Outcome& outcome : {fit(), choose(), chart(), segment()})
    expect_refused(outcome, "1234, 1e+09, has more squares than all others together: leave it out");
}

TEST_F(BadRows, OfWhichThereAreThreeAreTooFew) {
  schema::Recording recording = test::punch({.seconds = 0.003});
  recording.force_measured = {0.0, 0.5, 1.1};
  keep(recording);
  for (const Outcome& outcome : {fit(), choose(), chart()})
    expect_refused(outcome, "there are only 3 samples");
  expect_refused(segment(), "the recording is too short for a cycle");
}

}  // namespace
}  // namespace kerf

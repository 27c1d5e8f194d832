#include <algorithm>
#include <filesystem>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "regress/run.h"

// Kerf's own laws, held to the forces in examples/regress.

namespace kerf::bench {
namespace {

const std::filesystem::path own = std::filesystem::path(KERF_SOURCE_DIR) / "examples/regress/kerf.toml";

TEST(OwnLaws, RenderTheForcesThatAreStored) {
  const SuiteOutcome outcome = run_suite(read_suite(own), {.tick_costs = false});
  for (const RegressionOutcome& one : outcome.cases) {
    EXPECT_TRUE(one.passed()) << one.about.name << ": " << testing::PrintToString(one.messages) << one.why;
    EXPECT_EQ(one.got.faults, 0U) << one.about.name;
  }
  EXPECT_EQ(outcome.failed(), 0U);
}

TEST(OwnLaws, AreAllThere) {
  std::set<std::string_view> pinned;
  const Suite suite = read_suite(own);
  for (const RegressionCase& one : suite.cases) pinned.insert(one.law.law.model());
  for (const models::LawInfo& info : models::registry()) EXPECT_TRUE(pinned.contains(info.name)) << info.name;
}

TEST(OwnLaws, AreMovedSoThatEveryChannelPushesAndLetsGoAgain) {
  const Suite suite = read_suite(own);
  for (const schema::StoredForces& one : schema::read_regression(suite.stored)) {
    const std::size_t columns = one.channels.size();
    std::set<double> values(one.force.begin(), one.force.end());
    EXPECT_GT(values.size(), 30U) << one.name;
    if (one.name == "blade in a scene") continue;  // turns about one axis
    for (std::size_t column = 0; column < columns; ++column) {
      bool pushes = false;
      for (std::size_t row = 0; row < one.rows(); ++row)
        pushes = pushes || one.force[row * columns + column] != 0.0;
      EXPECT_TRUE(pushes) << one.name << ", " << one.channels[column].name;
    }
  }
}

TEST(OwnLaws, FitIntoASmallFile) { EXPECT_LT(std::filesystem::file_size(read_suite(own).stored), 300000U); }

}  // namespace
}  // namespace kerf::bench

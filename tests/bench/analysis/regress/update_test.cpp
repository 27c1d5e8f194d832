#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/version.h>

#include "bench/analysis/regress/small_suite.h"
#include "regress/run.h"

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;
using testing::ThrowsMessage;

class Update : public testing::Test {
 protected:
  [[nodiscard]] Suite suite() const { return read_suite(folder_.suite()); }
  void store(const std::string& reason) const { write_update(suite(), plan_update(suite(), {}), reason); }
  [[nodiscard]] StoredChange change() const { return plan_update(suite(), {}).front(); }
  test::SuiteFolder folder_;
};

TEST_F(Update, IsNeededBeforeTheFirstRun) {
  EXPECT_THAT(run_suite(suite(), {}).cases[0].error,
              AllOf(HasSubstr("no forces are stored for case 'kelvin'"), HasSubstr("kerf regress update")));
  EXPECT_EQ(change().kind, ChangeKind::added);
  store("first forces");
  EXPECT_EQ(run_suite(suite(), {}).failed(), 0U);
}

TEST_F(Update, WantsAReason) {
  EXPECT_THAT([&] { store("  \n"); }, ThrowsMessage<std::invalid_argument>(HasSubstr("--reason")));
  EXPECT_FALSE(std::filesystem::exists(suite().stored));
}

TEST_F(Update, LeavesAloneWhatPasses) {
  store("first forces");
  EXPECT_EQ(change().kind, ChangeKind::unchanged);
  EXPECT_FALSE(changes_anything(plan_update(suite(), {})));
}

TEST_F(Update, SaysWhyAndByHowMuchAndKeepsTheReasons) {
  store("first forces");
  folder_.change_law("value = 8,", "value = 8.1,");
  const StoredChange softer = change();
  EXPECT_EQ(softer.kind, ChangeKind::changed);
  EXPECT_THAT(softer.why, AllOf(StartsWith("the law file has changed since 20"), HasSubstr("first forces")));
  EXPECT_THAT(softer.what, AllOf(HasSubstr("of 400 ticks differ, theta by up to"), HasSubstr("JND")));
  store("the liver was\nstiffer");
  store("nothing new");
  const auto stored = schema::read_regression(suite().stored);
  EXPECT_EQ(stored[0].reason, "the liver was stiffer") << "what does not change keeps its reason";
  EXPECT_THAT(stored[0].history, HasSubstr(software() + ": first forces\n"));
  EXPECT_EQ(run_suite(suite(), {}).failed(), 0U);
}

TEST_F(Update, KnowsATrajectoryFromALawFromTheCode) {
  store("first forces");
  std::string text = test::one_case;
  folder_.write_suite(text.replace(text.find("value = 35"), 10, "value = 34"));
  EXPECT_THAT(change().why, StartsWith("the trajectory has changed"));
  folder_.change_law("value = 8,", "value = 8.1,");
  EXPECT_THAT(change().why, StartsWith("the law file and the trajectory have changed"));
}

TEST_F(Update, CallsItTheCodeIfNothingElseChanged) {
  store("first forces");
  auto stored = schema::read_regression(suite().stored);
  stored[0].force[300] += 0.25;
  schema::write_regression(suite().stored, stored);
  std::filesystem::remove(folder_.at("suite.forces.txt"));  // which would tell of it
  EXPECT_THAT(change().why, StartsWith("law file and trajectory are as they were; the code or the compiler"));
  const SuiteOutcome outcome = run_suite(suite(), {});
  EXPECT_EQ(outcome.failed(), 1U);
  EXPECT_EQ(outcome.cases[0].comparison.worst->tick, 300U);
}

TEST_F(Update, TakesOnlyWhatItIsAskedFor) {
  const std::string one = test::one_case;
  std::string other = one.substr(one.find("[[case]]"));
  other.replace(other.find("kelvin"), 6, "second");
  folder_.write_suite(one + other);
  store("first forces");
  folder_.change_law("value = 8,", "value = 9,");
  const auto plan = plan_update(suite(), {.only = {"second"}});
  ASSERT_THAT(plan, SizeIs(2));
  EXPECT_EQ(plan[0].kind, ChangeKind::unchanged);
  EXPECT_EQ(plan[1].kind, ChangeKind::changed);
  write_update(suite(), plan, "stiffer");
  const SuiteOutcome outcome = run_suite(suite(), {});
  EXPECT_FALSE(outcome.cases[0].passed());
  EXPECT_TRUE(outcome.cases[1].passed());
}

TEST_F(Update, NoticesACaseThatWasDropped) {
  const std::string one = test::one_case;
  std::string other = one.substr(one.find("[[case]]"));
  other.replace(other.find("kelvin"), 6, "second");
  folder_.write_suite(one + other);
  store("first forces");
  folder_.write_suite(one);
  const SuiteOutcome outcome = run_suite(suite(), {});
  EXPECT_THAT(outcome.dropped, ElementsAre("second"));
  EXPECT_EQ(outcome.failed(), 1U) << "a test that went away unnoticed";
  EXPECT_THAT(run_suite(suite(), {.only = {"kelvin"}}).dropped, IsEmpty());
  EXPECT_EQ(plan_update(suite(), {}).back().kind, ChangeKind::removed);
  store("not needed any more");
  EXPECT_EQ(run_suite(suite(), {}).failed(), 0U);
}

// A slab of 60 x 60 nodes costs some thirty times one of 12 x 10: no noise of the machine is that large.
TEST(TickCostLimit, CatchesALawThatBecameSlow) {
  const test::TemporaryFolder folder;
  const std::string law =
      test::read_text(std::filesystem::path(KERF_SOURCE_DIR) / "examples/scissors_mesh.law.toml");
  test::write_text(folder / "mesh.law.toml", law);
  test::write_text(
      folder / "suite.toml",
      "[[case]]\nname = \"mesh\"\nlaw = \"mesh.law.toml\"\nabsolute = { value = 1, unit = \"kN\" }\n"
      "seconds = { value = 20, unit = \"ms\" }\ntick_cost = 3\n[case.motion]\nkind = \"rest\"\n"
      "at = { value = 30, unit = \"deg\" }\n");
  const Suite suite = read_suite(folder / "suite.toml");
  write_update(suite, plan_update(suite, {}), "first forces");
  std::string larger = law;
  larger.replace(larger.find("columns = 12"), 12, "columns = 60");
  larger.replace(larger.find("rows = 10"), 9, "rows = 60");
  test::write_text(folder / "mesh.law.toml", larger);
  const SuiteOutcome slow = run_suite(read_suite(folder / "suite.toml"), {});
  ASSERT_EQ(slow.failed(), 1U);
  EXPECT_THAT(slow.cases[0].messages,
              ElementsAre(AllOf(StartsWith("a tick costs"), HasSubstr("times as much"),
                                HasSubstr("3 times is allowed"))));
  EXPECT_EQ(run_suite(read_suite(folder / "suite.toml"), {.tick_costs = false}).failed(), 0U);
}

TEST(TickCostLimit, IsNotHeldAgainstAnotherKindOfBuild) {
  const test::SuiteFolder folder;
  folder.write_suite(
      std::string(test::one_case).replace(std::string(test::one_case).find("exact"), 0, "tick_cost = 2\n"));
  const Suite suite = read_suite(folder.suite());
  write_update(suite, plan_update(suite, {}), "first forces");
  auto stored = schema::read_regression(suite.stored);
  ASSERT_TRUE(stored[0].tick_cost);
  stored[0].tick_cost = 1e-6;
  schema::write_regression(suite.stored, stored);
  EXPECT_EQ(run_suite(suite, {}).failed(), 1U);
  stored[0].tick_cost_build = "of another kind";
  schema::write_regression(suite.stored, stored);
  const SuiteOutcome outcome = run_suite(suite, {});
  EXPECT_EQ(outcome.failed(), 0U);
  EXPECT_THAT(outcome.cases[0].note, StartsWith("tick cost not compared"));
}

}  // namespace
}  // namespace kerf::bench

// A file that says it is a law is tried in a process of its own before this one loads it.

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/plugins/load.h>

#include "support/program.h"

namespace kerf::plugins {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

fs::path plugin(const std::string& name) { return fs::path(KERF_TEST_PLUGINS) / (name + ".so"); }

std::string refusal(const fs::path& file, std::chrono::milliseconds patience = std::chrono::seconds(5)) {
  try {
    (void)try_law(file, patience);
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_THAT(error.what(), StartsWith(file.string() + ": "));
    return error.what();
  }
  return "";
}

TEST(Plugin, OfC99IsLoadedAndStepsAsTheLawOfTheHouse) {
  const Plugin own = load(plugin("coulomb_spring"), "1234");
  ASSERT_NE(own.law, nullptr);
  EXPECT_EQ(own.law->plugin().name, "coulomb_spring.so");
  EXPECT_EQ(own.law->plugin().sha256, "1234");
  EXPECT_GT(own.trial.step_s, 0.0);
  EXPECT_LT(own.trial.step_s, 20e-6);
  EXPECT_EQ(own.trial.allocations.value_or(0), 0U);
  const std::vector<double> values{0.1, 300.0, 2.0, 0.5, 1e-3};
  const models::Law law = models::Law::make("coulomb_spring", values);
  const models::Law house = models::Law::make("friction", values);
  models::Law::State state = law.initial_state();
  models::Law::State of_house = house.initial_state();
  for (const double x : {0.0, 0.001, 0.004, 0.002, -0.001}) {
    const models::Motion motion{.penetration = x, .velocity = 0.1};
    EXPECT_DOUBLE_EQ(law.step(state, motion, 1e-3).force, house.step(of_house, motion, 1e-3).force);
  }
}

TEST(Plugin, ThatIsNoneIsRefused) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "text.so", "no object\n");
  EXPECT_THAT(refusal(folder / "text.so"), HasSubstr("no shared object that can be opened"));
  EXPECT_THAT(refusal(plugin("no_law")), HasSubstr("exports no kerf_plugin_law()"));
  EXPECT_THAT(refusal(plugin("moody_other_version")), HasSubstr("made for version 2 of kerf/law.h"));
}

TEST(Plugin, ThatBreaksDoesSoInAnotherProcessAndIsNamed) {
  EXPECT_THAT(refusal(plugin("moody_no_number")), HasSubstr("it gives a force that is not finite in step"));
  EXPECT_THAT(refusal(plugin("moody_crash")), HasSubstr("it crashed: SIGSEGV while it was stepped"));
  EXPECT_THAT(refusal(plugin("moody_abort")), HasSubstr("it crashed: SIGABRT while it was stepped"));
  EXPECT_THAT(refusal(plugin("moody_exit")), HasSubstr("it called exit(7) while it was stepped"));
  EXPECT_THAT(refusal(plugin("moody_throws")), HasSubstr("it throws an exception"));
}

TEST(Plugin, ThatWritesWhereItMayNotIsNamed) {
  EXPECT_THAT(refusal(plugin("moody_write_behind")),
              HasSubstr("it reads or writes behind its state of 8 bytes"));
  EXPECT_THAT(refusal(plugin("moody_write_parameters")), HasSubstr("it writes to its parameters"));
}

TEST(Plugin, ThatRemembersMoreThanItsStateHoldsIsNamed) {
  EXPECT_THAT(refusal(plugin("moody_shared_memory")), HasSubstr("two states of it are not apart"));
}

TEST(Plugin, WhoseDerivativesAreNoneIsNamed) {
  EXPECT_THAT(refusal(plugin("moody_wrong_derivative")), HasSubstr("its derivative by 'stiffness' is off"));
}

TEST(Plugin, ThatAllocatesInItsStepIsCounted) {
  const Trial trial = try_law(plugin("moody_allocate"));
  if (!trial.allocations) GTEST_SKIP() << "sanitizers have a malloc of their own";
  EXPECT_GT(*trial.allocations, 100U);
  EXPECT_LT(*trial.allocations, trial.steps);
}

TEST(Plugin, ThatDoesNotComeBackLaterEndsTheProgramByItsName) {
  // In a process of its own: who looks after plug-ins is a thread, and a fork has none.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto step_on = [] {
    (void)load(plugin("moody"), "12", std::chrono::milliseconds(100));
    const models::Law law = models::Law::make("moody", std::vector{100.0, 4.0});  // sleeps for an hour
    models::Law::State state = law.initial_state();
    for (const double depth : {0.001, 0.003})
      (void)law.step(state, models::Motion{.penetration = depth, .velocity = 0.0}, 1e-3);
  };
  EXPECT_EXIT(step_on(), testing::ExitedWithCode(4),
              "moody.so: the law of this plug-in has not come back for 100 ms");
}

TEST(Plugin, ThatSleepsIsGivenUp) {
  EXPECT_THAT(refusal(plugin("moody_sleep"), std::chrono::milliseconds(500)),
              HasSubstr("it gave no sign for 500 ms while it was stepped"));
}

}  // namespace
}  // namespace kerf::plugins

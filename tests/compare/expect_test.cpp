#include <gmock/gmock.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <kerf/compare/gtest.h>

#include "compare/runs.h"

namespace kerf::compare {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(ExpectForces, PassesWhatAHandCannotTell) {
  std::vector<double> got = test::strokes();
  for (double& force : got) force *= 1.03;
  EXPECT_FORCES_WITHIN_JND(test::strokes(), got, 0.5);
}

TEST(ExpectForces, SaysWhatIsWrongAndWhy) {
  std::vector<double> got = test::strokes();
  for (double& force : got) force = -force;
  EXPECT_NONFATAL_FAILURE(EXPECT_FORCES_WITHIN_JND(test::strokes(), got, 0.5),
                          "the force has the other sign");
  const std::string why =
      why_forces_differ({.value = got, .rate_hz = 333.0, .unit = "N·m"}, test::strokes(), 1.0);
  EXPECT_THAT(why, AllOf(HasSubstr("N·m apart"), HasSubstr("the other sign")));
}

}  // namespace
}  // namespace kerf::compare

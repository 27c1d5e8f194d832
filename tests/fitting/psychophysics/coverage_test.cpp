#include "fitting/psychophysics/coverage.h"

#include <gtest/gtest.h>

// Three hundred experiments a design: a share of 95 % is then known to 1.3 %. The benchmark has a thousand.

namespace kerf::test {
namespace {

TEST(Coverage, OfTheThresholdIsWhatItSays) {
  for (const Experiment& experiment : experiments()) {
    const int count = experiment.subjects > 1 ? 60 : 300;
    const Covered covered = coverage(experiment, count, 2026);
    const double least = experiment.subjects > 1 ? 0.88 : 0.92;  // less than three standard errors below 95 %
    EXPECT_GE(covered.threshold, least) << experiment.name;
    EXPECT_LE(covered.threshold, experiment.subjects > 1 ? 1.0 : 0.985) << experiment.name;
    EXPECT_GE(covered.finite, 0.99) << experiment.name;
  }
}

TEST(Coverage, OfARankingRaisesFalseAlarmsAsOftenAsItSays) {
  const double share = false_alarms_of_ranking(20, 600, 7);
  EXPECT_GE(share, 0.025);
  EXPECT_LE(share, 0.08);
}

}  // namespace
}  // namespace kerf::test

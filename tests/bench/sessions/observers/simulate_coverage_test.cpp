#include <gtest/gtest.h>

#include "bench/sessions/observers/simulated_protocols.h"
#include "observers/simulate.h"

// What intervals and tests promise, over a thousand experiments a design.

namespace kerf::bench {
namespace {

Simulation simulated(const std::string& design, std::size_t experiments) {
  std::atomic<std::size_t> done{0};
  return simulate(
      simulated_protocol(design),
      {.sensation = {.felt = {.renderings = 2}}, .experiments = experiments, .curve_points = 0, .jobs = 2},
      done);
}

/// The end of the exact 99.9 % interval of a share: a coverage of 93 % is met where it reaches that.
double at_most(const SimulatedShare& share) {
  return psychophysics::clopper_pearson(share.count, 0.999).upper;
}

const std::string spring = "[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n[scale]\nvary = \"force\"\n";

TEST(SimulatedCoverage, OfConstantLevelsIsWhatTheIntervalSays) {
  const Simulation found = simulated(force_levels(40), 1000);
  EXPECT_GT(found.found.jnd_covered.value(), 0.93);
  EXPECT_LT(found.found.jnd_covered.value(), 0.97);
  EXPECT_LT(found.false_alarms.interval().lower, 0.05);
}

TEST(SimulatedCoverage, OfLevelsOnBothSidesIsWhatTheIntervalSays) {
  const Simulation found =
      simulated("design = \"constant\"\ntrials = 25\n" + spring +
                    "levels = [-0.24, -0.16, -0.08, 0, 0.08, 0.16, 0.24]\nshape = \"gaussian\"\n",
                1000);
  EXPECT_GT(found.found.jnd_covered.value(), 0.93);
  EXPECT_LT(found.found.jnd_covered.value(), 0.97);
  EXPECT_LT(found.false_alarms.interval().lower, 0.05);
}

TEST(SimulatedCoverage, OfAStaircaseIsAtLeastWhatTheIntervalSays) {
  const Simulation found =
      simulated("design = \"staircase\"\ntrials = 80\n" + spring +
                    "staircase = { start = 0.4, steps = [0.4, 0.2, 0.1], least = 0.005, most = 1.0 }\n",
                1000);
  EXPECT_GE(at_most(found.found.jnd_covered), 0.93);
}

TEST(SimulatedCoverage, OfQuestPlusIsAtLeastWhatTheIntervalSays) {
  const Simulation found =
      simulated("design = \"quest\"\n" + spring + "quest = { trials = 40, expected_jnd = 0.1 }\n", 300);
  EXPECT_GE(at_most(found.found.jnd_covered), 0.93);
  EXPECT_LT(found.false_alarms.interval().lower, 0.05);
}

}  // namespace
}  // namespace kerf::bench

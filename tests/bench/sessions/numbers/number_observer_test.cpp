#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/observers/simulated_protocols.h"
#include "observers/simulate.h"
#include "observers/simulation_report.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;

SimulationOptions twelve_people(std::size_t experiments) {
  return {.sensation = {.felt = {.renderings = 1}},
          .experiments = experiments,
          .subjects = 12,
          .curve_points = 0,
          .jobs = 2};
}

Simulation simulated_numbers(const Protocol& protocol, const SimulationOptions& options) {
  std::atomic<std::size_t> done{0};
  return simulate(protocol, options, done);
}

/// What 1000 studies may give of 5 %.
const double most_alarms = 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / 1000);

Protocol varied_force() {
  return simulated_protocol(
      "design = \"magnitude\"\ntrials = 4\n[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n"
      "[scale]\nvary = \"force\"\nlevels = [-0.5, 0, 1, 3]\n");
}

TEST(NumberObserver, GivesTheExponentThatItHas) {
  const Simulation simulation = simulated_numbers(varied_force(), twelve_people(1000));
  EXPECT_NEAR(simulation.found.exponent_mean, 0.8, 0.02);  // lapses make it a little less
  EXPECT_GT(simulation.found.significant.value(), 0.8) << "0.8 is told from 1";
  EXPECT_LT(simulation.false_alarms.value(), most_alarms);
  EXPECT_GT(simulation.false_alarms.value(), 0.02);
  EXPECT_THAT(simulation_lines(simulation), Contains(HasSubstr("whose exponent is 1")));
}

TEST(NumberObserver, WithoutLapsesIsCoveredByItsInterval) {
  SimulationOptions options = twelve_people(1000);
  options.observer.lapse = 0.0;
  const Simulation simulation = simulated_numbers(varied_force(), options);
  const auto interval = psychophysics::clopper_pearson(simulation.found.exponent_covered.count, 0.9999);
  EXPECT_LT(interval.lower, 0.95);
  EXPECT_GT(interval.upper, 0.95);
}

TEST(NumberObserver, TellsNoSampleFromAnotherInFivePercent) {
  const std::string three = two_springs(8, 10) + "[[sample]]\nname = \"third\"\nlaw = \"law 12\"\n";
  SimulationOptions options = twelve_people(1000);
  options.observer.preference_spread = 1.0;
  for (const std::string design :
       {"design = \"magnitude\"\ntrials = 3\n", "design = \"rating\"\nends = [\"a\", \"b\"]\ntrials = 3\n",
        "design = \"rating\"\nends = [\"a\", \"b\"]\npoints = 7\ntrials = 3\n"}) {
    const Simulation simulation = simulated_numbers(simulated_protocol(design + three), options);
    EXPECT_LT(simulation.false_alarms.value(), most_alarms) << design;
    EXPECT_GT(simulation.false_alarms.value(), 0.01) << design;
    EXPECT_GT(simulation.found.significant.value(), simulation.false_alarms.value() + 0.2) << design;
  }
}

TEST(NumberObserver, StaysOnItsScale) {
  SimulationOptions options = twelve_people(2);
  options.observer.modulus_spread = 4.0;
  options.observer.lapse = 0.5;
  const Simulation simulation = simulated_numbers(
      simulated_protocol("design = \"rating\"\nends = [\"a\", \"b\"]\npoints = 7\ntrials = 20\n" +
                         two_springs(8, 30)),
      options);
  for (const Judgement& each : simulation.example->judgements) {
    EXPECT_GE(each.estimate, 1.0);
    EXPECT_LE(each.estimate, 7.0);
    EXPECT_EQ(each.estimate, std::floor(each.estimate));
  }
}

}  // namespace
}  // namespace kerf::bench

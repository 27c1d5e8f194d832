#include "observers/simulated_looks.h"

#include <atomic>
#include <string>

#include <gtest/gtest.h>

#include "bench/sessions/observers/simulated_protocols.h"
#include "observers/simulate.h"

namespace kerf::bench {
namespace {

Experiment registered(const std::string& analysis) {
  return parse_experiment(
      "name = \"x\"\nprotocol = \"p\"\n[participants]\ntarget = 16\n[analysis]\n" + analysis, "e.toml");
}

Simulation simulated_with_looks(const Protocol& protocol, const Experiment& experiment,
                                std::size_t experiments) {
  SimulationOptions options{
      .sensation = {.felt = {.renderings = 1}}, .experiments = experiments, .curve_points = 0, .jobs = 2};
  options.subjects = experiment.participants.target;
  options.analysis.level = experiment.analysis.alpha;
  options.experiment = experiment;
  std::atomic<std::size_t> done{0};
  return simulate(protocol, options, done);
}

const std::string short_abx = "design = \"abx\"\ntrials = 12\n";

TEST(SimulatedLooks, PaidByPocockRaiseNoMoreFalseAlarmsThanAlpha) {
  const auto simulation = simulated_with_looks(
      simulated_protocol(short_abx + two_springs(8, 8.8)),
      registered("stopping = { rule = \"alpha-spending\", spending = \"pocock\", looks = [6, 9, 12] }"),
      2000);
  ASSERT_TRUE(simulation.looks);
  const auto alarms = psychophysics::clopper_pearson(simulation.looks->nothing.shown.count, 0.999);
  EXPECT_LE(alarms.lower, 0.05);
  EXPECT_GE(alarms.upper, 0.02);
  EXPECT_LT(simulation.looks->found.participants, 16.0) << "who feels it ends earlier";
  EXPECT_GT(simulation.looks->nothing.participants, 15.0);
  int ended = 0;
  for (const SimulatedShare& share : simulation.looks->found.ended) ended += share.count.successes;
  EXPECT_EQ(ended, 2000) << "every study ends at one look";
}

TEST(SimulatedLooks, ByABayesFactorEndForEither) {
  const auto simulation = simulated_with_looks(
      simulated_protocol(short_abx + two_springs(8, 9.6)),
      registered("stopping = { rule = \"bayes-factor\", evidence = 4, looks = [8, 12] }"), 500);
  ASSERT_TRUE(simulation.looks);
  EXPECT_GT(simulation.looks->found.shown.value(), 0.5);
  EXPECT_LT(simulation.looks->nothing.shown.value(), 0.2);
  EXPECT_GT(simulation.looks->nothing.none.value(), 0.3) << "evidence for nothing is had too";
  EXPECT_EQ(simulation.looks->found.none.count.trials, 500);
}

TEST(SimulatedLooks, AreNoneOfAFixedStudy) {
  const auto simulation =
      simulated_with_looks(simulated_protocol(short_abx + two_springs(8, 8.8)), registered(""), 50);
  EXPECT_FALSE(simulation.looks);
  EXPECT_EQ(simulation.options.subjects, 16U);
}

}  // namespace
}  // namespace kerf::bench

#include "observers/simulate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/observers/simulated_protocols.h"
#include "observers/simulation_report.h"

namespace kerf::bench {
namespace {

SimulationOptions options_of(std::size_t experiments) {
  return {.sensation = {.felt = {.renderings = 1}}, .experiments = experiments, .curve_points = 0, .jobs = 2};
}

Simulation simulated(const Protocol& protocol, const SimulationOptions& options) {
  std::atomic<std::size_t> done{0};
  return simulate(protocol, options, done);
}

const std::string abx = "design = \"abx\"\ntrials = 40\n";
const std::string two_intervals = "design = \"2ifc\"\nsignal = \"second\"\ntrials = 24\n";

TEST(Simulate, FindsWhatTheExactProbabilitySays) {
  const Simulation simulation =
      simulated(simulated_protocol(two_intervals + two_springs(8, 8.8)), options_of(1000));
  ASSERT_GT(simulation.theory, 0.3);
  ASSERT_LT(simulation.theory, 0.95);
  const auto interval = psychophysics::clopper_pearson(simulation.found.significant.count, 0.9999);
  EXPECT_LT(interval.lower, simulation.theory);
  EXPECT_GT(interval.upper, simulation.theory);
  EXPECT_NEAR(simulation.found.d_prime_median, simulation.truth.d_prime, 0.15);
  EXPECT_GT(simulation.found.d_prime_covered.value(), 0.94);  // Clopper and Pearson: at least 95 %
}

TEST(Simulate, OfTwoOfTheSameHasNothingToFindButFalseAlarms) {
  const Simulation simulation = simulated(simulated_protocol(abx + two_springs(8, 8)), options_of(1000));
  ASSERT_EQ(simulation.truth.cells.size(), 1U);
  EXPECT_EQ(simulation.truth.cells[0].d_prime, 0.0);
  EXPECT_LT(simulation.found.significant.value(), 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / 1000));
  EXPECT_EQ(simulation.needed_total, 0U);
}

TEST(Simulate, ObserversWhoFeelNothingRaiseFalseAlarmsInAtMostFivePercent) {
  const double most = 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / 1000);
  for (const std::string& design : {abx, two_intervals}) {
    const Simulation simulation =
        simulated(simulated_protocol(design + two_springs(8, 12)), options_of(1000));
    EXPECT_GT(simulation.truth.cells[0].d_prime, 0.9);
    EXPECT_LT(simulation.false_alarms.value(), most);
    EXPECT_GT(simulation.false_alarms.value(), 0.005);
  }
}

// Of twelve people whose tastes differ by d' = 2 about none, 20 to 40 % of the studies would find a
// preference if their answers were taken as independent.
TEST(Simulate, PeopleWhoDisagreeRaiseNoMoreFalseAlarmsThanTheTestSays) {
  SimulationOptions options = options_of(1000);
  options.subjects = 12;
  options.observer.preference_spread = 2.0;
  const Simulation simulation =
      simulated(simulated_protocol("design = \"preference\"\ntrials = 12\n" + two_springs(8, 16)), options);
  EXPECT_LT(simulation.false_alarms.value(), 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / 1000));
  EXPECT_GT(simulation.false_alarms.value(), 0.02);
}

TEST(Simulate, ObserversOfWhomFewFeelAnythingAreRightAsOftenAsTheExactProbabilitySays) {
  SimulationOptions options = options_of(400);
  options.subjects = 8;
  options.observer.share_feeling = 0.25;
  options.sensation.d_prime = 2.0;
  options.analysis.d_prime_bound = 1.0;
  const Simulation simulation = simulated(simulated_protocol(two_intervals + two_springs(8, 12)), options);
  // A quarter of P(2 / sqrt2) without lapses, three quarters of a half.
  const double felt = 0.98 * 0.5 * std::erfc(-1.0) + 0.02 * 0.5;
  EXPECT_NEAR(simulation.truth.share, 0.25 * felt + 0.75 * 0.5, 1e-9);
  EXPECT_EQ(simulation.found.equivalent.count.trials, 400);
  EXPECT_LT(simulation.found.equivalent.value(), 0.2) << "some of them hear well";
}

TEST(Simulate, TheTrialsThatItTakesGiveThePowerThatWasWanted) {
  SimulationOptions options = options_of(1000);
  options.power = 0.9;
  const Simulation simulation = simulated(simulated_protocol(two_intervals + two_springs(8, 8.8)), options);
  ASSERT_TRUE(simulation.confirmed);
  EXPECT_EQ(simulation.confirmed->trials, simulation.needed_total);
  EXPECT_GT(simulation.confirmed->found.significant.value(), 0.9 - 4.0 * std::sqrt(0.09 / 1000));
}

TEST(Simulate, IntervalsOfAJndCoverItAsOftenAsTheySay) {
  const Simulation simulation = simulated(simulated_protocol(force_levels(40)), options_of(200));
  EXPECT_GT(simulation.truth.jnd, 0.08);  // lapses, and a hand that gives way to more force
  EXPECT_LT(simulation.truth.jnd, 0.13);
  EXPECT_GT(simulation.found.jnd_found.value(), 0.95);
  EXPECT_NEAR(simulation.found.jnd_covered.value(), 0.95, 4.0 * std::sqrt(0.95 * 0.05 / 200));
  EXPECT_NEAR(simulation.found.jnd_bias, 0.0, 0.1);
}

TEST(Simulate, TheJndOfOneWhoNeverLapsesIsItsWeberFraction) {
  // Strong forces along a motion that nothing disturbs, so that Weber's law holds and nothing is clipped.
  Protocol protocol = simulated_protocol(force_levels(10));
  protocol.samples[0].gain = 10.0;
  SimulationOptions options = options_of(2);
  options.observer.lapse = 0.0;
  options.sensation.felt.open_loop = true;
  EXPECT_NEAR(simulated(protocol, options).truth.jnd, 0.07, 2e-4);
}

TEST(Simulate, GivesTheSameForEveryNumberOfThreads) {
  const Protocol protocol = simulated_protocol(force_levels(10));
  SimulationOptions options = options_of(12);
  options.curve_points = 3;
  options.curve_experiments = 4;
  options.jobs = 1;
  const Simulation one = simulated(protocol, options);
  options.jobs = 2;
  const Simulation two = simulated(protocol, options);
  EXPECT_EQ(simulation_json(one).dump(), simulation_json(two).dump());
  options.seed = 2;
  EXPECT_NE(simulation_json(one).dump(), simulation_json(simulated(protocol, options)).dump());
}

TEST(Simulate, LetsEveryAdaptiveDesignRunToItsEnd) {
  const std::string sample = "[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n[scale]\nvary = \"force\"\n";
  const Simulation staircase =
      simulated(simulated_protocol(
                    "design = \"staircase\"\ntrials = 80\n" + sample +
                    "staircase = { start = 0.3, reversals = 10, dropped = 2, least = 0.005, most = 1.0 }\n"),
                options_of(4));
  EXPECT_EQ(staircase.false_alarms.count.trials, 0);  // no main test
  EXPECT_GT(staircase.found.trials, 20.0);
  EXPECT_LE(staircase.found.trials, 80.0);
  const Simulation quest = simulated(
      simulated_protocol("design = \"quest\"\n" + sample + "quest = { trials = 20, expected_jnd = 0.1 }\n"),
      options_of(2));
  EXPECT_EQ(quest.found.trials, 20.0);
}

TEST(Simulate, APreferenceIsFoundOnlyWhereThereIsOne) {
  const Protocol protocol = simulated_protocol("design = \"preference\"\ntrials = 60\n" + two_springs(8, 16));
  SimulationOptions options = options_of(500);
  const double most = 0.05 + 4.0 * std::sqrt(0.05 * 0.95 / 500);
  EXPECT_LT(simulated(protocol, options).found.significant.value(), most);
  options.observer.preference = 1.0;
  const Simulation preferring = simulated(protocol, options);
  EXPECT_GT(preferring.found.significant.value(), 0.8);
  EXPECT_LT(preferring.truth.share, 0.5);  // counted is the first, liked the second
}

TEST(Simulate, SubjectsWhoDifferHaveTheJndOfTheirMeanCurve) {
  SimulationOptions options = options_of(2);
  const Protocol protocol = simulated_protocol(force_levels(10));
  const double alike = simulated(protocol, options).truth.jnd;
  options.observer.spread = 0.5;
  const double unlike = simulated(protocol, options).truth.jnd;
  EXPECT_GT(std::abs(unlike / alike - 1.0), 0.01);  // a flatter curve
  EXPECT_NEAR(unlike, alike, 0.15 * alike);         // about the same middle
}

TEST(Simulate, TellsOnItsPageWhatItTellsInItsLines) {
  SimulationOptions options = options_of(10);
  options.curve_points = 2;
  options.curve_experiments = 5;
  const Simulation simulation = simulated(simulated_protocol(abx + two_springs(8, 12)), options);
  const std::string csv = simulation_csv(simulation);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_EQ(simulation_charts(simulation).size(), 3U);
  const auto json = simulation_json(simulation);
  EXPECT_EQ(json["found"]["power"]["experiments"], 10);
  EXPECT_TRUE(json["truth"]["jnd"].is_null());
}

// A trial that is void in a share p and comes again up to r times is void p + p^2 + ... + p^(r+1) times on
// the average, and lost in a share p^(r+1).
TEST(Simulate, CountsTheTrialsThatComeAgainAndThoseThatAreLost) {
  const std::string rules = "[trial]\nslip = true\nexplore = { strokes = 2 }\nrepeats = 1\n";
  SimulationOptions options = options_of(400);
  options.observer.slip = 0.2;
  options.observer.unexplored = 0.125;
  const Simulation simulation =
      simulated(simulated_protocol(abx + "practice = 10\n" + two_springs(8, 8.8) + rules), options);
  ASSERT_TRUE(simulation.voided);
  const SimulatedVoid& voided = *simulation.voided;
  constexpr double p = 0.3;  // 0.2 + 0.8 x 0.125
  constexpr double trials = 50.0;
  // Standard errors of 400 x 50 trials are below 0.006 a trial.
  EXPECT_NEAR((voided.slipped + voided.unexplored) / trials, p + p * p, 0.024);
  EXPECT_NEAR(voided.slipped / voided.unexplored, 2.0, 0.2);
  EXPECT_NEAR(voided.lost / trials, p * p, 0.012);
  EXPECT_NEAR(voided.again / trials, p, 0.018);
  EXPECT_NEAR(voided.given, trials + voided.again, 1e-9);
  EXPECT_NEAR(simulation.found.trials, 40.0 * (1.0 - p * p), 0.5) << "what is lost is missing";
  const Simulation careful =
      simulated(simulated_protocol(abx + "practice = 10\n" + two_springs(8, 8.8) + rules), options_of(2));
  EXPECT_FALSE(careful.voided);
  EXPECT_GT(simulation.mean_session_s, 1.2 * careful.mean_session_s);
  EXPECT_THAT(simulation_lines(simulation), testing::Contains(testing::HasSubstr("come again")));
  EXPECT_NEAR(simulation_json(simulation)["void_per_session"]["lost"].get<double>(), voided.lost, 1e-12);
  EXPECT_TRUE(simulation_json(careful)["void_per_session"].is_null());
}

TEST(Simulate, RefusesMishapsThatTheProtocolDoesNotProvideFor) {
  SimulationOptions options = options_of(2);
  options.observer.slip = 0.1;
  EXPECT_THAT([&] { (void)simulated(simulated_protocol(abx + two_springs(8, 8.8)), options); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("say slip = true there")));
  options.observer.slip = 0.0;
  options.observer.unexplored = 0.1;
  EXPECT_THAT([&] { (void)simulated(simulated_protocol(abx + two_springs(8, 8.8)), options); },
              testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr("in 'explore'")));
  options.observer.unexplored = 1.0;
  EXPECT_THROW((void)simulated(simulated_protocol(abx + two_springs(8, 8.8)), options),
               std::invalid_argument);
}

TEST(Simulate, RefusesWhatSaysNothing) {
  const Protocol protocol = simulated_protocol(abx + two_springs(8, 12));
  EXPECT_THROW(simulated(protocol, options_of(1)), std::invalid_argument);
  SimulationOptions options = options_of(10);
  options.subjects = 0;
  EXPECT_THROW(simulated(protocol, options), std::invalid_argument);
  options = options_of(10);
  options.observer.jnd = -0.1;
  EXPECT_THROW(simulated(protocol, options), std::invalid_argument);
}

const std::string third_of_catches =
    "[[sample]]\nname = \"none\"\nlaw = \"law 0.001\"\n[catch]\nevery = 5\nsample = \"none\"\n";

TEST(Simulate, TellsHowOftenCatchTrialsExcludeWhoAttendsAndWhoDoesNot) {
  for (const std::string& design : {abx, std::string("design = \"preference\"\ntrials = 40\n")}) {
    SimulationOptions options = options_of(200);
    options.subjects = 4;
    const Simulation simulation =
        simulated(simulated_protocol(design + two_springs(8, 8.8) + third_of_catches), options);
    ASSERT_TRUE(simulation.catches.has_value());
    const SimulatedCatches& catches = *simulation.catches;
    EXPECT_DOUBLE_EQ(catches.trials, 8.0);
    EXPECT_EQ(catches.attentive_out.count.trials, 800);
    // A lapse of 2 % misses half of its trials: seven or eight of eight are right in all but 0.3 %.
    EXPECT_NEAR(catches.attentive_right, 0.99, 0.01);
    EXPECT_LT(catches.attentive_out.value(), 0.02);
    // Who answers by chance has seven or eight of eight right in 9 of 256.
    EXPECT_NEAR(catches.inattentive_right, 0.5, 0.03);
    EXPECT_NEAR(catches.inattentive_out.value(), 247.0 / 256.0, 0.03);
    EXPECT_EQ(simulation_json(simulation)["catch"]["trials"], 8.0);
  }
}

TEST(Simulate, LeavesOutWhoDoesNotAttendAsTheRuleHasIt) {
  const Protocol protocol = simulated_protocol(abx + two_springs(8, 8.8) + third_of_catches);
  SimulationOptions options = options_of(200);
  options.subjects = 8;
  options.observer.share_inattentive = 0.5;
  const Simulation all = simulated(protocol, options);
  options.catch_right = 0.8;
  const Simulation attentive = simulated(protocol, options);
  EXPECT_NEAR(all.found.trials, 320.0, 1e-9) << "without a rule everybody is analysed";
  EXPECT_NEAR(attentive.found.trials, 165.0, 15.0);
  EXPECT_GT(attentive.truth.share, all.truth.share) << "chance is not among those who attend";
}

TEST(Simulate, OfLevelsHasCatchTrialsThatNobodyMisses) {
  SimulationOptions options = options_of(50);
  const Simulation simulation =
      simulated(simulated_protocol(
                    "design = \"staircase\"\ntrials = 30\n[[sample]]\nname = \"spring\"\nlaw = \"law 8\"\n"
                    "[scale]\nvary = \"force\"\nstaircase = { start = 0.3 }\n[catch]\nevery = 5\nlevel = "
                    "2.0\n"),
                options);
  ASSERT_TRUE(simulation.catches.has_value());
  EXPECT_GT(simulation.catches->attentive_right, 0.95);
  EXPECT_LT(simulation.found.trials, 30.5) << "catch trials are none of those that count";
}

}  // namespace
}  // namespace kerf::bench

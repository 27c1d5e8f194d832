#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/compare/diagnose.h>

#include "compare/runs.h"

// Each name against a change that was made on purpose; scripts/benchmark diagnosis makes hundreds.

namespace kerf::compare {
namespace {

using test::run_of;
using test::six_axes;
using test::strokes;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

std::vector<std::string> said(const Series& expected, const Series& got, const Facts& facts = {}) {
  return sentences_of(diagnose(expected, got, facts), expected);
}
std::vector<std::string> said(const std::vector<double>& got) { return said(run_of(strokes()), run_of(got)); }

Finding named(const Series& expected, const Series& got, Change change) {
  const Diagnosis diagnosis = diagnose(expected, got);
  const auto found = std::ranges::find(diagnosis.names, change, &Finding::change);
  EXPECT_NE(found, diagnosis.names.end()) << name_of(change);
  return found == diagnosis.names.end() ? Finding{} : *found;
}
double number_of(const Finding& finding, const std::string& name) {
  const auto found = std::ranges::find(finding.numbers, name, &std::pair<std::string, double>::first);
  return found == finding.numbers.end() ? std::nan("") : found->second;
}
double number(const std::vector<double>& got, Change change, const std::string& name) {
  return number_of(named(run_of(strokes()), run_of(got), change), name);
}

std::vector<double> changed(const std::function<double(double force, std::size_t tick)>& change) {
  std::vector<double> force = strokes();
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = change(force[i], i);
  return force;
}

TEST(Diagnose, KnowsFactorsAndWhereTheyComeFrom) {
  const auto times = [](double factor) {
    return said(changed([&](double f, std::size_t) { return factor * f; }));
  };
  EXPECT_THAT(times(180.0 / std::numbers::pi),
              ElementsAre(HasSubstr("180/pi: degrees where radians are meant"), HasSubstr("57.2958 times")));
  EXPECT_THAT(times(std::numbers::pi / 180.0), Contains(HasSubstr("radians where degrees are meant")));
  EXPECT_THAT(times(1000.0), Contains(HasSubstr("m and mm")));
  EXPECT_THAT(times(1.0 / 9.80665e-3), Contains(HasSubstr("one of N and gf")));
  EXPECT_THAT(times(-1.0), ElementsAre("the force has the other sign"));
  EXPECT_THAT(times(1.5), ElementsAre("the force is 1.5 times the expected one"));
}

TEST(Diagnose, KnowsWhatIsAddedToAForce) {
  EXPECT_NEAR(number(changed([](double f, std::size_t) { return f - 0.1; }), Change::offset, "offset"), -0.1,
              1e-9);
  EXPECT_NEAR(number(changed([](double f, std::size_t i) { return f + 1e-5 * static_cast<double>(i); }),
                     Change::drift, "per_s"),
              0.01, 1e-9);
  const auto buzz = changed([](double f, std::size_t i) {
    return f + 0.02 * std::sin(2.0 * std::numbers::pi * 0.2503 * static_cast<double>(i));
  });
  EXPECT_NEAR(number(buzz, Change::vibration, "hz"), 250.3, 0.01);
  EXPECT_NEAR(number(buzz, Change::vibration, "amplitude"), 0.02, 1e-5);
  const auto alternating = changed([](double f, std::size_t i) { return f + (i % 2 == 0 ? 0.024 : -0.024); });
  EXPECT_NEAR(number(alternating, Change::vibration, "hz"), 500.0, 1e-6);
  const auto rough = test::noise(4000, 0.03);
  EXPECT_NEAR(number(changed([&](double f, std::size_t i) { return f + rough[i]; }), Change::noise, "rms"),
              0.03, 2e-3);
  EXPECT_THAT(said(changed([](double f, std::size_t i) { return i == 2100 ? f + 0.7 : f; })),
              Contains("a spike of +0.7 N at tick 2100"));
  EXPECT_NEAR(
      number(changed([](double f, std::size_t) { return std::min(f, 1.7); }), Change::saturation, "high"),
      1.7, 1e-12);
}

TEST(Diagnose, KnowsSilenceAndSinceWhen) {
  EXPECT_THAT(said(std::vector<double>(4000, 0.0)),
              Contains(StartsWith("the law is silent: no force in any tick, where up to 3 is expected")));
  // Within a stroke: the tick at which it falls silent is seen.
  EXPECT_THAT(said(changed([](double f, std::size_t i) { return i < 900 ? f : 0.0; })),
              Contains(HasSubstr("the law is silent from tick 900 on")));
  EXPECT_EQ(number(changed([](double f, std::size_t i) { return i < 200 || i > 260 ? f : 0.0; }),
                   Change::silence, "row"),
            200.0);
  EXPECT_THAT(said(changed([](double f, std::size_t i) { return i < 960 ? f : strokes()[960]; })),
              Contains(HasSubstr("stays at")));
}

TEST(Diagnose, KnowsALagOfTicksAndOfFractions) {
  for (const double ticks : {1.0, 7.0, -2.0, 0.4, 3.25}) {
    for (const double seconds_a_tick : {1e-3, 3e-3}) {
      std::vector<double> late;
      for (std::size_t i = 0; i < 4000; ++i) {  // of the formula itself, at another time
        const double depth =
            std::sin(2.0 * std::numbers::pi * 1.3 * seconds_a_tick * (static_cast<double>(i) - ticks)) - 0.2;
        late.push_back(depth > 0.0 ? 3.0 * depth * depth / 0.64 : 0.0);
      }
      const Finding lag = named(run_of(strokes(4000, seconds_a_tick), seconds_a_tick),
                                run_of(late, seconds_a_tick), Change::lag);
      EXPECT_NEAR(number_of(lag, "ticks"), ticks, 0.01);
      EXPECT_NEAR(number_of(lag, "ms"), 1e3 * ticks * seconds_a_tick, 0.03);
    }
  }
}

TEST(Diagnose, KnowsAnotherRate) {
  EXPECT_NEAR(
      number_of(named(run_of(strokes(4000, 1e-3)), run_of(strokes(8000, 0.5e-3)), Change::rate), "speed"),
      0.5, 1e-3);
  EXPECT_NEAR(number_of(named(run_of(strokes()), run_of(strokes(4000, 1.01e-3)), Change::rate), "speed"),
              1.01, 1e-4);
}

// A sample was lost where the force was zero: nobody can say which, and what follows is not wrong.
TEST(Diagnose, SaysBetweenWhichTicksASampleIsMissing) {
  std::vector<double> force = strokes();
  ASSERT_EQ(force[500], 0.0);
  force.erase(force.begin() + 500);
  const Finding zero = named(run_of(strokes()), run_of(force), Change::lost);
  EXPECT_LT(number_of(zero, "first_row"), 500.0);
  EXPECT_GE(number_of(zero, "row"), 500.0);
  EXPECT_THAT(zero.sentence, HasSubstr("which look the same"));
  Series expected = run_of(strokes());
  Series got = run_of(force);
  for (Series* run : {&expected, &got}) {
    run->positions = {{.name = "theta", .unit = "rad", .value = {}}};
    for (std::size_t i = 0; i < run->rows(); ++i)
      run->positions[0].value.push_back(
          std::cos(1e-3 * static_cast<double>(i + (run == &got && i >= 500 ? 1 : 0))));
  }
  EXPECT_EQ(named(expected, got, Change::lost).sentence, "a sample is missing, at tick 500")
      << "its motion says which";
}

TEST(Diagnose, KnowsLostAndDoubledSamplesAtTheirRows) {
  std::vector<double> force = strokes();
  force.erase(force.begin() + 900, force.begin() + 903);
  force.erase(force.begin() + 150);
  EXPECT_THAT(said(force), ElementsAre("4 samples are missing, at tick 150; at tick 900"));
  force = strokes();
  force.insert(force.begin() + 900, force[900]);
  EXPECT_THAT(said(force), Contains("a sample is there twice, at tick 900"));
  force = strokes();
  force.insert(force.begin() + 900, 9.0);
  EXPECT_THAT(said(force), ElementsAre("a sample is there that nobody expects, at tick 900"));
  force = strokes();
  force.resize(3000);
  EXPECT_THAT(said(force), ElementsAre("what is there is the same: the end is missing"));
  EXPECT_THAT(said(changed([](double f, std::size_t i) { return i == 900 ? strokes()[899] : f; })),
              Contains("a sample is replaced by the sample before, first tick 900"));
}

// Six axes, as a simulator has them: what is wrong with one is not lost among the others.
TEST(Diagnose, LooksAtEachOfSixAxesAndAtAllOfThem) {
  const Series expected = six_axes();
  const auto with = [&](const std::function<void(std::vector<Channel>&)>& change) {
    Series got = expected;
    change(got.channels);
    return said(expected, got);
  };
  const auto scaled = [](Channel& channel, double factor) {
    for (double& one : channel.value) one *= factor;
  };
  EXPECT_THAT(with([&](auto& all) { scaled(all[1], -1.0); }), Contains("y: the force has the other sign"));
  EXPECT_THAT(with([](auto& all) { std::swap(all[0].value, all[1].value); }),
              Contains("x, y: axes took each other's place: x is y, y is x"));
  EXPECT_THAT(with([&](auto& all) {
                for (int i : {3, 4, 5}) scaled(all[static_cast<std::size_t>(i)], 1000.0);
              }),
              Contains(AllOf(StartsWith("rx, ry, rz: "), HasSubstr("N·m and N·mm"))));
  EXPECT_THAT(with([](auto& all) {
                for (double& one : all[2].value) one += 0.3;
              }),
              ElementsAre("z: +0.3 N in every tick"));
  EXPECT_THAT(with([](auto& all) {
                for (auto& one : all) std::fill(one.value.begin() + 500, one.value.end(), 0.0);
              }),
              Contains(StartsWith("x, y, z, rx, ry, rz: the law is silent from tick 500 on")));
  const auto turned = with([](auto& all) {
    const double c = std::cos(0.1);
    const double s = std::sin(0.1);
    for (std::size_t i = 0; i < all[0].value.size(); ++i) {
      const double x = all[0].value[i];
      const double y = all[1].value[i];
      all[0].value[i] = c * x - s * y;
      all[1].value[i] = s * x + c * y;
    }
  });
  EXPECT_THAT(turned, Contains("x, y: the axes are turned by 5.73 deg about (0, 0, 1)"));
  EXPECT_THAT(with([](auto& all) {
                for (auto& one : all)
                  one.value.insert(one.value.begin(), one.value.front()), one.value.pop_back();
              }),
              Contains(StartsWith("x, y, z, rx, ry, rz: the force comes 1 tick (1 ms) too late")));
}

/// A spring beside a spring and dashpot along strokes, with its motion.
Series kelvin_run(double k1, double k2, double initial_arm = 0.0, double moved = 0.0) {
  Series run{.channels = {{.name = "x", .unit = "N", .value = {}}},
             .positions = {{.name = "x", .unit = "m", .value = {}}}};
  double arm = initial_arm;
  double before = 0.0;
  for (std::size_t i = 0; i < 4000; ++i) {
    const double x =
        0.01 + moved + 0.008 * std::sin(2.0 * std::numbers::pi * 0.8e-3 * static_cast<double>(i));
    arm = arm * std::exp(-1e-3 / 0.08) + (i > 0 ? k2 * (x - before) : 0.0);
    before = x;
    run.channels[0].value.push_back(k1 * x + arm);
    run.positions[0].value.push_back(x);
  }
  return run;
}

TEST(Diagnose, TellsAParameterFromAFactor) {
  const Series expected = kelvin_run(300.0, 500.0);
  // One spring is a hundredth stiffer: no factor makes that, though the largest share is one.
  EXPECT_THAT(said(expected, kelvin_run(303.0, 500.0), {.law_changed = true}),
              ElementsAre(HasSubstr("the parameters of the law: its file has changed")));
  EXPECT_THAT(said(expected, kelvin_run(303.0, 505.0)),
              AllOf(Contains(HasSubstr("1.01 times the expected one")), Contains(HasSubstr("parameters"))));
}

TEST(Diagnose, KnowsAnotherStateAndAnotherTrajectory) {
  const Series expected = kelvin_run(300.0, 500.0);
  const Finding state = named(expected, kelvin_run(300.0, 500.0, 0.4), Change::state);
  EXPECT_NEAR(number_of(state, "ms"), 80.0, 1.0);
  EXPECT_EQ(number_of(state, "row"), 0.0);
  EXPECT_THAT(said(expected, kelvin_run(300.0, 500.0, 0.0, 0.001)),
              Contains(HasSubstr("the trajectory has changed")));
  Series without = expected;
  without.positions.clear();
  Series elsewhere = kelvin_run(300.0, 500.0, 0.0, 0.001);
  elsewhere.positions.clear();
  EXPECT_THAT(said(without, elsewhere, {.trajectory_changed = true}),
              Contains(HasSubstr("the trajectory has changed")));
}

TEST(Diagnose, SaysThatItDoesNotKnowAndWhatComesNearest) {
  const auto odd = changed([](double f, std::size_t i) {
    return 1.3 * f + 0.4 * std::pow(std::sin(2e-3 * static_cast<double>(i)), 3);
  });
  const Diagnosis diagnosis = diagnose(run_of(strokes()), run_of(odd));
  EXPECT_FALSE(diagnosis.explained);
  EXPECT_THAT(diagnosis.names, IsEmpty());
  ASSERT_EQ(diagnosis.guesses.size(), 2U);
  EXPECT_THAT(sentences_of(diagnosis, run_of(odd)),
              ElementsAre(AllOf(StartsWith("unexplained; the nearest are: "), HasSubstr("1.3"),
                                HasSubstr("% of the difference"))));
}

TEST(Diagnose, TakesNoSpikeOnASteadyForceForAnotherRate) {
  const std::vector<double> steady(1000, 2.0);
  std::vector<double> spiked = steady;
  spiked[500] = 2.5;
  EXPECT_THAT(sentences_of(diagnose(run_of(steady), run_of(spiked)), run_of(steady)),
              ElementsAre("a spike of +0.5 N at tick 500"));
}

TEST(Diagnose, CallsTheLastDigitsRounding) {
  EXPECT_THAT(said(changed([](double f, std::size_t) { return std::nextafter(f, 9.0); })),
              ElementsAre("the last digits alone"));
  EXPECT_THAT(said(strokes()), IsEmpty());
  EXPECT_THAT(said(changed([](double f, std::size_t i) { return i == 30 ? std::nan("") : f; })),
              Contains("not finite from row 30, 1 row"));
}

}  // namespace
}  // namespace kerf::compare

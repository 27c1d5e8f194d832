#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/identification/excitation.h>
#include <kerf/identification/identify.h>

namespace kerf::identification {
namespace {

struct Device {
  AxisModel axis;
  double step_m = 1e-5;
  double saturation_n = 100.0;
  double play_m = 0.0;
  double cogging_n = 0.0;
  double jitter_s = 0.0;  ///< a change that comes d late changes the speed by -d Du / m
};

/// Four stretches of three periods and two for validation, of 1 N, a spring of 20 N/m centring the axis.
Experiment measured(const Device& device, double peak_n = 1.0) {
  constexpr std::size_t length = 1000;
  constexpr std::size_t periods = 3;
  Experiment experiment;
  const AxisSimulation simulation(device.axis, 1e-3);
  Motion motion;
  double seen = 0.0;
  std::vector<double> acting;
  std::mt19937_64 engine(9);
  for (std::size_t stretch = 0; stretch < 6; ++stretch) {
    const Excitation excitation = make_excitation({.seed = 11 + stretch});
    experiment.lines = excitation.excited;
    experiment.stretches.push_back({.begin = experiment.data.position_m.size(),
                                    .period = length,
                                    .periods = periods,
                                    .validates = stretch >= 4});
    for (std::size_t n = 0; n < length * periods; ++n) {
      seen =
          std::clamp(seen, motion.position_m - 0.5 * device.play_m, motion.position_m + 0.5 * device.play_m);
      const double read = device.step_m * std::round(seen / device.step_m);
      const double force = peak_n * excitation.force[n % length];
      experiment.data.position_m.push_back(read);
      experiment.excitation_n.push_back(force);
      experiment.data.commanded_n.push_back(force - 20.0 * read);
      acting.push_back(
          std::clamp(experiment.data.commanded_n.back(), -device.saturation_n, device.saturation_n) +
          device.cogging_n * std::sin(2.0 * 3.14159265358979 * motion.position_m / 2e-3));
      motion = simulation.after(motion, acting, acting.size() - 1);
      const auto delay = static_cast<std::size_t>(device.axis.delay_s / 1e-3);
      if (device.jitter_s > 0.0 && acting.size() > delay + 1 && motion.speed_m_s != 0.0) {
        const std::size_t changed = acting.size() - 1 - delay;
        // Uniform, of the standard deviation that was asked for.
        const double share = static_cast<double>(engine() >> 11U) * 0x1p-53 - 0.5;
        const double late_s = std::sqrt(12.0) * device.jitter_s * share;
        motion.speed_m_s -= late_s * (acting[changed] - acting[changed - 1]) / device.axis.mass_kg;
      }
    }
  }
  return experiment;
}

const AxisModel usual{.mass_kg = 0.12,
                      .viscous_n_s_per_m = 0.6,
                      .coulomb_n = 0.15,
                      .stiffness_n_per_m = 0.0,
                      .offset_n = -0.08,
                      .delay_s = 1.63e-3};

void expect_within(const Value& value, double truth) {
  const double half = 0.5 * (value.upper - value.lower);
  EXPECT_NEAR(value.value, truth, 1.5 * half);
  EXPECT_LT(half, 0.05 * std::abs(truth));
}

TEST(Identify, FindsMassFrictionDelayAndAConstantForceBehindAnEncoder) {
  const Identified found = identify(measured({.axis = usual}));
  expect_within(*found.mass_kg, 0.12);
  expect_within(*found.viscous_n_s_per_m, 0.6);
  expect_within(*found.coulomb_n, 0.15);
  expect_within(*found.delay_s, 1.63e-3);
  expect_within(found.offset_n[0], -0.08);
  EXPECT_NEAR(*found.encoder_step_m, 1e-5, 1e-12);
  EXPECT_EQ(found.fits, true);
  EXPECT_TRUE(found.why_not.empty());
  EXPECT_LT(found.validation_error, 0.01);
  // What is left is the encoder's rounding.
  EXPECT_NEAR(found.time.rms_m, 1e-5 / std::sqrt(12.0), 0.1e-5 / std::sqrt(12.0));
  for (const Agreement& of : found.agreements) {
    if (of.name != "mass" && of.name != "delay") continue;
    EXPECT_TRUE(of.agrees) << of.name << " " << of.difference;
  }
}

TEST(Identify, SaysThatPlayIsNotInTheModel) {
  const Identified found = identify(measured({.axis = usual, .play_m = 2e-4}));
  EXPECT_EQ(found.fits, false);
  ASSERT_FALSE(found.explanations.empty());
  EXPECT_EQ(found.missing, Missing::backlash);
}

TEST(Identify, SaysThatCoggingIsNotInTheModelAndHowLargeItIs) {
  const Identified found = identify(measured({.axis = usual, .cogging_n = 0.1}));
  EXPECT_EQ(found.fits, false);
  ASSERT_EQ(found.explanations.front().missing, Missing::cogging);
  EXPECT_NEAR(found.explanations.front().size, 0.1, 0.03);
  EXPECT_NEAR(found.explanations.front().period_m, 2e-3, 1e-4);
}

TEST(Identify, FindsTheJitterOfTheDelayAndNoneWhereThereIsNone) {
  const Identified steady = identify(measured({.axis = usual}));
  EXPECT_EQ(steady.jitter_s->lower, 0.0);
  EXPECT_LT(steady.jitter_s->upper, 30e-6);
  const Identified late = identify(measured({.axis = usual, .jitter_s = 100e-6}));
  const double half = 0.5 * (late.jitter_s->upper - late.jitter_s->lower);
  EXPECT_NEAR(late.jitter_s->value, 100e-6, 1.5 * half);
  EXPECT_LT(half, 25e-6);
  EXPECT_EQ(late.fits, true);
}

TEST(Identify, FindsTheForceBeyondWhichNothingMoreActs) {
  const Identified found = identify(measured({.axis = usual, .saturation_n = 0.6}));
  ASSERT_TRUE(found.saturation_n);
  EXPECT_NEAR(found.saturation_n->value, 0.6, 0.006);
  expect_within(*found.saturation_n, 0.6);
  EXPECT_EQ(found.fits, true);
  expect_within(*found.mass_kg, 0.12);
  expect_within(found.offset_n[0], -0.08);
}

TEST(Identify, SaysWhatWouldBeNeededWhereTheAxisHardlyMoves) {
  try {
    (void)identify(measured({.axis = usual}, 0.1));
    FAIL() << "it sticks under 0.1 N";
  } catch (const std::invalid_argument& why) {
    EXPECT_NE(std::string(why.what()).find("--max-force"), std::string::npos) << why.what();
  }
}

TEST(EncoderStep, IsTheGreatestStepOfWhichAllReadingsAreMultiples) {
  EXPECT_NEAR(*encoder_step(std::vector<double>{0.0, 4e-5, 10e-5, 6e-5}), 2e-5, 1e-15);
  EXPECT_FALSE(encoder_step(std::vector<double>{0.0, 0.0, 0.0}));
  std::mt19937_64 engine(3);
  std::vector<double> smooth(100);
  for (double& value : smooth) value = static_cast<double>(engine() >> 11U) * 0x1p-53;
  EXPECT_FALSE(encoder_step(smooth));
}

TEST(LocalStep, IsWhatLiesBetweenNeighbouringReadingsOfALeverThatChanges) {
  // x = 0.1 sin(1e-3 n): a step of 0.1 mm in the middle, of 0.1 cos(0.1) mm at the ends.
  std::vector<double> readings;
  for (int tick = 0; tick < 4000; ++tick) {
    const double count = std::round(100.0 * std::sin(0.01 * tick));
    readings.push_back(0.1 * std::sin(1e-3 * count));
  }
  EXPECT_FALSE(encoder_step(readings));
  const Value step = local_step(readings).value();
  EXPECT_NEAR(step.value, 1e-4, 0.005e-4);
  EXPECT_LE(step.lower, 1.001e-4 * std::cos(0.1));
  EXPECT_NEAR(step.upper, 1e-4, 1e-7);
}

TEST(LocalStep, IsNoneOfNoiseAndOfFewReadings) {
  std::mt19937_64 engine(3);
  std::vector<double> noise(1000);
  for (double& value : noise) value = static_cast<double>(engine() >> 11U) * 0x1p-53;
  EXPECT_FALSE(local_step(noise));
  EXPECT_FALSE(local_step(std::vector<double>{0.0, 1e-5, 2e-5, 3e-5}));
}

TEST(Identify, FindsTheStepOfAnEncoderWhoseMiddleIsNoMultipleOfIt) {
  Experiment experiment = measured({.axis = usual});
  // Before the stretches, where an axis is brought to its place, positions are from another origin.
  constexpr std::size_t before = 50;
  AxisData& data = experiment.data;
  data.position_m.insert(data.position_m.begin(), before, 0.1234567);
  data.commanded_n.insert(data.commanded_n.begin(), before, 0.0);
  experiment.excitation_n.insert(experiment.excitation_n.begin(), before, 0.0);
  for (Stretch& stretch : experiment.stretches) stretch.begin += before;
  EXPECT_NEAR(identify(experiment).encoder_step_m.value_or(0.0), 1e-5, 1e-12);
}

}  // namespace
}  // namespace kerf::identification

#include "session/blind_rendering.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/psychophysics/random.h>

#include "support/allocation_counter.h"
#include "support/example_laws.h"

namespace kerf::bench {
namespace {

constexpr double period_s = 1e-3;
constexpr double exactly = 1e-12;

/// A law whose force is that of its parallel spring alone, but for `arm` [N/rad] that relaxes within seconds.
LawRendering spring(double stiffness, double arm = 1e-9) {
  const std::array values{stiffness, arm, arm};
  return {models::Law::make("kelvin", values), {.position = 0.0, .direction = -1.0}, {0}};
}

drivers::Sample at(double penetration) {
  drivers::Sample sample;
  sample.position[0] = -penetration;
  return sample;
}

TrialRendering trial_of(std::vector<LawRendering> laws, std::array<std::uint8_t, max_slots> law_of,
                        std::size_t slots = 2) {
  TrialRendering trial{.laws = std::move(laws), .gains = {1.0, 1.0}, .slots = slots, .law_of = law_of};
  trial.trace.resize(20'000);
  return trial;
}

/// One tick as the loop does it.
double tick(BlindRendering& rendering, double penetration = 0.1, std::uint32_t* flags = nullptr) {
  const Command command = rendering(at(penetration), period_s);
  rendering.record({.force_commanded = command.force, .flags = command.flags});
  if (flags != nullptr) *flags = command.flags;
  return command.force[0];
}

std::vector<double> ticks(BlindRendering& rendering, int count) {
  std::vector<double> forces;
  for (int i = 0; i < count; ++i) forces.push_back(tick(rendering));
  return forces;
}

TEST(BlindRendering, IsWithoutForceUntilASlotPlays) {
  BlindRendering rendering(0.1, SwitchKind::blend);
  EXPECT_EQ(tick(rendering), 0.0);
  TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, {0, 1});
  rendering.begin(trial);
  EXPECT_EQ(tick(rendering), 0.0);
  rendering.play(0);
  const auto forces = ticks(rendering, 100);
  EXPECT_NEAR(forces[49], 0.5, 1e-9) << "half way";
  EXPECT_NEAR(forces[99], 1.0, 1e-9);
}

TEST(BlindRendering, SwitchesAlikeToEitherSample) {
  // The share of the way from the old force to the new one, tick by tick.
  const auto way = [](double first, double second, SwitchKind kind) {
    BlindRendering rendering(0.25, kind);
    TrialRendering trial = trial_of({spring(first), spring(second)}, {0, 1});
    rendering.begin(trial);
    rendering.play(0);
    const double old_force = ticks(rendering, 300).back();
    rendering.play(1);
    auto forces = ticks(rendering, 300);
    const double new_force = forces.back();
    for (double& force : forces) force = (force - old_force) / (new_force - old_force);
    return forces;
  };
  const auto up = way(10.0, 30.0, SwitchKind::blend);
  const auto down = way(30.0, 10.0, SwitchKind::blend);
  for (std::size_t i = 0; i < up.size(); ++i) ASSERT_NEAR(up[i], down[i], exactly) << i;
  EXPECT_NEAR(up[124], 0.5, 1e-9);
  EXPECT_NEAR(up[249], 1.0, exactly) << "and takes as long as was said";
}

TEST(BlindRendering, FlagsASwitchToTheSameLawLikeAnyOther) {
  // X is A: the force stays as it is, and everything else of the switch is there.
  for (const auto& law_of : {std::array<std::uint8_t, max_slots>{0, 1, 0}, {0, 1, 1}}) {
    BlindRendering rendering(0.05, SwitchKind::blend);
    TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, law_of, 3);
    rendering.begin(trial);
    rendering.play(0);
    (void)ticks(rendering, 100);
    rendering.play(2);
    int flagged = 0;
    for (int i = 0; i < 100; ++i) {
      std::uint32_t flags = 0;
      (void)tick(rendering, 0.1, &flags);
      flagged += (flags & schema::flag_soft_switch) != 0 ? 1 : 0;
    }
    EXPECT_EQ(flagged, 49);
  }
}

TEST(BlindRendering, GoesThroughZeroWhereAsked) {
  BlindRendering rendering(0.1, SwitchKind::through_zero);
  TrialRendering trial = trial_of({spring(10.0), spring(10.0)}, {0, 1});
  rendering.begin(trial);
  rendering.play(0);
  (void)ticks(rendering, 100);
  rendering.play(1);
  const auto forces = ticks(rendering, 100);
  EXPECT_NEAR(forces[49], 0.0, 1e-9) << "between two equal samples too";
  EXPECT_NEAR(forces[99], 1.0, 1e-9);
}

TEST(BlindRendering, HasNoStepWhereverItIsSwitched) {
  psychophysics::Random random(5);
  BlindRendering rendering(0.25, SwitchKind::blend);
  TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, {0, 1, 0}, 3);
  rendering.begin(trial);
  double last = 0.0;
  for (int i = 0; i < 5000; ++i) {
    if (random.chance(0.05)) rendering.play(random.below(3));
    if (random.chance(0.01)) rendering.play(std::nullopt);
    const double force = tick(rendering);
    // The weights go over in a ramp of 250 ticks from wherever they are, between 0 and 3 N.
    ASSERT_LE(std::abs(force - last), 3.0 / 250.0 + exactly) << i;
    last = force;
  }
}

TEST(BlindRendering, ComputesEveryLawWhicheverPlays) {
  // A law that was not felt knows the path nevertheless: its arm has relaxed as if it had been.
  const auto last_of = [](std::size_t first) {
    BlindRendering rendering(0.0, SwitchKind::blend);
    TrialRendering trial = trial_of({spring(10.0, 5.0), spring(20.0, 7.0)}, {0, 1});
    rendering.begin(trial);
    rendering.play(first);
    (void)ticks(rendering, 700);
    rendering.play(1);
    return tick(rendering);
  };
  EXPECT_EQ(last_of(0), last_of(1));
}

TEST(BlindRendering, MakesTheForceZeroForAllWhereALawFails) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t playing : {0U, 1U}) {
    BlindRendering rendering(0.0, SwitchKind::blend);
    TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, {0, 1});
    rendering.begin(trial);
    rendering.play(playing);
    std::uint32_t flags = 0;
    (void)tick(rendering, nan, &flags);
    EXPECT_NE(flags & schema::flag_law_fault, 0U);
  }
}

TEST(BlindRendering, LetsATrialGoOnceItsForceIsZero) {
  BlindRendering rendering(0.1, SwitchKind::blend);
  TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, {0, 1});
  EXPECT_TRUE(rendering.idle());
  rendering.begin(trial);
  rendering.play(1);
  (void)ticks(rendering, 150);
  rendering.end();
  (void)ticks(rendering, 99);
  EXPECT_FALSE(rendering.idle());
  EXPECT_NEAR(tick(rendering), 0.0, exactly);
  EXPECT_TRUE(rendering.idle());
  ASSERT_EQ(trial.rows, 250U) << "and every tick of it is in its trace";
  EXPECT_EQ(trial.trace[100].slot, 1);
  EXPECT_EQ(trial.trace[240].slot, 255) << "no slot";
  EXPECT_NEAR(trial.trace[149].row.force_commanded[0], 3.0, 1e-9);
}

TEST(BlindRendering, ForgetsNoForceFromTheTrialBefore) {
  BlindRendering rendering(0.1, SwitchKind::blend);
  TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, {0, 1});
  rendering.begin(trial);
  rendering.play(1);
  (void)ticks(rendering, 50);
  rendering.end();
  (void)ticks(rendering, 200);
  trial.rows = 0;
  rendering.begin(trial);
  EXPECT_EQ(tick(rendering), 0.0);
}

/// What ticks of the second slot cost, in those of the first, each at its quickest: whatever else the machine
/// does can only add.
template <typename Play, typename Tick>
double ratio_of_costs(Play play, Tick tick_of) {
  const auto cost = [&](std::size_t slot) {
    play(slot);
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 50; ++i) {
      const volatile double force = tick_of(at(0.1 + 1e-4 * i));
      (void)force;
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::array quickest_s{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int round = 0; round < 1000; ++round) {
    for (std::size_t slot = 0; slot < 2; ++slot) quickest_s[slot] = std::min(quickest_s[slot], cost(slot));
  }
  return quickest_s[1] / quickest_s[0];
}

TEST(BlindRendering, CostsTheSameWhicheverPlays) {
  const LawRendering dear(test::example("scissors_mesh"), {.position = 0.0, .direction = -1.0}, {0, 1});
  std::array alone{spring(10.0), dear};
  std::size_t felt = 0;
  // No durations, but ratios within one run.
  ASSERT_GT(
      ratio_of_costs([&](std::size_t slot) { felt = slot; },
                     [&](const drivers::Sample& sample) { return alone[felt](sample, period_s).force[0]; }),
      3.0)
      << "alone the two laws can be told apart";
  BlindRendering rendering(0.0, SwitchKind::blend);
  TrialRendering trial = trial_of({spring(10.0), dear}, {0, 1});
  rendering.begin(trial);
  EXPECT_NEAR(
      ratio_of_costs([&](std::size_t slot) { rendering.play(slot); },
                     [&](const drivers::Sample& sample) { return rendering(sample, period_s).force[0]; }),
      1.0, 0.1);
}

/// A standard linear solid, whose arm relaxes in a second.
LawRendering kelvin() {
  return {test::example("kelvin"), {.position = 0.0, .direction = -1.0}, std::vector<std::size_t>{0}};
}

TEST(BlindRendering, BeginsLawsAnewInTheMiddleOfASwitchIfAskedTo) {
  for (const bool anew : {false, true}) {
    BlindRendering rendering(0.1, SwitchKind::through_zero);
    TrialRendering trial = trial_of({kelvin(), spring(30.0)}, {0, 1});
    if (anew) trial.fresh = trial.laws;
    rendering.begin(trial);
    rendering.play(0);
    for (int i = 0; i < 200; ++i) (void)tick(rendering, 0.002 * i);
    rendering.play(1);
    for (int i = 0; i < 200; ++i) (void)tick(rendering, 0.4);
    rendering.play(0);
    LawRendering fresh = kelvin();
    double force = 0.0;
    double alone = 0.0;
    bool was_zero = false;
    for (int i = 0; i < 150; ++i) {
      force = tick(rendering, 0.4);
      was_zero = was_zero || force == 0.0;
      if (anew ? was_zero : i >= 50) alone = fresh(at(0.4), period_s).force[0];
    }
    EXPECT_EQ(was_zero, anew);
    EXPECT_EQ(force == alone, anew) << force << " and of one that begins there " << alone;
  }
}

TEST(BlindRendering, WaitsInASwitchUntilTheToolTouchesNone) {
  BlindRendering rendering(0.1, SwitchKind::through_zero);
  TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, {0, 1});
  trial.fresh = trial.laws;
  trial.touched = {{.contact = {.position = 0.0, .direction = -1.0}},
                   {.contact = {.position = -0.05, .direction = -1.0}}};
  rendering.begin(trial);
  rendering.play(0);
  for (int i = 0; i < 60; ++i) (void)tick(rendering, -0.1);
  for (int i = 0; i < 60; ++i) (void)tick(rendering, 0.1);
  EXPECT_NE(tick(rendering, 0.1), 0.0);
  rendering.play(1);
  for (int i = 0; i < 60; ++i) (void)tick(rendering, 0.1);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(tick(rendering, 0.02), 0.0) << "the first is still touched";
  (void)tick(rendering, -0.1);
  for (int i = 0; i < 60; ++i) (void)tick(rendering, -0.1);
  EXPECT_NE(tick(rendering, 0.1), 0.0);
}

TEST(BlindRendering, BeginsAnewWithoutMemory) {
  BlindRendering rendering(0.05, SwitchKind::through_zero);
  TrialRendering trial = trial_of({kelvin(), spring(30.0)}, {0, 1});
  trial.fresh = trial.laws;
  const test::NoAllocation guard;
  rendering.begin(trial);
  for (int i = 0; i < 400; ++i) {
    if (i % 70 == 0) rendering.play(static_cast<std::size_t>(i / 70 % 2));
    (void)tick(rendering);
  }
}

TEST(BlindRendering, AllocatesNothingInTheTick) {
  BlindRendering rendering(0.05, SwitchKind::blend);
  TrialRendering trial = trial_of({spring(10.0), spring(30.0)}, {0, 1});
  trial.trace.resize(100);  // and a trace that is full changes nothing
  const test::NoAllocation guard;
  rendering.begin(trial);
  for (int i = 0; i < 400; ++i) {
    if (i % 70 == 0) rendering.play(static_cast<std::size_t>(i / 70 % 2));
    (void)tick(rendering);
  }
  rendering.end();
  for (int i = 0; i < 100; ++i) (void)tick(rendering);
}

}  // namespace
}  // namespace kerf::bench

#include "live/live_rendering.h"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/runtime/loop/scripted.h"
#include "loop/law_switch.h"
#include "support/allocation_counter.h"

namespace kerf::bench {
namespace {

constexpr double exactly = 1e-9;

/// A spring of so many N/rad, at a penetration of 0.1 rad.
LawRendering spring(double stiffness) {
  const std::array values{stiffness, 1e-9, 1e-9};
  return {models::Law::make("kelvin", values), {.position = 0.0, .direction = -1.0}, {0}};
}

std::unique_ptr<LawRendering> offered(double stiffness) {
  return std::make_unique<LawRendering>(spring(stiffness));
}

drivers::Sample pressed() { return {.position = {-0.1}}; }

Command next(LiveRendering& live) { return live(pressed(), 1e-3); }

double after(LiveRendering& live, int ticks) {
  double force = 0.0;
  for (int i = 0; i < ticks; ++i) force = next(live).force[0];
  return force;
}

TEST(LiveRendering, GivesNoForceUntilALawIsOffered) {
  LiveRendering live(0.01);
  EXPECT_EQ(after(live, 5), 0.0);
  EXPECT_FALSE(live.is_blending());
}

TEST(LiveRendering, BlendsFromLawToLawAsALawSwitchDoes) {
  LiveRendering live(0.25);
  LawSwitch laws({{.rendering = spring(10.0)}, {.rendering = spring(30.0), .from_s = 1.0}}, 0.25);
  (void)live.offer(offered(10.0));
  (void)after(live, 300);
  for (int tick = 0; tick < 300; ++tick) (void)laws(pressed(), 1e-3);
  for (int tick = 300; tick < 1500; ++tick) {
    if (tick == 1000) (void)live.offer(offered(30.0));
    const Command expected = laws(pressed(), 1e-3);
    const Command command = next(live);
    ASSERT_NEAR(command.force[0], expected.force[0], 1e-12) << tick;
    ASSERT_EQ(command.flags, expected.flags) << tick;
  }
}

TEST(LiveRendering, ComesFromNoLawAndGoesBackToNoneAlongTheSameRamp) {
  LiveRendering live(0.1);
  (void)live.offer(offered(10.0));
  EXPECT_EQ(next(live).force[0], 0.0);
  EXPECT_TRUE(live.is_blending());
  EXPECT_NEAR(after(live, 50), 0.5, exactly) << "half way after half of it";
  EXPECT_NEAR(after(live, 51), 1.0, exactly);
  EXPECT_FALSE(live.is_blending());
  EXPECT_EQ(next(live).flags, 0U);
  (void)live.offer(nullptr);
  EXPECT_NEAR(after(live, 51), 0.5, exactly);
  EXPECT_EQ(next(live).flags, schema::flag_soft_switch);
  EXPECT_EQ(after(live, 60), 0.0);
  EXPECT_EQ(next(live).flags, 0U);
}

TEST(LiveRendering, FinishesABlendBeforeTheNextAndPassesOverWhatWasReplacedMeanwhile) {
  LiveRendering live(0.01);
  (void)live.offer(offered(10.0));
  EXPECT_NEAR(after(live, 12), 1.0, exactly);
  (void)live.offer(offered(30.0));
  (void)after(live, 4);
  (void)live.offer(offered(1000.0));  // 100 N: never felt
  (void)live.offer(offered(50.0));
  double last = after(live, 1);
  for (int i = 0; i < 30; ++i) {
    const double force = next(live).force[0];
    EXPECT_LE(std::abs(force - last), 0.2 + exactly) << "2 N in 10 ticks is the steepest";
    last = force;
  }
  EXPECT_NEAR(last, 5.0, exactly);
}

TEST(LiveRendering, GivesBackWhatIsNoLongerRendered) {
  LiveRendering live(0.01);
  EXPECT_EQ(live.collect(), 0U);
  for (int law = 0; law < 5; ++law) {
    (void)live.offer(offered(10.0));
    (void)after(live, 20);
  }
  EXPECT_EQ(live.collect(), 4U) << "all but the one that is felt";
  EXPECT_EQ(live.collect(), 0U);
  EXPECT_NEAR(after(live, 1), 1.0, exactly);
}

TEST(LiveRendering, TellsInWhichTickALawBeganAndTheForceWasTaken) {
  LiveRendering live(0.01);
  std::vector<LiveChange> changes;
  for (std::uint64_t tick = 0; tick < 100; ++tick) {
    if (tick == 10) {
      EXPECT_EQ(live.offer(offered(10.0)), 1U);
    }
    if (tick == 30) live.release();
    if (tick == 40) live.resume();
    if (tick == 50) {
      EXPECT_EQ(live.offer(nullptr), 2U);
    }
    (void)next(live);
    live.record({.tick = tick, .time_s = 1e-3 * static_cast<double>(tick)});
    for (LiveChange change; live.take_change(change);) changes.push_back(change);
  }
  using Kind = LiveChange::Kind;
  const std::vector<std::uint64_t> ticks{10, 30, 40, 50};
  const std::vector<Kind> kinds{Kind::law, Kind::zero, Kind::resume, Kind::law};
  const std::vector<std::uint64_t> laws{1, 1, 1, 0};
  ASSERT_EQ(changes.size(), 4U);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_EQ(changes[i].tick, ticks[i]);
    EXPECT_EQ(changes[i].kind, kinds[i]);
    EXPECT_EQ(changes[i].law, laws[i]);
    EXPECT_DOUBLE_EQ(changes[i].time_s, 1e-3 * static_cast<double>(ticks[i]));
  }
}

TEST(LiveRendering, KeepsTheForceReleasedOverARestart) {
  LiveRendering live(0.01);
  (void)live.offer(offered(10.0));
  (void)after(live, 20);
  live.release();
  live.restart(0.01);
  EXPECT_TRUE(next(live).is_released);
  live.resume();
  EXPECT_EQ(after(live, 20), 0.0) << "and nothing is left of the law";
}

TEST(LiveRendering, AllocatesNothingInTheTick) {
  LiveRendering live(0.005);
  for (int law = 0; law < 4; ++law) {
    (void)live.offer(law == 2 ? nullptr : offered(10.0));
    const kerf::test::NoAllocation guard;
    for (std::uint64_t tick = 0; tick < 20; ++tick) {
      if (tick == 10) live.release();
      if (tick == 15) live.resume();
      (void)next(live);
      live.record({.tick = tick});
    }
  }
}

/// A loop over a script whose device takes 2 s from 5 N to zero by its slew limit.
struct LiveBench {
  static constexpr double soft_start_s = 0.05;

  explicit LiveBench(LiveRendering& of_rendering) : rendering(of_rendering) {
    device.answer = [this](std::uint64_t tick, drivers::Sample& sample) {
      if (before_tick) before_tick(tick);
      sample.position[0] = -0.1;
      return drivers::Status::ok;
    };
  }

  /// Forces of every tick, for the hand.
  std::vector<double> run(std::uint64_t ticks) {
    test::ScriptedClock clock{script};
    const std::atomic<bool> stop{false};
    std::atomic<std::size_t> done{0};
    Heartbeat heartbeat;
    LoopReport report;
    auto compute = [this](const drivers::Sample& sample, double elapsed_s) noexcept {
      return rendering(sample, elapsed_s);
    };
    run_loop(clock, device, compute, recorder,
             {.ticks = ticks, .safety = {.period_s = test::period_s, .soft_start_s = soft_start_s}},
             {.stop = stop, .done = done, .heartbeat = heartbeat}, report);
    std::vector<double> forces;
    for (const schema::Row& row : recorder.rows) forces.push_back(row.force_commanded[0]);
    return forces;
  }

  LiveRendering& rendering;
  test::Script script;
  test::ScriptedDevice device{script};
  test::ScriptedRecorder recorder{script, {}};
  std::function<void(std::uint64_t)> before_tick;
};

TEST(LiveRendering, ReleasesTheForceInTheVeryNextTickWhateverTheSlewLimitSays) {
  LiveRendering live(0.0);
  LiveBench bench(live);
  (void)live.offer(offered(50.0));
  bench.device.slew_limit(20.0);  // N/s: 5 N take 250 ticks
  bench.before_tick = [&](std::uint64_t tick) {
    if (tick == 500) live.release();  // arrives while tick 500 reads the device, ahead of its computation
    if (tick == 600) live.resume();
  };
  const std::vector<double> force = bench.run(1200);
  EXPECT_NEAR(force[499], 5.0, exactly);
  for (std::size_t tick = 500; tick < 600; ++tick) ASSERT_EQ(force[tick], 0.0) << tick;
  for (std::size_t tick = 1; tick < force.size(); ++tick) {
    if (tick == 500) continue;
    ASSERT_LE(std::abs(force[tick] - force[tick - 1]), 0.02 + exactly)
        << "only zero is sudden: tick " << tick;
  }
  EXPECT_NEAR(force[1199], 5.0, exactly);
}

TEST(LiveRendering, LetsTheForceComeBackAlongTheSoftStart) {
  LiveRendering live(0.0);
  LiveBench bench(live);
  (void)live.offer(offered(50.0));
  bench.before_tick = [&](std::uint64_t tick) {
    if (tick == 200) live.release();
    if (tick == 300) live.resume();
  };
  const std::vector<double> force = bench.run(400);
  EXPECT_EQ(force[299], 0.0);
  EXPECT_NEAR(force[299 + 10], 1.0, exactly) << "a fifth of 5 N after a fifth of 50 ms";
  EXPECT_NEAR(force[299 + 25], 2.5, exactly);
  EXPECT_NEAR(force[299 + 50], 5.0, exactly);
  EXPECT_EQ(bench.recorder.rows[310].flags, schema::flag_soft_start);
  EXPECT_EQ(bench.recorder.rows[360].flags, 0U);
}

TEST(LiveRendering, StaysReleasedThroughABlend) {
  LiveRendering live(0.05);
  LiveBench bench(live);
  (void)live.offer(offered(50.0));
  bench.before_tick = [&](std::uint64_t tick) {
    if (tick == 200) live.release();
    if (tick == 210) (void)live.offer(offered(30.0));
  };
  const std::vector<double> force = bench.run(400);
  for (std::size_t tick = 200; tick < 400; ++tick) ASSERT_EQ(force[tick], 0.0) << tick;
}

}  // namespace
}  // namespace kerf::bench

#include "probe/probe.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "loop/clock.h"
#include "loop/loop.h"

namespace kerf::bench {
namespace {

const std::atomic<bool> never{false};

/// A device whose motors do other than was asked.
class Miswired final : public drivers::Device {
 public:
  using Wiring = std::function<drivers::Axes(const drivers::Axes&)>;
  Miswired(const std::string& uri, Wiring wiring)
      : device_(drivers::open_device(uri)), wiring_(std::move(wiring)) {}

  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return device_->info(); }
  [[nodiscard]] drivers::Status read(double now_s, drivers::Sample& sample) noexcept override {
    return device_->read(now_s, sample);
  }
  [[nodiscard]] drivers::Status write(const drivers::Axes& force) noexcept override {
    return device_->write(wiring_(force));
  }
  void release(double at_s) noexcept override { device_->release(at_s); }

 private:
  std::unique_ptr<drivers::Device> device_;
  Wiring wiring_;
};

/// What a probe did to a device.
struct Probed {
  std::vector<ProbedAxis> axes;
  bool finished = false;
  drivers::Axes most_force{};
  drivers::Axes farthest{};  ///< from the place where the push began, while there was force
};

Probed probe(drivers::Device& device) {
  ProbeRendering rendering(device.info());
  struct Pushes {
    ProbeRendering& rendering;
    Command operator()(const drivers::Sample& sample, double elapsed_s) noexcept {
      return rendering.step(sample, elapsed_s);
    }
    [[nodiscard]] bool finished() const noexcept { return rendering.finished(); }
  } pushes{rendering};
  struct Rows {
    ProbeRendering& rendering;
    Probed& seen;
    drivers::Axes begin{};
    void push(const schema::Row& row) noexcept {
      rendering.see(row);
      const bool is_pushed = std::ranges::any_of(row.force_commanded, [](double one) { return one != 0.0; });
      if (!is_pushed) begin = row.position;
      for (std::size_t axis = 0; axis < begin.size(); ++axis) {
        seen.most_force[axis] = std::max(seen.most_force[axis], std::abs(row.force_commanded[axis]));
        seen.farthest[axis] = std::max(seen.farthest[axis], std::abs(row.position[axis] - begin[axis]));
      }
    }
  };
  Probed seen;
  Rows rows{rendering, seen};
  VirtualClock clock;
  Heartbeat heartbeat;
  std::atomic<std::size_t> done{0};
  LoopReport report;
  run_loop(clock, device, pushes, rows,
           {.ticks = static_cast<std::uint64_t>(1e3 * rendering.longest_s()), .safety = {}},
           {.stop = never, .done = done, .heartbeat = heartbeat}, report);
  seen.axes = rendering.probed();
  seen.finished = rendering.finished();
  return seen;
}

std::vector<PushVerdict> verdicts_of(const std::vector<ProbedAxis>& axes) {
  std::vector<PushVerdict> verdicts;
  for (const ProbedAxis& probed : axes) verdicts.push_back(probed.judgement.verdict);
  return verdicts;
}

TEST(Probe, FindsEverySimulatedDeviceRightInItsHand) {
  for (const char* uri : {"sim:scissors", "sim:pose6", "sim:premium"}) {
    for (int seed = 1; seed <= 5; ++seed) {
      const ProbeResult result = probe_device(std::string(uri) + "?seed=" + std::to_string(seed), {}, never);
      EXPECT_TRUE(result.finished) << uri;
      EXPECT_EQ(result.axes.size(), result.device.axes.size()) << uri;
      EXPECT_TRUE(result.all_right()) << uri << " seed " << seed << '\n'
                                      << testing::PrintToString(probe_lines(result));
    }
  }
}

drivers::Axes inverted(const drivers::Axes& force) {
  drivers::Axes other{};
  for (std::size_t axis = 0; axis < force.size(); ++axis) other[axis] = -force[axis];
  return other;
}

TEST(Probe, FindsInvertedMotorsOnEveryAxis) {
  for (const char* uri : {"sim:scissors", "sim:pose6", "sim:premium"}) {
    Miswired device(uri, inverted);
    const Probed probed = probe(device);
    EXPECT_TRUE(probed.finished) << uri;
    EXPECT_THAT(verdicts_of(probed.axes), testing::Each(PushVerdict::wrong)) << uri;
  }
}

TEST(Probe, FindsTheOneInvertedMotor) {
  Miswired device("sim:pose6", [](drivers::Axes force) {
    force[1] = -force[1];
    return force;
  });
  using enum PushVerdict;
  EXPECT_THAT(verdicts_of(probe(device).axes),
              testing::ElementsAre(right, wrong, right, right, right, right));
}

TEST(Probe, FindsExchangedMotorsAndSaysWhichAxisMoves) {
  Miswired device("sim:pose6", [](drivers::Axes force) {
    std::swap(force[0], force[2]);
    return force;
  });
  const Probed probed = probe(device);
  using enum PushVerdict;
  EXPECT_THAT(verdicts_of(probed.axes), testing::ElementsAre(wrong, right, wrong, right, right, right));
  EXPECT_EQ(probed.axes[0].judgement.instead, 2U);
  EXPECT_EQ(probed.axes[2].judgement.instead, 0U);
}

TEST(Probe, PassesOverAnAxisWithoutAMotor) {
  drivers::DeviceInfo info = drivers::open_device("sim:pose6")->info();
  info.axes[1].force_limit = 0.0;
  std::vector<std::size_t> axes;
  const ProbeRendering rendering(info);
  for (const ProbedAxis& probed : rendering.probed()) axes.push_back(probed.axis);
  EXPECT_THAT(axes, testing::ElementsAre(0U, 2U, 3U, 4U, 5U));
}

TEST(Probe, PushesNoFartherAndNoHarderThanItSays) {
  struct Case {
    const char* uri;
    double share;  ///< of the bound
  };
  // A hand that holds still, and none at all: that handle also goes on from the push before, as far again.
  for (const Case& one : {Case{"sim:pose6?reach=0m&swing=0deg", 1.1}, Case{"sim:pose6?hand=off", 2.0}}) {
    for (const bool is_inverted : {false, true}) {
      Miswired device(one.uri,
                      [&](const drivers::Axes& force) { return is_inverted ? inverted(force) : force; });
      const Probed probed = probe(device);
      EXPECT_THAT(verdicts_of(probed.axes),
                  testing::Each(is_inverted ? PushVerdict::wrong : PushVerdict::right))
          << one.uri;
      for (std::size_t axis = 0; axis < 6; ++axis) {
        const bool is_torque = axis >= 3;
        const double bound = (is_torque ? 0.1 : 0.01) * (is_inverted ? 0.4 : 1.0);
        EXPECT_GT(probed.most_force[axis], 0.0);
        EXPECT_LE(probed.most_force[axis], (is_torque ? 0.05 : 0.85) + 1e-12) << one.uri;
        EXPECT_LE(probed.farthest[axis], one.share * bound) << one.uri << ' ' << axis;
      }
    }
  }
}

TEST(Probe, KnowsNothingOfAnAxisThatIsHeldFirmly) {
  Miswired device("sim:pose6?reach=0m&grip=500N/m", [](drivers::Axes force) {
    force[2] = 0.0;
    return force;
  });
  const Probed probed = probe(device);
  EXPECT_EQ(probed.axes[2].judgement.verdict, PushVerdict::unknown);
  EXPECT_EQ(probed.axes[2].pushes, 2 * most_push_pairs);
  EXPECT_EQ(probed.axes[1].judgement.verdict, PushVerdict::right);
}

}  // namespace
}  // namespace kerf::bench

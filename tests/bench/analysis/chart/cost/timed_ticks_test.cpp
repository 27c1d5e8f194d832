#include "chart/cost/timed_ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/models/scissors_mesh.h>

#include "laws/law_file.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::IsSupersetOf;

TEST(CountedTicks, AreThoseWithAForceAndTheTenMillisecondsAboutThem) {
  std::vector<std::uint8_t> pushes(20, 0);
  pushes[9] = 1;
  const std::vector<double> periods(20, 4e-3);
  EXPECT_THAT(counted_ticks(pushes, periods), ElementsAre(7, 8, 9, 10, 11)) << "8 ms before and after";
}

TEST(CountedTicks, AreAllOfALawThatNeverPushes) {
  const std::vector<std::uint8_t> pushes(3, 0);
  EXPECT_THAT(counted_ticks(pushes, std::vector<double>(3, 1e-3)), ElementsAre(0, 1, 2));
}

/// Cuts of a small mesh: x_s goes forward, theta closes and opens.
SampledMotion cuts(std::size_t ticks) {
  SampledMotion path = ticks_at(1000.0, ticks);
  for (std::size_t i = 0; i < ticks; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    const double phase = 2.0 * std::acos(-1.0) * t;
    path.sample[i].position = {0.35 + 0.25 * std::cos(phase), 2e-3 * t};
    path.sample[i].velocity = {-0.25 * 2.0 * std::acos(-1.0) * std::sin(phase), 2e-3};
  }
  return path;
}

TEST(CountedTicks, HoldThoseOnWhichAMeshIsSplit) {
  const LawFile file =
      read_law_file(std::filesystem::path(KERF_SOURCE_DIR) / "examples/scissors_mesh.law.toml");
  const SampledMotion path = cuts(4000);
  const TimedLaw timed{LawRendering(file.law, file.contact, {0, 1}), &path};
  const TimedTicks ticks(timed);
  const auto law = models::ScissorsMesh::make(file.law.values(), file.law.options());
  auto state = law.initial_state();
  LawRendering rendering = timed.rendering;
  std::vector<std::size_t> split;
  bool split_without_force = false;
  for (std::size_t i = 0; i < path.ticks(); ++i) {
    const std::uint32_t before = state.cuts;
    (void)law.step(state, path.sample[i], path.period_s[i]);
    const Command command = rendering(path.sample[i], path.period_s[i]);
    if (state.cuts == before) continue;
    split.push_back(i);
    split_without_force = split_without_force || (command.force[0] == 0.0 && command.force[1] == 0.0);
  }
  ASSERT_TRUE(split_without_force) << "splitting costs, and nothing is felt on that tick";
  EXPECT_THAT(ticks.counted(), IsSupersetOf(split));
  EXPECT_LT(ticks.counted().size(), path.ticks()) << "and the scissors are open at times";
}

}  // namespace
}  // namespace kerf::bench

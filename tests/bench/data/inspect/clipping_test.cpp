#include "inspect/clipping.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bench/data/inspect/blocked.h"

namespace kerf::bench {
namespace {

/// Ten pushes at 1 kHz against a spring, with noise.
struct Pushes {
  std::vector<double> position, force;

  explicit Pushes(double noise) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < 10'000; ++i) {
      position.push_back(0.5 - 0.5 * std::cos(2e-3 * 3.14159265358979 * static_cast<double>(i)));
      force.push_back(5.0 * position.back() + noise * normal(random));
    }
  }
  [[nodiscard]] EndsOfRange ends() const {
    const auto [least, most] = std::ranges::minmax(force);
    return ends_of_range(test::blocked(force), least, most, test::blocked(position), 1e-6);
  }
};

TEST(Clipping, IsSeenWithItsRows) {
  Pushes pushes(0.01);
  std::size_t over = 0;
  for (double& force : pushes.force) {
    over += force >= 4.0 ? 1 : 0;
    force = std::min(force, 4.0);
  }
  const EndsOfRange ends = pushes.ends();
  EXPECT_EQ(ends.most.is_clipped, true);
  EXPECT_EQ(ends.least.is_clipped, false);
  EXPECT_EQ(ends.most.rows, over);
  EXPECT_EQ(ends.most.runs, 10U);
  ASSERT_EQ(ends.most.first_runs.size(), 10U);
  EXPECT_NEAR(static_cast<double>(ends.most.first_runs[0].begin), 352.0, 10.0)
      << "acos(-0.6) / pi of 500 rows";
  EXPECT_NEAR(static_cast<double>(ends.most.first_runs[0].end), 648.0, 10.0);
}

TEST(Clipping, IsSeenAtTheLowerEndToo) {
  Pushes pushes(0.01);
  for (double& force : pushes.force) force = -std::min(force, 4.0);
  EXPECT_EQ(pushes.ends().least.is_clipped, true);
  EXPECT_EQ(pushes.ends().most.is_clipped, false);
}

TEST(Clipping, IsNoneInASensorThatIsWithinItsRange) { EXPECT_EQ(Pushes(0.01).ends().most.is_clipped, false); }

// Steps of 1 N: it stands anywhere as long as at the top, or nearly.
TEST(Clipping, IsNoneInAQuietSensorWithCoarseSteps) {
  Pushes pushes(0.0);
  for (double& force : pushes.force) force = std::round(force);
  const EndsOfRange ends = pushes.ends();
  EXPECT_GE(ends.most.longest, 100U);
  EXPECT_EQ(ends.most.is_clipped, false);
}

TEST(Clipping, IsNoneAtZero) {
  Pushes pushes(0.01);
  for (double& force : pushes.force) force = std::max(force - 2.0, 0.0);
  const EndsOfRange ends = pushes.ends();
  EXPECT_GE(ends.least.longest, 300U);
  EXPECT_EQ(ends.least.is_clipped, false);
}

TEST(Clipping, IsNotKnownWhereTheToolStandsStill) {
  Pushes pushes(0.01);
  for (std::size_t i = 400; i < 600; ++i) {
    pushes.position[i] = 1.0;
    pushes.force[i] = 6.0;
  }
  EXPECT_EQ(pushes.ends().most.is_clipped, std::nullopt);
}

}  // namespace
}  // namespace kerf::bench

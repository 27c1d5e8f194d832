#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <kerf/drivers/device.h>

#include "device_model/kept_models.h"
#include "stability/device/sampled_device.h"
#include "stability/wall/wall_theory.h"
#include "support/device_models.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

/// Whether a two-sided wall on a device rings for longer and longer after a push.
bool rings(const std::string& uri, double stiffness_n_per_m) {
  const auto device = drivers::open_device(uri);
  constexpr int ticks = 2000;
  double early_m = 0.0;
  double late_m = 0.0;
  for (int n = 0; n < ticks; ++n) {
    drivers::Sample sample;
    (void)device->read(1e-3 * n, sample);
    const double push_n = n < 5 ? 0.5 : 0.0;
    (void)device->write({push_n - stiffness_n_per_m * sample.position[0]});
    const double away_m = std::abs(sample.position[0]);
    if (away_m > 1.0) return true;
    if (n > ticks / 4 && n <= ticks / 2) early_m = std::max(early_m, away_m);
    if (n > 3 * ticks / 4) late_m = std::max(late_m, away_m);
  }
  return late_m > early_m;
}

double boundary(const std::string& uri) {
  double stable = 10.0;
  double unstable = 10000.0;
  while (unstable - stable > 1e-4 * unstable) {
    const double middle = 0.5 * (stable + unstable);
    (rings(uri, middle) ? unstable : stable) = middle;
  }
  return stable;
}

// Neither a limit nor a stop ends what grows.
const std::string quiet = "&noise=off&encoder=off&hand=off&limit=100000N&range=100m";

TEST(RehearsedDevice, IsStableUpToTheEigenvaluesAndAsTheSameNumbersByHand) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "x.device.toml").string();
  write_model_file(file, test::model_of("sim:axis"));
  const std::string rehearsed = "sim:axis?model=" + file + quiet;
  const double found = boundary(rehearsed);
  EXPECT_EQ(found, boundary("sim:axis?mass=0.08kg&viscous=2Ns/m&coulomb=0N&delay=1.3ms" + quiet));
  const SampledDevice device = sampled_device(drivers::open_device(rehearsed)->info(), 0, 1000.0);
  EXPECT_EQ(device.delay_s, 1.3e-3);
  EXPECT_NEAR(found / eigenvalue_boundary(device, 0.0, 10.0, 10000.0), 1.0, 2e-3);
}

TEST(RehearsedDevice, IsStableToLessTheLaterItsForcesCome) {
  const auto late = [&](const std::string& ticks) {
    return boundary("sim:axis?mass=0.08kg&viscous=2Ns/m&coulomb=0N&delay=" + ticks + "ticks" + quiet);
  };
  SampledDevice device{.mass_kg = 0.08, .viscous_n_s_per_m = 2.0};
  for (const double ticks : {0.3, 1.0, 2.5, 3.7}) {
    device.delay_s = 1e-3 * ticks;
    EXPECT_NEAR(late(std::to_string(ticks)) / eigenvalue_boundary(device, 0.0, 10.0, 10000.0), 1.0, 2e-3)
        << ticks;
  }
}

}  // namespace
}  // namespace kerf::bench

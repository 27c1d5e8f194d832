#include "signal/smoothed_values.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "signal/quantiles.h"
#include "signal/signal.h"
#include "signal/uniform_samples.h"

namespace kerf::bench {
namespace {

BlockedValues blocked(const std::vector<double>& values) {
  return {values.size(), [&values](std::uint64_t first, std::span<double> some) {
            std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), some.size(), some.begin());
          }};
}

struct Samples {
  std::vector<double> time_s;
  std::vector<double> values;
};

/// A noisy sine over more than two blocks, at times that are not uniform, with a gap and a time that repeats.
Samples irregular(std::size_t count) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::uniform_real_distribution<double> step(0.8e-3, 1.2e-3);
  Samples samples;
  double at_s = 3.0;
  for (std::size_t i = 0; i < count; ++i) {
    samples.time_s.push_back(at_s);
    samples.values.push_back(std::sin(at_s) + noise(random));
    if (i % 1000 != 7) at_s += i == count / 2 ? 0.5 : step(random);
  }
  return samples;
}

/// All at once, as it is done in memory.
std::vector<double> smoothed_in_memory(const Samples& samples, double corner_hz) {
  const UniformSamples uniform(samples.time_s);
  return uniform.filtered(samples.values, [&](const std::vector<double>& values) {
    return low_pass_zero_phase(values, uniform.rate_hz(), corner_hz);
  });
}

TEST(SmoothedValues, AreThoseOfAllSamplesAtOnceToTheLastBit) {
  for (const std::size_t count : {10U, 65'535U, 65'536U, 65'537U, 200'000U}) {
    const Samples samples = irregular(count);
    for (const double corner_hz : {0.1, 20.0, 190.0}) {
      const auto expected = smoothed_in_memory(samples, corner_hz);
      const BlockedValues time_s = blocked(samples.time_s);
      const BlockedValues values = blocked(samples.values);
      const UniformTimes grid(time_s, median_period(samples.time_s));
      const SmoothedValues smoothed(values, grid, corner_hz);
      ASSERT_EQ(smoothed.size(), count);
      for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(smoothed[i], expected[i]) << count << " " << i;
      ASSERT_EQ(smoothed[count / 3], expected[count / 3]) << "whatever was asked for before";
    }
  }
}

TEST(UniformTimes, RefuseTimesThatNoFilterCanUse) {
  const auto refused = [](const std::vector<double>& time_s, double period_s) {
    const BlockedValues blocks = blocked(time_s);
    EXPECT_THROW(UniformTimes(blocks, period_s), std::invalid_argument);
  };
  refused({0.0, 1.0, 2.0}, 0.0);
  refused({0.0, 2.0, 1.0, 3.0}, 1.0);
  refused({0.0, std::nan(""), 2.0}, 1.0);
  refused({0.0, 1e-3, 1e300}, 1e-3);
}

TEST(BlockedValues, ReadEachBlockOnceForWhoGoesThroughThem) {
  int reads = 0;
  const BlockedValues values(3 * BlockedValues::block + 5, [&](std::uint64_t first, std::span<double> some) {
    ++reads;
    for (double& value : some) value = static_cast<double>(first++);
  });
  for (std::uint64_t at = 1; at < values.size(); ++at) {
    ASSERT_EQ(values[at], static_cast<double>(at));
    ASSERT_EQ(values[at - 1], static_cast<double>(at - 1));
  }
  EXPECT_EQ(reads, 4);
}

}  // namespace
}  // namespace kerf::bench

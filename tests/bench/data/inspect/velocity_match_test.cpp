#include "inspect/velocity_match.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/data/inspect/blocked.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// 20 s of a position [m] with its velocity.
struct Motion {
  std::vector<double> time_s, position, velocity;
  double period_s = 0.0;
  double noise = 0.0;  ///< as inspect() knows it

  Motion(double rate_hz, const std::function<double(double)>& x, const std::function<double(double)>& v)
      : period_s(1.0 / rate_hz) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(20.0 * rate_hz); ++i) {
      time_s.push_back(static_cast<double>(i) * period_s);
      position.push_back(x(time_s.back()));
      velocity.push_back(v(time_s.back()));
    }
  }

  [[nodiscard]] std::optional<VelocityMatch> match() const {
    const BlockedValues t = test::blocked(time_s);
    const BlockedValues x = test::blocked(position);
    const BlockedValues v = test::blocked(velocity);
    const auto [least, most] = std::ranges::minmax(position);
    return velocity_match({.time_s = t,
                           .position = x,
                           .velocity = v,
                           .period_s = period_s,
                           .position_noise = noise,
                           .position_range = most - least});
  }

  /// Empty where nothing is said, "unknown" where nothing is known.
  [[nodiscard]] std::string doubt(const std::string& unit = "m") const {
    const auto found = match();
    return found ? velocity_doubt(*found, unit, period_s) : "unknown";
  }
};

constexpr double omega = std::numbers::pi;  // strokes of 2 s

/// Strokes of 10 mm.
Motion strokes(double rate_hz) {
  return {rate_hz, [](double t) { return 0.005 * (1.0 - std::cos(omega * t)); },
          [](double t) { return 0.005 * omega * std::sin(omega * t); }};
}

Motion with(Motion motion, const std::function<double(double)>& change) {
  std::ranges::transform(motion.velocity, motion.velocity.begin(), change);
  return motion;
}

TEST(VelocityMatch, OfWhatIsTheDerivativeIsOneAtAnyRate) {
  for (const double rate_hz : {20.0, 100.0, 1000.0}) {
    const auto match = strokes(rate_hz).match();
    ASSERT_TRUE(match) << rate_hz;
    EXPECT_NEAR(match->gain, 1.0, 0.03) << rate_hz;
    EXPECT_GT(match->correlation, 0.99) << rate_hz;
    EXPECT_EQ(match->lag_s, 0.0) << rate_hz;
    EXPECT_EQ(strokes(rate_hz).doubt(), "") << rate_hz;
  }
}

TEST(VelocityMatch, FindsATurnedSignAndAWrongUnit) {
  const auto scaled = [](double factor) {
    return with(strokes(100.0), [factor](double v) { return factor * v; });
  };
  EXPECT_NEAR(scaled(-1.0).match()->gain, -1.0, 1e-3);
  EXPECT_EQ(scaled(-1.0).doubt(), "is -1 of dx/dt: turned sign");
  EXPECT_EQ(scaled(1e-3).doubt(), "is 0.001 of dx/dt: m/s taken for mm/s?");
  EXPECT_EQ(scaled(1e3).doubt(), "is 1000 of dx/dt: mm/s taken for m/s?");
  EXPECT_EQ(scaled(-180.0 / std::numbers::pi).doubt("rad"),
            "is -57.3 of dx/dt: turned sign, deg/s taken for rad/s?");
  EXPECT_EQ(scaled(2.0).doubt(), "is 2 of dx/dt") << "no unit that somebody mistakes";
  EXPECT_EQ(scaled(0.0).doubt(), "is 0 all along, though the position moves");
}

TEST(VelocityMatch, FindsAnotherSignalALaterOneAndAnOffset) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  EXPECT_THAT(with(strokes(100.0), [&](double) { return noise(random); }).doubt(),
              StartsWith("does not follow dx/dt"));

  Motion later = strokes(100.0);
  std::rotate(later.velocity.begin(), later.velocity.end() - 40, later.velocity.end());
  ASSERT_TRUE(later.match());
  EXPECT_NEAR(later.match()->lag_s, 0.4, 0.02);
  EXPECT_THAT(later.doubt(), StartsWith("follows dx/dt 0.4 s late"));

  EXPECT_THAT(with(strokes(100.0), [](double v) { return v + 0.02; }).doubt(),
              HasSubstr("0.02 m/s more than dx/dt"));
}

TEST(VelocityMatch, DoesNotBlameWhatDriversAndSensorsDo) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0.0, 3e-5);
  // The velocity as a driver has it: noisy steps of an encoder through a low-pass at 10 Hz, 16 ms late.
  Motion driver = strokes(1000.0);
  driver.noise = 3e-5;
  double filtered = 0.0;
  double last = driver.position.front();
  for (std::size_t i = 0; i < driver.position.size(); ++i) {
    driver.position[i] += noise(random);
    const double step = (driver.position[i] - last) / driver.period_s;
    last = driver.position[i];
    filtered += (1.0 - std::exp(-2.0 * std::numbers::pi * 10.0 * driver.period_s)) * (step - filtered);
    driver.velocity[i] = filtered;
  }
  EXPECT_EQ(driver.doubt(), "");

  Motion unfiltered = strokes(1000.0);
  unfiltered.noise = 3e-5;
  for (double& x : unfiltered.position) x += noise(random);
  for (std::size_t i = 1; i < unfiltered.position.size(); ++i)
    unfiltered.velocity[i] = (unfiltered.position[i] - unfiltered.position[i - 1]) / unfiltered.period_s;
  EXPECT_EQ(unfiltered.doubt(), "") << "noise of the slopes is twice the velocity";

  // Half of the rows are not there, as a logger under load leaves them out.
  Motion uneven = strokes(100.0);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < uneven.time_s.size(); ++i) {
    if (chance(random) < 0.5) continue;
    for (auto* const column : {&uneven.time_s, &uneven.position, &uneven.velocity})
      (*column)[kept] = (*column)[i];
    ++kept;
  }
  for (auto* const column : {&uneven.time_s, &uneven.position, &uneven.velocity}) column->resize(kept);
  EXPECT_EQ(uneven.doubt(), "");

  Motion wrapped = strokes(100.0);  // an angle that is told up to a turn, here of 7 mm
  for (double& x : wrapped.position) x = std::fmod(x, 0.007);
  EXPECT_EQ(wrapped.doubt(), "");
}

TEST(VelocityMatch, KnowsNothingOfWhatRestsOrIsShort) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, 3e-5);
  Motion rest(
      100.0, [&](double) { return noise(random); }, [](double) { return 1.0; });
  rest.noise = 3e-5;
  EXPECT_EQ(rest.doubt(), "unknown");
  Motion few = strokes(100.0);
  for (auto* const column : {&few.time_s, &few.position, &few.velocity}) column->resize(10);
  EXPECT_EQ(few.doubt(), "unknown");
}

}  // namespace
}  // namespace kerf::bench

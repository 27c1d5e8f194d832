#include "kerf/drivers/streamed_force.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "kerf/drivers/usb/io_thread.h"
#include "support/allocation_counter.h"

namespace kerf::drivers {
namespace {

constexpr std::int64_t millisecond_ns = 1'000'000;

StreamedForce::Reading reading_of(double force_n, std::uint64_t number, std::int64_t taken_ns) {
  StreamedForce::Reading reading{.number = number, .taken_ns = taken_ns};
  reading.wrench.fill(force_n);
  reading.extras[0] = 10.0 * static_cast<double>(number);
  return reading;
}

TEST(StreamedForce, HasNothingToSayBeforeAReading) {
  StreamedForce force(1);
  Sample sample;
  EXPECT_EQ(force.read(0.0, sample), Status::fault);
  EXPECT_TRUE(std::isnan(sample.force_measured[0]));
  EXPECT_TRUE(std::isnan(sample.channels[1]));
  EXPECT_TRUE(std::isnan(sample.channels[2]));
}

// Readings of the near future, so that a test that is held up reads no old ones.
TEST(StreamedForce, TellsTheLatestReadingAndItsAge) {
  StreamedForce force(1);
  Sample sample;
  const std::int64_t now = usb::now_ns();
  force.put(reading_of(1.0, 7, now + 99 * millisecond_ns));
  force.put(reading_of(2.0, 8, now + 100 * millisecond_ns));
  ASSERT_EQ(force.read(0.0, sample), Status::ok);
  EXPECT_EQ(sample.force_measured[5], 2.0);
  EXPECT_GE(sample.channels[0], -0.1);
  EXPECT_LE(sample.channels[0], -0.1 + 1e-9 * static_cast<double>(usb::now_ns() - now));
  EXPECT_EQ(sample.channels[1], 8.0);
  EXPECT_EQ(sample.channels[2], 80.0);
}

// What belongs to the moment of the tick less the delay, of a force that grows by a newton in ten
// milliseconds.
TEST(StreamedForce, InterpolatesAtTheDelay) {
  StreamedForce force(1);
  force.resample(StreamedForce::Rule::interpolated, 0.0055);
  const std::int64_t before = usb::now_ns();
  const std::int64_t start = before - 50 * millisecond_ns;
  for (int i = 0; i < 16; ++i)
    force.put(reading_of(i, static_cast<std::uint64_t>(i), start + 10 * i * millisecond_ns));
  Sample sample;
  ASSERT_EQ(force.read(0.0, sample), Status::ok);
  const std::int64_t after = usb::now_ns();
  EXPECT_GE(sample.force_measured[0], 5.0 - 0.55 - 1e-9);
  EXPECT_LE(sample.force_measured[0], 1e-7 * static_cast<double>(after - start) - 0.55 + 1e-9);
  EXPECT_DOUBLE_EQ(sample.channels[0], 0.0055);
  EXPECT_EQ(sample.channels[1], std::ceil(sample.force_measured[0]));
}

TEST(StreamedForce, TellsTheNewestWhereNothingSurroundsTheMoment) {
  Sample sample;
  Status status = Status::fault;
  for (int attempt = 0; attempt < 20 && status != Status::ok; ++attempt) {  // it may be held up for 15 ms
    StreamedForce force;
    force.resample(StreamedForce::Rule::interpolated, 0.001);
    const std::int64_t now = usb::now_ns();
    force.put(reading_of(1.0, 1, now - 6 * millisecond_ns));
    force.put(reading_of(2.0, 2, now - 5 * millisecond_ns));
    status = force.read(0.0, sample);
  }
  ASSERT_EQ(status, Status::ok);
  EXPECT_EQ(sample.force_measured[0], 2.0);
  EXPECT_GE(sample.channels[0], 0.005);
}

TEST(StreamedForce, TellsNoWrenchThatTheSensorItselfDoubts) {
  StreamedForce force(1);
  StreamedForce::Reading doubted = reading_of(3.0, 4, usb::now_ns() + 100 * millisecond_ns);
  doubted.sound = false;
  force.put(doubted);
  Sample sample;
  EXPECT_EQ(force.read(0.0, sample), Status::fault);
  EXPECT_TRUE(std::isnan(sample.force_measured[2]));
  EXPECT_EQ(sample.channels[1], 4.0);
  EXPECT_EQ(sample.channels[2], 40.0);
}

TEST(StreamedForce, IsAFaultAfterTwentyMillisecondsAndLostAfterASecond) {
  Sample sample;
  StreamedForce old;
  old.put(reading_of(1.0, 1, usb::now_ns() - 21 * millisecond_ns));
  EXPECT_EQ(old.read(0.0, sample), Status::fault);
  EXPECT_TRUE(std::isnan(sample.force_measured[0]));
  EXPECT_GT(sample.channels[0], 0.02);
  StreamedForce silent;
  silent.put(reading_of(1.0, 1, usb::now_ns() - 1001 * millisecond_ns));
  EXPECT_EQ(silent.read(0.0, sample), Status::lost);
  StreamedForce gone;
  gone.lose();
  EXPECT_EQ(gone.read(0.0, sample), Status::lost);
  EXPECT_EQ(gone.write({}), Status::lost);
}

TEST(StreamedForce, AllocatesNothing) {
  StreamedForce force(2);
  force.resample(StreamedForce::Rule::interpolated, 0.002);
  Sample sample;
  const test::NoAllocation guard;
  for (std::uint64_t i = 0; i < 100; ++i) {
    force.put(reading_of(1.0, i, usb::now_ns()));
    (void)force.read(1e-3 * static_cast<double>(i), sample);
    (void)force.write({});
  }
}

TEST(StreamedForce, TakesNoForceThatIsNone) {
  const StreamedForce force;
  Axes broken{};
  broken[1] = std::nan("");
  EXPECT_EQ(force.write({}), Status::ok);
  EXPECT_EQ(force.write(broken), Status::fault);
}

}  // namespace
}  // namespace kerf::drivers

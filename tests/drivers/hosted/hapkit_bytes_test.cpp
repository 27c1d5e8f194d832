// What sketch, driver and emulator of a Hapkit have to understand alike; each has its own code, from
// firmware/hapkit/README.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hapkit/frame.h>
#include <poll.h>
#include <unistd.h>

#include "kerf/drivers/protocols/frame_reader.h"
#include "kerf/drivers/protocols/hapkit.h"
#include "support/running_box.h"

namespace kerf::drivers {
namespace {

using testing::ElementsAreArray;

// Sums by Python's binascii.crc_hqx(bytes, 0xFFFF).
constexpr std::array<std::uint8_t, 13> golden_frame{0xA5, 0x01, 0x34, 0x12, 0xBC, 0x02, 0xFE,
                                                    0x10, 0x09, 0x9C, 0xFF, 0x8A, 0xD6};
constexpr std::array<std::uint8_t, 13> golden_first_frame{0xA5, 0x01, 0x01, 0x00, 0xC0, 0x01, 0x00,
                                                          0x03, 0x00, 0x00, 0x00, 0xDE, 0x52};
constexpr std::array<std::uint8_t, 6> golden_order{0x5A, 0x09, 0x9C, 0xFF, 0xB7, 0x44};
constexpr std::array<std::uint8_t, 6> golden_zero{0x5A, 0x00, 0x00, 0x00, 0x50, 0x99};
constexpr std::array<std::uint8_t, 6> golden_too_much{0x5A, 0xC9, 0x00, 0x01, 0x17, 0x31};  // 256

std::vector<hapkit_order> taken_by_sketch(std::span<const std::uint8_t> bytes, hapkit_orders& orders) {
  std::vector<hapkit_order> all;
  for (const std::uint8_t byte : bytes) {
    hapkit_order order{};
    if (hapkit_take_byte(&orders, byte, &order) != 0) all.push_back(order);
  }
  return all;
}

TEST(HapkitBytes, OfAFrameAreAlikeForSketchAndDriver) {
  const std::string check = "123456789";
  EXPECT_EQ(hapkit_crc(reinterpret_cast<const std::uint8_t*>(check.data()), 9), 0x29B1);  // published
  const hapkit_frame told{
      .count = 0x1234, .sensor = 700, .flips = -2, .status = 16, .order = 9, .duty = -100};
  std::array<std::uint8_t, HAPKIT_FRAME_SIZE> bytes{};
  hapkit_put_frame(&told, bytes.data());
  EXPECT_THAT(bytes, ElementsAreArray(golden_frame));
  std::vector<hapkit::Frame> found;
  FrameReader<hapkit::FrameBytes> reader;
  const auto take = [&](std::span<const std::uint8_t> some) {
    reader.take(
        some, [&](std::span<const std::uint8_t> one) { found.push_back(hapkit::parse(one)); }, [] {});
  };
  take(std::span(golden_frame).subspan(4));  // one that had begun before, in which a frame seems to
  take(golden_frame);
  take(golden_first_frame);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].count, 0x1234);
  EXPECT_EQ(found[0].sensor, 700);
  EXPECT_EQ(found[0].flips, -2);
  EXPECT_EQ(found[0].status, hapkit::saturated);
  EXPECT_EQ(found[0].order, 9);
  EXPECT_EQ(found[0].duty, -100);
  EXPECT_EQ(found[1].status, hapkit::let_go | hapkit::fresh);
  for (std::size_t at = 0; at < golden_frame.size(); ++at) {
    auto turned = golden_frame;
    turned.at(at) ^= 0x10U;
    take(turned);
  }
  EXPECT_EQ(found.size(), 2U);
}

TEST(HapkitBytes, OfAnOrderAreAlikeForSketchAndDriver) {
  EXPECT_THAT(hapkit::order(9, -100), ElementsAreArray(golden_order));
  EXPECT_THAT(hapkit::order(0, 0), ElementsAreArray(golden_zero));
  EXPECT_EQ(hapkit::order(1, 999), hapkit::order(1, 255));
  hapkit_orders orders{};
  std::vector<std::uint8_t> stream{0x5A, 0x5A, 0x00};  // garbage, and the beginning of an order
  std::ranges::copy(golden_order, std::back_inserter(stream));
  const auto taken = taken_by_sketch(stream, orders);
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_EQ(taken[0].number, 9);
  EXPECT_EQ(taken[0].duty, -100);
  EXPECT_EQ(orders.refused, 1);
  orders = {};
  auto turned = golden_order;
  turned[2] ^= 0x40U;
  EXPECT_TRUE(taken_by_sketch(turned, orders).empty());
  EXPECT_EQ(taken_by_sketch(golden_zero, orders).size(), 1U);
}

/// The next bytes of an emulator's port.
std::vector<std::uint8_t> read_from(int port, std::size_t count) {
  std::vector<std::uint8_t> bytes;
  pollfd wanted{.fd = port, .events = POLLIN, .revents = 0};
  while (bytes.size() < count && poll(&wanted, 1, 5000) == 1) {
    std::array<std::uint8_t, 13> some{};
    const auto size = read(port, some.data(), std::min(some.size(), count - bytes.size()));
    if (size <= 0) break;
    bytes.insert(bytes.end(), some.begin(), some.begin() + size);
  }
  return bytes;
}

TEST(HapkitBytes, OfTheEmulatorAreThoseOfTheSketch) {
  const test::RunningSerialDevice running("hapkit?boot=0s&sway=0mm&noise=0");
  const int port = open(running.path().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(port, 0);
  EXPECT_THAT(read_from(port, 13), ElementsAreArray(golden_first_frame));
  const auto frame_after = [&](std::span<const std::uint8_t> order) {
    EXPECT_EQ(write(port, order.data(), order.size()), static_cast<ssize_t>(order.size()));
    hapkit::Frame frame;
    for (int round = 0; round < 1000 && frame.order != order[1]; ++round)
      frame = hapkit::parse(read_from(port, 13));
    return frame;
  };
  const auto back = frame_after(golden_order);
  EXPECT_EQ(back.duty, -100);
  EXPECT_EQ(back.status & ~hapkit::unsure, 0U);
  const auto cut = frame_after(golden_too_much);
  EXPECT_EQ(cut.duty, 255);
  EXPECT_EQ(cut.status & ~hapkit::unsure, hapkit::saturated);
  close(port);
}

int half_turns_at(int place) { return static_cast<int>(std::floor(place / 923.0)); }

TEST(HapkitTurns, AreCountedAtWhateverTheSensorReadsOnItsWayBack) {
  for (const int between : {0, 300, 500, 900}) {
    for (const int step : {1, 17, 120, -60, -3}) {
      hapkit_turns turns{};
      for (int place = 1000; std::abs(place - 1000) < 5000; place += step) {
        // On its way from one end to the other it is read in between, but for 0.
        const int half_turns = half_turns_at(place);
        if (between != 0 && half_turns != half_turns_at(place - step) && place != 1000)
          (void)hapkit_turn(&turns, static_cast<std::uint16_t>(48 + between));
        const int sensor = 48 + place - 923 * half_turns;
        ASSERT_EQ(hapkit_turn(&turns, static_cast<std::uint16_t>(sensor)), 0) << step << " " << between;
        ASSERT_EQ(turns.flips, half_turns - 1) << step << " " << between;
      }
    }
  }
}

// Here the published rule is soon off by a half turn.
TEST(HapkitTurns, AreNoneWhereTheSensorGoesToAndFroAtAnEnd) {
  hapkit_turns turns{};
  ASSERT_EQ(hapkit_turn(&turns, 970), 0);
  std::uint32_t drawn = 1;
  for (int i = 0; i < 10'000; ++i) {
    drawn = drawn * 1664525U + 1013904223U;
    const int value = i % 3 == 1 ? 500 : std::array{970, 969, 49, 48}.at((drawn >> 24U) % 4);
    const bool is_place = hapkit_turn(&turns, static_cast<std::uint16_t>(value)) == 0;
    if (value != 500) {
      ASSERT_TRUE(is_place);
      ASSERT_NEAR(turns.place + 923 * turns.flips, 970, 2) << i;
    }
  }
}

TEST(HapkitTurns, OfAHandleThatIsFasterThanAnyHandAreTold) {
  hapkit_turns turns{};
  ASSERT_EQ(hapkit_turn(&turns, 100), 0);
  EXPECT_EQ(hapkit_turn(&turns, 229), HAPKIT_UNSURE);
  EXPECT_EQ(hapkit_turn(&turns, 356), 0);  // within two milliseconds
  int values = 1;
  while (hapkit_turn(&turns, 1000) != 0) ++values;
  EXPECT_EQ(values, 6);
}

TEST(HapkitMotor, IsLetGoTwentyMillisecondsAfterTheLastOrder) {
  hapkit_motor motor = hapkit_at_rest;
  EXPECT_EQ(motor.status, HAPKIT_LET_GO | HAPKIT_FRESH);
  hapkit_wait(&motor);
  EXPECT_EQ(motor.status, HAPKIT_LET_GO | HAPKIT_FRESH);
  const hapkit_order order{.number = 3, .duty = -300};
  hapkit_obey(&motor, &order);
  EXPECT_EQ(motor.duty, -255);
  EXPECT_EQ(motor.status, HAPKIT_SATURATED);
  for (int i = 1; i < HAPKIT_WATCHDOG_MS; ++i) hapkit_wait(&motor);
  EXPECT_EQ(motor.duty, -255);
  hapkit_wait(&motor);
  EXPECT_EQ(motor.duty, 0);
  EXPECT_EQ(motor.status, HAPKIT_LET_GO);
}

// T_ref r_s / (r_h r_p) = 0.03 * 0.074 / (0.09 * 0.005) = 4.933 N; a 25th of it is a fifth of the duty.
TEST(HapkitForce, FollowsTheSquareRootOfThePublishedSketches) {
  hapkit::Made made;
  EXPECT_NEAR(made.full_force_n(), 4.9333, 1e-4);
  EXPECT_NEAR(made.step_m(), 23.25e-6, 0.01e-6);
  EXPECT_EQ(made.duty(0.0), 0);
  EXPECT_EQ(made.duty(0.04 * made.full_force_n()), 51);
  EXPECT_EQ(made.duty(-4.9333), -255);
  EXPECT_EQ(made.duty(1000.0), 255);
  made.motor = -1.0;
  EXPECT_EQ(made.duty(0.04 * made.full_force_n()), -51);
}

TEST(HapkitLines, AreReadAsAWholeOrNotAtAll) {
  const auto report = hapkit::parse_report("Prm 0.01234 -0.50000 12.00000 1");
  ASSERT_TRUE(report);
  EXPECT_EQ(report->position_m, 0.01234);
  EXPECT_EQ(report->velocity_m_s, -0.5);
  EXPECT_EQ(report->acceleration_m_s2, 12.0);
  EXPECT_TRUE(report->is_pressed);
  EXPECT_FALSE(hapkit::parse_report("Prm 0.00000 0.00000 0.00000 0\r")->is_pressed);
  for (const char* const line :
       {"", "Calibrated", "Min: -3040", "Prm 0.1 0.2 0.3", "Prm 0.1 0.2 0.3 2", "Prm 0.1 0.2 0.3 1 5",
        "Prm nan 0.2 0.3 0", "rm 0.1 0.2 0.3 0", "Prm  0.1 0.2 0.3 0", "Prm 0.1 0.2 x 0"}) {
    EXPECT_FALSE(hapkit::parse_report(line)) << line;
  }
  hapkit::LineReader reader;
  reader.add("Zero: 0\nPrm 0.1");
  EXPECT_EQ(reader.next(), "Zero: 0");
  EXPECT_FALSE(reader.next());
  reader.add(" 0 0 1\n");
  EXPECT_EQ(reader.next(), "Prm 0.1 0 0 1");
  reader.add(std::string(1000, 'x'));
  reader.add("\n");
  EXPECT_EQ(reader.next(), "");
}

}  // namespace
}  // namespace kerf::drivers

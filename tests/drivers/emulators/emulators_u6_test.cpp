#include <cmath>
#include <optional>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/protocols/labjack_u6_commands.h>

#include "devices/labjack_u6.h"

namespace kerf::emulators {
namespace {

namespace wire = drivers::labjack_u6;
using testing::ElementsAre;

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t start = 7'000 * ms;

/// An emulator and the host that speaks to it, in the test's own time.
class Host {
 public:
  explicit Host(const EmulatedU6::Options& options = {}) : device(options) {}

  Bytes ask(std::span<const std::uint8_t> command, std::size_t room = 64) {
    device.receive(1, command, now);
    return take(2, room).value_or(Bytes{});
  }
  Bytes ask(Bytes command, bool sealed) {
    if (sealed) wire::seal(command);
    return ask(command);
  }
  std::optional<Bytes> take(std::uint8_t endpoint, std::size_t room) {
    Bytes buffer(room);
    const auto size = device.send(endpoint, buffer, now, now, next);
    if (!size) return std::nullopt;
    buffer.resize(*size);
    return buffer;
  }
  std::optional<wire::StreamPacket> packet() {
    const auto bytes = take(3, 64);
    return bytes ? wire::parse_stream(*bytes) : std::nullopt;
  }
  void start_stream(std::uint8_t channels = 6, std::uint8_t per_packet = 6) {
    Bytes config(14U + 2U * channels, 0);
    config[1] = 0xF8;
    config[2] = static_cast<std::uint8_t>(channels + 4);
    config[3] = 0x11;
    config[6] = channels;
    config[8] = per_packet;
    config[12] = 4000 % 256;
    config[13] = 4000 / 256;
    for (std::uint8_t i = 0; i < channels; ++i) {
      config[14U + 2U * i] = static_cast<std::uint8_t>(2 * i);
      config[15U + 2U * i] = 0x80;
    }
    EXPECT_THAT(wire::parse_stream_config(ask(config, true)), 0);
    EXPECT_THAT(wire::parse_stream_start(ask(wire::stream_start().view())), 0);
  }

  EmulatedU6 device;
  std::int64_t now = start;
  Disturbance next = Disturbance::none;
};

TEST(EmulatedU6, AnswersOnlyACommandAndWithExactSizes) {
  Host host;
  EXPECT_FALSE(host.take(2, 64));
  const auto identification = wire::parse_identification(host.ask(wire::identify().view()));
  ASSERT_TRUE(identification);
  EXPECT_EQ(identification->serial, 360000001U);
  EXPECT_FALSE(identification->pro);
  EXPECT_FALSE(host.take(2, 64));
  const Bytes io = host.ask(wire::no_timers().view());
  EXPECT_EQ(io.size(), 16U);
  EXPECT_TRUE(wire::is_no_timers(io));
  EXPECT_EQ(host.ask({0, 0xF8, 2, 0x0A, 0, 0, 0, 0, 0x80 | 2, 48}, true).size(), 10U);
}

TEST(EmulatedU6, AnswersABadChecksumAsTheVendorDoes) {
  Host host;
  auto command = wire::identify();
  command.bytes[7] ^= 1U;
  EXPECT_THAT(host.ask(command.view()), ElementsAre(0xB8, 0xB8));
  EXPECT_THAT(host.ask(Bytes{0xA9, 0xA8}, false), ElementsAre(0xB8, 0xB8));
}

TEST(EmulatedU6, HasTheNominalConstantsInTenBlocks) {
  Host host;
  std::array<std::array<double, 4>, 10> blocks{};
  for (std::uint8_t block = 0; block < 10; ++block) {
    const auto constants = wire::parse_constants(host.ask(wire::read_constants(block).view()));
    ASSERT_TRUE(constants) << static_cast<int>(block);
    blocks[block] = *constants;
  }
  const auto calibration = wire::ten_volt_calibration(blocks[0], blocks[2]);
  ASSERT_TRUE(calibration);
  // 32 bits behind the point hold 3.16e-4 to one part in a million.
  EXPECT_NEAR(calibration->slope, 3.1580578e-4, 2e-10);
  EXPECT_NEAR(calibration->negative_slope, -3.158058e-4, 2e-10);
  EXPECT_EQ(calibration->centre, 33523.0);
  EXPECT_THAT(blocks[4], ElementsAre(13200.0, 0.0, 13200.0, 0.0));
  EXPECT_NEAR(blocks[5][2], -92.379, 1e-9);
  EXPECT_EQ(blocks[6], blocks[0]);
  EXPECT_FALSE(wire::parse_constants(host.ask(wire::read_constants(10).view())));
}

TEST(EmulatedU6, StopsAStreamThatDoesNotRunWithError52) {
  Host host;
  EXPECT_THAT(wire::parse_stream_stop(host.ask(wire::stream_stop().view())), 52);
  host.start_stream();
  EXPECT_THAT(wire::parse_stream_start(host.ask(wire::stream_start().view())), 48);
  EXPECT_THAT(wire::parse_stream_stop(host.ask(wire::stream_stop().view())), 0);
  host.now += 50 * ms;
  EXPECT_FALSE(host.packet());
}

TEST(EmulatedU6, SendsAPacketOf26BytesEachMillisecondOfItsOwnClock) {
  Host host({.drift_ppm = 100.0});
  host.start_stream();
  for (std::uint64_t scan = 0; scan < 1000; ++scan) {
    const auto due = host.device.next_event_ns(host.now);
    ASSERT_TRUE(due);
    EXPECT_EQ(*due, start + std::llround(1.0001e6 * static_cast<double>(scan + 1)));
    host.now = *due - 1;
    EXPECT_FALSE(host.take(3, 64));
    host.now = *due;
    const auto bytes = host.take(3, 64);
    ASSERT_TRUE(bytes);
    EXPECT_EQ(bytes->size(), 26U);
    EXPECT_EQ(wire::parse_stream(*bytes)->counter, scan % 256);
  }
  (void)host.ask(wire::stream_stop().view());
  (void)host.ask(wire::stream_start().view());
  host.now += 2 * ms;
  EXPECT_EQ(host.packet()->counter, 0) << "it restarts with the stream";
}

TEST(EmulatedU6, FillsAWholeTransferWithPacketsOf64Bytes) {
  Host host;
  host.start_stream(5, 25);
  host.now += 24 * ms;
  EXPECT_FALSE(host.take(3, 320)) << "120 of 125 samples";
  host.now += ms;
  const auto bytes = host.take(3, 320);
  ASSERT_TRUE(bytes);
  ASSERT_EQ(bytes->size(), 320U);
  for (std::uint8_t i = 0; i < 5; ++i) {
    const auto packet = wire::parse_stream(std::span(*bytes).subspan(64U * i, 64));
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->counter, i);
  }
}

TEST(EmulatedU6, TurnsTheWrenchIntoCodesThatGiveItBack) {
  for (const double trim_ppm : {0.0, 20e3}) {
    Host host({.trim_ppm = trim_ppm});
    host.start_stream();
    const auto volts = wire::ten_volt_calibration(host.device.constants(0), host.device.constants(2));
    ASSERT_TRUE(volts);
    for (int scan = 1; scan <= 1000; ++scan) {
      host.now = start + scan * ms;
      const auto packet = host.packet();
      ASSERT_TRUE(packet);
      drivers::Axes inputs{};
      for (std::size_t i = 0; i < 6; ++i) inputs[i] = volts->volts(packet->sample[i]);
      const auto found = example_transducer().wrench(inputs);
      const auto acting = host.device.wrench(1e-3 * scan);
      for (std::size_t i = 0; i < 6; ++i) {
        // Half a code on each channel.
        const double most =
            0.5 * volts->slope * example_transducer().matrix.row(static_cast<int>(i)).cwiseAbs().sum();
        EXPECT_NEAR(found[i], acting[i], 1.001 * most);
      }
    }
  }
}

TEST(EmulatedU6, TellsAnOverflowOfItsBufferAndHowManyScansItLost) {
  Host host;
  host.start_stream();
  host.now += 300 * ms;  // 984 samples are 164 scans; 136 find no room
  for (int scan = 0; scan < 164; ++scan) EXPECT_EQ(host.packet()->error, 59);
  const auto report = host.packet();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->error, 60);
  EXPECT_EQ(report->time_stamp, 136U);
  EXPECT_EQ(report->sample[0], 0xFFFF);
  EXPECT_EQ(report->sample[5], 0xFFFF);
  EXPECT_FALSE(host.packet());
  host.now += ms;
  EXPECT_EQ(host.packet()->error, 0);
}

TEST(EmulatedU6, SaysHowFullItsBufferIs) {
  Host host;
  host.start_stream();
  host.now += 83 * ms;
  EXPECT_EQ(host.packet()->backlog, 492 * 256 / 984);
}

TEST(EmulatedU6, OverflowsWhenItIsTold) {
  Host host({.overflow_s = 0.5});
  host.start_stream();
  std::uint64_t lost = 0;
  std::set<int> errors;
  for (int time_ms = 1; time_ms <= 1000; ++time_ms) {
    host.now = start + time_ms * ms;
    while (const auto packet = host.packet()) {
      errors.insert(packet->error);
      lost += packet->time_stamp;
    }
  }
  EXPECT_THAT(errors, ElementsAre(0, 59, 60));
  EXPECT_NEAR(static_cast<double>(lost), 190.0 - 164.0, 1.0);
}

TEST(EmulatedU6, DropsTurnsAndTearsWhatItIsToldTo) {
  Host host;
  host.start_stream();
  host.now += ms;
  host.next = Disturbance::drop;
  EXPECT_FALSE(host.packet());
  EXPECT_EQ(host.next, Disturbance::none);
  host.now += ms;
  EXPECT_EQ(host.packet()->counter, 1);
  host.now += ms;
  host.next = Disturbance::corrupt;
  EXPECT_FALSE(host.packet());
  host.now += ms;
  host.next = Disturbance::split;
  EXPECT_EQ(host.take(3, 64)->size(), 13U);
  EXPECT_EQ(host.take(3, 64)->size(), 13U);
  host.now += ms;
  EXPECT_EQ(host.packet()->counter, 4);
}

TEST(EmulatedU6, ReadsAnInputAndItsTemperatureByFeedback) {
  Host host;
  // Echo 7; AIN24 of channel 4, differential; AIN24 of channel 14; padding makes the length even: 7 + 8 + 1.
  const Bytes reply = host.ask({0, 0xF8, 5, 0, 0, 0, 7, 2, 4, 9, 0x80, 2, 14, 9, 0, 0}, true);
  ASSERT_EQ(reply.size(), 16U);
  EXPECT_EQ(reply[6], 0);
  EXPECT_EQ(reply[8], 7);
  const auto number = [&](std::size_t at) {
    return (reply[at] | reply[at + 1] << 8 | reply[at + 2] << 16) / 256.0;
  };
  // Before the first stream no wrench acts: AIN4 shows the bias, 0.204 V. 22 degrees Celsius are 295.15 K.
  EXPECT_NEAR((number(9) - 33523.0) * 3.1580578e-4, 0.204, 1e-5);
  EXPECT_NEAR((number(12) - 33523.0) * 3.1580578e-4 * -92.379 + 465.129, 295.15, 0.01);
}

TEST(EmulatedU6, KnowsEveryIoTypeOfItsTableAndNoOther) {
  struct Io {
    Bytes sent;
    std::size_t returned;
  };
  const std::vector<Io> table{{{1, 0, 0}, 2},     {{2, 0, 0, 0}, 3},
                              {{3, 0, 0, 0}, 5},  {{5, 1}, 0},
                              {{6, 1}, 0},        {{9, 1}, 0},
                              {{10, 3}, 1},       {{11, 0x83}, 0},
                              {{12, 3}, 1},       {{13, 0x83}, 0},
                              {{26}, 3},          {{27, 1, 1, 1, 0, 0, 0}, 0},
                              {{28}, 3},          {{29, 1, 1, 1, 0, 0, 0}, 0},
                              {{34, 9}, 0},       {{35, 9}, 0},
                              {{38, 1, 2}, 0},    {{39, 1, 2}, 0},
                              {{42, 0, 0, 0}, 4}, {{43, 0, 0, 0}, 0},
                              {{48, 0, 0, 0}, 4}, {{49, 0, 0, 0}, 0},
                              {{54, 0}, 4},       {{55, 0}, 4}};
  for (const Io& io : table) {
    Host host;
    Bytes command{0, 0xF8, 0, 0, 0, 0, 0};
    command.insert(command.end(), io.sent.begin(), io.sent.end());
    if (command.size() % 2 != 0) command.push_back(0);
    command[2] = static_cast<std::uint8_t>((command.size() - 6) / 2);
    const Bytes reply = host.ask(command, true);
    EXPECT_EQ(reply[6], 0) << static_cast<int>(io.sent[0]);
    EXPECT_EQ(reply.size(), (9 + io.returned + 1) / 2 * 2) << static_cast<int>(io.sent[0]);
  }
  Host host;
  const Bytes reply = host.ask({0, 0xF8, 2, 0, 0, 0, 0, 9, 1, 200}, true);
  EXPECT_NE(reply[6], 0);
  EXPECT_EQ(reply[7], 2) << "the second one failed";
}

}  // namespace
}  // namespace kerf::emulators

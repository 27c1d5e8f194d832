#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/protocols/falcon.h>
#include <kerf/drivers/protocols/labjack_u6.h>
#include <kerf/drivers/protocols/spacemouse.h>
#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/drivers/usb/hid_device.h>
#include <kerf/mechanisms/falcon.h>

namespace kerf::drivers {
namespace {

using testing::ElementsAre;

TEST(FalconProtocol, WritesNumbersAsNibblesFromTheLeastOn) {
  // The worked example of its makers: -1447 is 0xFA59, nibbles 9, 5, A, F.
  const falcon::Frame frame = falcon::encode(falcon::Command{.motor = {-1447, 0, 4095}, .blue = true});
  EXPECT_THAT(frame, ElementsAre(0x3C, 0x4A, 0x46, 0x4B, 0x50, 0x41, 0x41, 0x41, 0x41, 0x50, 0x50, 0x50, 0x41,
                                 0x45, 0x41, 0x3E));
  EXPECT_EQ(falcon::parse_command(frame)->motor[0], -1447);
}

TEST(FalconProtocol, ReadsBackWhatItWrites) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> number(-32768, 32767);
  std::uniform_int_distribution<int> coin(0, 1);
  const auto toss = [&] { return coin(random) != 0; };
  for (int i = 0; i < 1000; ++i) {
    falcon::Report report;
    for (int& encoder : report.encoder) encoder = number(random);
    for (bool& homed : report.homed) homed = toss();
    report.plus = toss();
    report.forward = toss();
    report.centre = toss();
    report.minus = toss();
    EXPECT_EQ(falcon::parse_report(falcon::encode(report)), report);
  }
}

std::vector<falcon::Report> read_all(const std::vector<std::uint8_t>& bytes, falcon::FrameReader& reader) {
  std::vector<falcon::Report> reports;
  for (const std::uint8_t byte : bytes) {
    if (const auto frame = reader.take(byte)) reports.push_back(*falcon::parse_report(*frame));
  }
  return reports;
}

TEST(FalconProtocol, LetsGoByTwoFramesOfZerosThatKeepTheHoming) {
  const LettingGo homed = falcon::letting_go(0x02, true);
  ASSERT_EQ(homed.count, 1);
  EXPECT_EQ(homed.rounds, 2);
  EXPECT_EQ(homed.transfers[0].endpoint, 0x02);
  EXPECT_EQ(std::string(homed.transfers[0].bytes.begin(), homed.transfers[0].bytes.begin() + 16),
            "<AAAAAAAAAAAABA>");
  EXPECT_EQ(homed.transfers[0].size, 16);
  EXPECT_EQ(falcon::letting_go(0x02, false).transfers[0].bytes[13], 'A');
}

TEST(FalconProtocol, FindsItsFramesAgainAfterALostByteWhereverItWas) {
  for (std::size_t lost = 0; lost < 16; ++lost) {
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 4; ++i) {
      const auto frame = falcon::encode(falcon::Report{.encoder = {100 * i, -7, 3}});
      for (std::size_t k = 0; k < frame.size(); ++k) {
        if (i != 1 || k != lost) bytes.push_back(frame[k]);
      }
    }
    falcon::FrameReader reader;
    const auto reports = read_all(bytes, reader);
    ASSERT_EQ(reports.size(), 3U) << "without byte " << lost;
    EXPECT_EQ(reports[1].encoder[0], 200);
    EXPECT_EQ(reader.dropped(), 15U);
  }
}

TEST(FalconProtocol, TakesNoNoiseForAFrame) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> byte(0, 255);
  falcon::FrameReader reader;
  std::size_t frames = 0;
  for (int i = 0; i < 2'000'000; ++i)
    frames += reader.take(static_cast<std::uint8_t>(byte(random))).has_value();
  EXPECT_EQ(frames, 0U);
  EXPECT_EQ(read_all({0x3C, 0x41, 0x3C}, reader).size(), 0U);
}

TEST(FalconProtocol, TakesTheStatusBytesOutOfEveryPacket) {
  std::vector<std::uint8_t> transfer(70, 0x41);
  transfer[0] = transfer[64] = 0x01;
  transfer[1] = transfer[65] = 0x60;
  std::size_t count = 0;
  falcon::for_each_data_byte(transfer, [&](std::uint8_t byte) { count += byte == 0x41; });
  EXPECT_EQ(count, 66U);
  falcon::for_each_data_byte(std::vector<std::uint8_t>{0x01}, [](std::uint8_t) { FAIL(); });
}

TEST(FalconProtocol, CutsAForceWithoutTurningIt) {
  const auto motors = falcon::motors_for({1.0, -0.6, 0.25}, 10000.0);
  EXPECT_TRUE(motors.limited);
  EXPECT_THAT(motors.value, ElementsAre(-4095, 2457, -1024));
  EXPECT_THAT(falcon::motors_for({0.01, 0.0, -0.02}, 10000.0).value, ElementsAre(-100, 0, 200));
  EXPECT_THAT(falcon::motors_for({std::nan(""), 0.1, 0.1}, 10000.0).value, ElementsAre(0, 0, 0));
}

TEST(FalconProtocol, AForceIsFeltWithinATenthOfADegreeOfWhereItWasAskedFor) {
  // Kinematics, calibration, limit and whole motor values together; forces of 4 N, cut where they must be.
  constexpr double units_per_n_m = 10000.0;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::normal_distribution<double> normal;
  double worst = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double x = 0.03 * uniform(random);
    const double y = 0.03 * uniform(random);
    const auto at = mechanisms::Falcon::angles({x, y, 0.125 + 0.035 * uniform(random)});
    ASSERT_TRUE(at);
    const double fx = normal(random);
    const double fy = normal(random);
    const Eigen::Vector3d asked = 4.0 * Eigen::Vector3d(fx, fy, normal(random)).normalized();
    const Eigen::Vector3d torque = mechanisms::Falcon::torques(asked, *at);
    const auto motors = falcon::motors_for({torque[0], torque[1], torque[2]}, units_per_n_m);
    const Eigen::Vector3d applied =
        -Eigen::Vector3d(motors.value[0], motors.value[1], motors.value[2]) / units_per_n_m;
    const Eigen::Vector3d felt = mechanisms::Falcon::force(applied, *at);
    worst = std::max(worst, std::atan2(felt.cross(asked).norm(), felt.dot(asked)));
  }
  EXPECT_LT(worst * 180.0 / std::numbers::pi, 0.1);
}

TEST(WoodenHapticsProtocol, TellsItsGenerationsByLength) {
  using woodenhaptics::Generation;
  EXPECT_EQ(woodenhaptics::generation_of(8), Generation::v1);
  EXPECT_EQ(woodenhaptics::generation_of(14), Generation::v2);
  EXPECT_EQ(woodenhaptics::generation_of(64), Generation::v3);
  EXPECT_FALSE(woodenhaptics::generation_of(13));
}

TEST(WoodenHapticsProtocol, ReadsEncodersOfEveryGeneration) {
  using woodenhaptics::Generation;
  std::vector<std::uint8_t> bytes(64, 0xEE);  // V3's rest is noise
  const std::uint8_t head[] = {0x01, 0x00, 0xFF, 0xFF, 0x70, 0x17, 0x02,
                               0x80, 0x00, 0x01, 0x00, 0x00, 0x01, 0x00};
  std::copy(std::begin(head), std::end(head), bytes.begin());
  const auto v3 = woodenhaptics::parse_report(bytes, Generation::v3);
  ASSERT_TRUE(v3);
  EXPECT_THAT(v3->encoder, ElementsAre(1, -1, 6000, -32766, 256, 0));
  EXPECT_TRUE(v3->button);
  EXPECT_EQ(woodenhaptics::parse_report(std::span(bytes).first(14), Generation::v2), v3);
  const auto v1 = woodenhaptics::parse_report(std::span(bytes).first(8), Generation::v1);
  EXPECT_THAT(v1->encoder, ElementsAre(1, -1, 6000, 0, 0, 0));
  EXPECT_EQ(v1->counter, 0x8002);
  EXPECT_FALSE(woodenhaptics::parse_report(std::span(bytes).first(7), Generation::v1));
}

TEST(WoodenHapticsProtocol, WritesCurrentsAndCounters) {
  using woodenhaptics::Generation;
  const auto currents = woodenhaptics::set_currents({1000, -1000, 9999}, Generation::v1);
  EXPECT_EQ(currents.size, 9U);
  EXPECT_THAT(std::vector<int>(currents.bytes.begin(), currents.bytes.begin() + 9),
              ElementsAre(0, 0xE8, 0x03, 0x18, 0xFC, 0x6F, 0x17, 0, 0));
  EXPECT_EQ(woodenhaptics::set_currents({}, Generation::v3).size, 65U);
  const auto preset = woodenhaptics::preset_counters({1, 2, 3, 4, 5, 6}, Generation::v2);
  EXPECT_THAT(std::vector<int>(preset->bytes.begin(), preset->bytes.begin() + 15),
              ElementsAre(0, 4, 0, 5, 0, 6, 0, 1, 0, 1, 0, 2, 0, 3, 0));
  EXPECT_FALSE(woodenhaptics::preset_counters({}, Generation::v1));
  EXPECT_EQ(woodenhaptics::wrapped_difference(-32760, 32760), 16) << "over the end of 16 bits";
}

TEST(WoodenHapticsProtocol, LetsGoByZeroCurrentsWhoseReportsAreRead) {
  using woodenhaptics::Generation;
  const auto size_of = [](Generation generation) { return woodenhaptics::report_size(generation); };
  for (const auto& [generation, reports] :
       {std::pair{Generation::v1, 3}, {Generation::v2, 1}, {Generation::v3, 1}}) {
    const LettingGo transfers = woodenhaptics::letting_go(0x01, 0x82, generation);
    ASSERT_EQ(transfers.count, 1 + reports);
    EXPECT_EQ(transfers.rounds, 2);
    EXPECT_EQ(transfers.transfers[0].endpoint, 0x01);
    EXPECT_THAT(transfers.transfers[0].bytes, testing::Each(0));
    for (int i = 0; i < transfers.count; ++i) {
      const auto& one = transfers.transfers[static_cast<std::size_t>(i)];
      EXPECT_EQ(one.size, size_of(generation));
      EXPECT_EQ(one.endpoint, i == 0 ? 0x01 : 0x82);
    }
  }
}

TEST(WoodenHapticsProtocol, ADeviceReadsWhatTheHostWrites) {
  using woodenhaptics::Generation;
  using woodenhaptics::Order;
  for (const auto generation : {Generation::v1, Generation::v2, Generation::v3}) {
    const auto currents = woodenhaptics::set_currents({1000, -1000, 5999}, generation);
    const auto bytes = std::span(currents.bytes).subspan(1, currents.size - 1);
    EXPECT_EQ(woodenhaptics::parse_order(bytes, generation), (Order{.current_ma = {1000, -1000, 5999}}));
    const std::size_t told = generation == Generation::v1 ? 8 : 14;
    EXPECT_TRUE(woodenhaptics::parse_order(bytes.first(told), generation));
    EXPECT_FALSE(woodenhaptics::parse_order(bytes.first(told - 1), generation));
  }
  for (const auto generation : {Generation::v2, Generation::v3}) {
    const auto preset = woodenhaptics::preset_counters({1, -2, 3, -4, 5, -6}, generation);
    EXPECT_EQ(woodenhaptics::parse_order(std::span(preset->bytes).subspan(1), generation),
              (Order{.preset = true, .counts = {1, -2, 3, -4, 5, -6}}));
  }
}

TEST(WoodenHapticsProtocol, TheHostReadsWhatADeviceWrites) {
  using woodenhaptics::Generation;
  for (const auto generation : {Generation::v1, Generation::v2, Generation::v3}) {
    const bool v1 = generation == Generation::v1;
    const woodenhaptics::Report report{.encoder = {1, -2, 32767, v1 ? 0 : -32768, v1 ? 0 : 5, v1 ? 0 : -6},
                                       .button = !v1,
                                       .counter = v1 ? 0xFFFE : 0};
    const auto input = woodenhaptics::encode(report, generation);
    EXPECT_EQ(input.size, woodenhaptics::report_size(generation));
    EXPECT_EQ(woodenhaptics::parse_report(std::span(input.bytes).first(input.size), generation), report);
  }
}

TEST(WoodenHapticsProtocol, FollowsCountersBeyondSixteenBitsAndBelievesNoLeap) {
  woodenhaptics::Counters counters;
  counters.start({32000, -5, 0, 0, 0, 0});
  int true_count = 32000;
  for (int i = 0; i < 2000; ++i) {
    true_count += 100;
    EXPECT_TRUE(counters.take(
        {static_cast<std::int16_t>(static_cast<std::uint16_t>(true_count)), -5, 0, 0, 0, 0}, 150));
    ASSERT_EQ(counters.count()[0], true_count);
  }
  // A turned bit and a restarted device: not believed, and nothing is lost when the right one comes again.
  const int raw = static_cast<std::int16_t>(static_cast<std::uint16_t>(true_count));
  EXPECT_FALSE(counters.take({raw ^ 0x4000, -5, 0, 0, 0, 0}, 150));
  EXPECT_FALSE(counters.take({raw, -5, 151, 0, 0, 0}, 150));
  EXPECT_TRUE(counters.take({raw, -4, 150, 9999, 0, 0}, 150)) << "the gimbal's are not followed";
  EXPECT_THAT(counters.count(), ElementsAre(true_count, -4, 150));
  EXPECT_TRUE(counters.take({raw, -4, 0, 0, 0, 0}, 150)) << "as far one way as the other";
}

TEST(HidReportSizes, AreThoseOfTheLongestReportInEachDirection) {
  using Sizes = usb::HidReportSizes;
  // Report 1: six bytes in; report 2: three times 16 bits in and a byte out; a long item of two bytes between
  // them.
  const std::vector<std::uint8_t> descriptor{0x85, 0x01, 0x75, 0x08, 0x95, 0x05, 0x81, 0x02, 0x95, 0x01, 0x81,
                                             0x03, 0xFE, 0x02, 0x10, 0xAA, 0xBB, 0x85, 0x02, 0x75, 0x10, 0x96,
                                             0x03, 0x00, 0x81, 0x02, 0x75, 0x01, 0x95, 0x07, 0x91, 0x02};
  EXPECT_EQ(usb::hid_report_sizes(descriptor), (Sizes{6, 1}));
  EXPECT_EQ(usb::hid_report_sizes(std::span(descriptor).first(8)), (Sizes{5, 0}));
  EXPECT_EQ(usb::hid_report_sizes({}), (Sizes{0, 0}));
  // What no device says must not take long or read beyond its end.
  std::mt19937 random(5);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> noise(static_cast<std::size_t>(i % 64));
    for (auto& one : noise) one = static_cast<std::uint8_t>(byte(random));
    EXPECT_LE(usb::hid_report_sizes(noise).input, 8192U);
  }
}

TEST(SpaceMouseProtocol, ReadsTheReportsOfItsCapture) {
  spacemouse::State state;
  EXPECT_TRUE(
      spacemouse::take_report(std::vector<std::uint8_t>{0x02, 0x00, 0x00, 0xE2, 0xFF, 0x00, 0x00}, state));
  EXPECT_EQ(state.axis[4], -30);
  EXPECT_TRUE(spacemouse::take_report(std::vector<std::uint8_t>{0x03, 0x01, 0x00}, state));
  EXPECT_EQ(state.buttons, 1U);
  EXPECT_TRUE(spacemouse::take_report(
      std::vector<std::uint8_t>{0x01, 0x5E, 0x01, 0xA2, 0xFE, 1, 0, 2, 0, 3, 0, 4, 0}, state))
      << "newer models send all six at once";
  EXPECT_THAT(state.axis, ElementsAre(350, -350, 1, 2, 3, 4));
  const spacemouse::State before = state;
  for (const auto& bad : {std::vector<std::uint8_t>{}, {0x01, 0x02}, {0x17, 0x50}, {0x03}}) {
    EXPECT_FALSE(spacemouse::take_report(bad, state));
    EXPECT_EQ(state, before);
  }
}

TEST(LabJackProtocol, SealsACommandAsItsVendorDoes) {
  // Sums by hand: bytes 6 on are 06 00 06 00 00 00 A0 0F and six channels 00 80, 02 80, ... 0A 80.
  std::vector<labjack_u6::Channel> channels;
  for (std::uint8_t i = 0; i < 6; ++i)
    channels.push_back({.number = static_cast<std::uint8_t>(2 * i), .differential = true});
  const auto config = labjack_u6::stream_config(channels, 1000.0);
  ASSERT_TRUE(config);
  EXPECT_EQ(config->size, 26U);
  const int sum = 6 + 6 + 0xA0 + 0x0F + (0 + 2 + 4 + 6 + 8 + 10) + 6 * 0x80;
  EXPECT_EQ(config->bytes[4] + 256 * config->bytes[5], sum);
  EXPECT_TRUE(labjack_u6::is_sealed(config->view()));
  EXPECT_EQ(config->bytes[12] + 256 * config->bytes[13], 4000);
  EXPECT_FALSE(labjack_u6::stream_config(channels, 20.0)) << "its interval has 16 bits";
  EXPECT_FALSE(labjack_u6::stream_config(channels, 10000.0)) << "60 kS/s";
  EXPECT_FALSE(labjack_u6::stream_config({}, 1000.0));
  channels.resize(labjack_u6::max_scan_channels);
  EXPECT_TRUE(labjack_u6::stream_config(channels, 1000.0));
  channels.emplace_back();
  EXPECT_FALSE(labjack_u6::stream_config(channels, 1000.0));
}

labjack_u6::StreamPacket packet_of(std::uint8_t counter, std::uint64_t first, std::size_t samples) {
  labjack_u6::StreamPacket packet{.counter = counter, .samples = samples};
  for (std::size_t i = 0; i < samples; ++i) packet.sample[i] = static_cast<std::uint16_t>(first + i);
  return packet;
}

TEST(LabJackProtocol, RefusesAPacketWithAnyBitTurned) {
  const auto good = labjack_u6::encode(packet_of(3, 1000, 6));
  ASSERT_TRUE(labjack_u6::parse_stream(good.view()));
  EXPECT_EQ(good.size, 26U);
  for (std::size_t bit = 0; bit < 8 * good.size; ++bit) {
    auto bad = good;
    bad.bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << (bit % 8));
    EXPECT_FALSE(labjack_u6::parse_stream(bad.view())) << bit;
  }
  for (std::size_t size = 0; size < good.size; ++size)
    EXPECT_FALSE(labjack_u6::parse_stream(good.view().first(size)));
}

TEST(LabJackProtocol, LostPacketsAreGapsAndNeverShiftAChannel) {
  // Four channels in packets of six samples: scans lie across packets. Sample n carries n.
  for (unsigned lost = 1; lost < 256; lost += 7) {
    labjack_u6::ScanAssembler assembler(4, 6);
    const auto check = [&](std::uint64_t scan, std::span<const std::uint16_t> samples) {
      for (std::size_t channel = 0; channel < 4; ++channel) {
        ASSERT_EQ(samples[channel], static_cast<std::uint16_t>(4 * scan + channel));
      }
    };
    for (std::uint64_t packet = 0; packet < 400; ++packet) {
      if (packet >= 10 && packet < 10U + lost) continue;
      assembler.take(packet_of(static_cast<std::uint8_t>(packet), 6 * packet, 6), check);
    }
    EXPECT_NEAR(static_cast<double>(assembler.lost()), 6.0 * lost / 4.0, 1.6);
    EXPECT_EQ(assembler.scans() + assembler.lost(), 600U);
  }
}

TEST(LabJackProtocol, AnOverflowOfTheDeviceBecomesAGapOfItsOwnCount) {
  labjack_u6::ScanAssembler assembler(6, 6);
  std::vector<std::uint64_t> scans;
  const auto note = [&](std::uint64_t scan, std::span<const std::uint16_t>) { scans.push_back(scan); };
  assembler.take(packet_of(0, 0, 6), note);
  auto overflow = packet_of(1, 6, 6);
  overflow.error = 59;
  assembler.take(overflow, note);
  auto report = packet_of(2, 0, 6);
  report.error = 60;
  report.time_stamp = 100;
  assembler.take(report, note);
  assembler.take(packet_of(3, 0, 6), note);
  EXPECT_THAT(scans, ElementsAre(0U, 1U, 102U));
  EXPECT_EQ(assembler.lost(), 100U);
  auto hopeless = packet_of(4, 0, 6);
  hopeless.error = 63;
  assembler.take(hopeless, note);
  EXPECT_TRUE(assembler.broken());
}

TEST(LabJackProtocol, TurnsCodesIntoVolts) {
  const labjack_u6::Calibration nominal;
  EXPECT_EQ(nominal.volts(33523), 0.0);
  EXPECT_NEAR(nominal.volts(65535), 10.1093, 1e-3);
  EXPECT_NEAR(nominal.volts(0), -10.5868, 1e-3);
  const std::array<std::uint8_t, 8> minus_half{0, 0, 0, 0x80, 0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(labjack_u6::fixed_point(minus_half), -0.5);
}

}  // namespace
}  // namespace kerf::drivers

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kerf/drivers/protocols/frame_reader.h"
#include "kerf/drivers/protocols/serial_force.h"

namespace kerf::drivers {
namespace {

using testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

/// How many frames a reader finds, and how often it was out of step.
template <typename Protocol>
std::pair<int, int> found_in(const Bytes& bytes, std::size_t piece) {
  FrameReader<Protocol> reader;
  std::pair<int, int> found{0, 0};
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    reader.take(
        std::span(bytes).subspan(at, std::min(piece, bytes.size() - at)),
        [&](std::span<const std::uint8_t>) { ++found.first; }, [&] { ++found.second; });
  }
  return found;
}

Bytes repeated(const Bytes& bytes, int times) {
  Bytes all;
  for (int i = 0; i < times; ++i) all.insert(all.end(), bytes.begin(), bytes.end());
  return all;
}

// fx of 1 N, the rest 0, 1000 us, 25 degC; the sum by hand of CRC-16/X.25, whose check value is 906E.
Bytes bota_frame() {
  Bytes bytes{0xAA, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3F};
  bytes.resize(27);
  for (const int byte : {0xE8, 0x03, 0x00, 0x00, 0x00, 0x00, 0xC8, 0x41})
    bytes.push_back(static_cast<std::uint8_t>(byte));
  unsigned crc = 0xFFFF;
  for (std::size_t i = 1; i < bytes.size(); ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0x8408U : crc >> 1U;
  }
  crc ^= 0xFFFFU;
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return bytes;
}

TEST(SerialForceProtocols, ABotaFrameHasAWrenchAStampAndATemperature) {
  const Bytes bytes = bota_frame();
  ASSERT_EQ(bytes.size(), 37U);
  ASSERT_TRUE(bota::Protocol::is_sound(bytes));
  const bota::Frame frame = bota::parse(bytes);
  EXPECT_EQ(frame.wrench[0], 1.0F);
  EXPECT_EQ(frame.wrench[5], 0.0F);
  EXPECT_EQ(frame.stamp_us, 1000U);
  EXPECT_EQ(frame.temperature, 25.0F);
  for (std::size_t i = 1; i < bytes.size(); ++i) {
    Bytes turned = bytes;
    turned[i] ^= 0x01U;
    EXPECT_FALSE(bota::Protocol::is_sound(turned)) << i;
  }
}

TEST(SerialForceProtocols, ABotaFrameSaysWhetherItMeasures) {
  bota::Frame frame;
  EXPECT_EQ(bota::health_of(frame), ForceHealth::sound);
  frame.status = 1;
  EXPECT_EQ(bota::health_of(frame), ForceHealth::sound) << "slow, but measured";
  frame.status = 2;
  EXPECT_EQ(bota::health_of(frame), ForceHealth::overload);
  frame.status = 4;
  EXPECT_EQ(bota::health_of(frame), ForceHealth::doubted);
  frame.status = 8;
  EXPECT_EQ(bota::health_of(frame), ForceHealth::doubted) << "raw values are no newtons";
  frame.status = 0;
  frame.wrench[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(bota::health_of(frame), ForceHealth::doubted);
  EXPECT_EQ(bota::in_words(6), "out of its range, saturation, a short or an open gauge");
}

TEST(SerialForceProtocols, ABotaHasRatesByTheLengthOfItsFilter) {
  EXPECT_EQ(bota::sinc_length(100.0), 512);
  EXPECT_EQ(bota::sinc_length(800.0), 64);
  EXPECT_EQ(bota::sinc_length(1000.0), 51);
  EXPECT_FALSE(bota::sinc_length(1100.0));
  EXPECT_FALSE(bota::sinc_length(50.0));
  EXPECT_EQ(bota::baud_code(460800), 4);
  EXPECT_FALSE(bota::baud_code(1200));
}

// What a client was seen to send: speed 1, filter 2, zero.
TEST(SerialForceProtocols, AnOptoforceIsSetByNineBytes) {
  EXPECT_THAT(optoforce::configuration(1, 2, true),
              ElementsAre(0xAA, 0x00, 0x32, 0x03, 0x01, 0x02, 0xFF, 0x01, 0xE1));
}

TEST(SerialForceProtocols, AnOptoforceFrameHasThreeForcesOrAWrench) {
  const Bytes three{0xAA, 0x07, 0x08, 0x0A, 0x12, 0x34, 0x00, 0x00,
                    0x00, 0x64, 0xFF, 0x9C, 0x00, 0x00, 0x03, 0x08};
  ASSERT_EQ(optoforce::Protocol::size_of(std::span(three).first(4)), 16U);
  ASSERT_TRUE(optoforce::Protocol::is_sound(three));
  const optoforce::Frame frame = optoforce::parse(three);
  EXPECT_EQ(frame.counter, 0x1234);
  EXPECT_EQ(frame.components, 3U);
  EXPECT_THAT(frame.counts, ElementsAre(100, -100, 0, 0, 0, 0));
  const Bytes six_head{0xAA, 0x07, 0x08, 0x10};
  EXPECT_EQ(optoforce::Protocol::size_of(six_head), 22U);
  const Bytes four_fingers{0xAA, 0x07, 0x08, 0x1C};
  EXPECT_FALSE(optoforce::Protocol::size_of(four_fingers));
}

// The sum is CRC-16/Modbus, of which the check value is 4B37.
TEST(SerialForceProtocols, AnFt300FrameIsInHundredthsAndThousandths) {
  Bytes bytes{0x20, 0x4E, 0x64, 0x00, 0x9C, 0xFF, 0x00, 0x00, 0xE8, 0x03, 0x18, 0xFC, 0x00, 0x00};
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U;
  }
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
  ASSERT_TRUE(ft300::Protocol::is_sound(bytes));
  EXPECT_THAT(ft300::parse(bytes), ElementsAre(1.0, -1.0, 0.0, 1.0, -1.0, 0.0));
}

TEST(FrameReader, FindsFramesInPiecesOfAnySize) {
  const Bytes bytes = repeated(bota_frame(), 20);
  for (const std::size_t piece : {1U, 7U, 37U, 100U, 740U})
    EXPECT_EQ(found_in<bota::Protocol>(bytes, piece), std::pair(20, 0)) << piece;
}

TEST(FrameReader, LosesOneFrameForATurnedOrALostByte) {
  Bytes turned = repeated(bota_frame(), 10);
  turned[4 * 37 + 9] ^= 0x40U;
  EXPECT_EQ(found_in<bota::Protocol>(turned, 11), std::pair(9, 1));
  Bytes lost = repeated(bota_frame(), 10);
  lost.erase(lost.begin() + 4 * 37 + 9);
  EXPECT_EQ(found_in<bota::Protocol>(lost, 11), std::pair(9, 1));
  Bytes more = repeated(bota_frame(), 10);
  more.insert(more.begin() + 4 * 37, 5, 0xAA);
  EXPECT_EQ(found_in<bota::Protocol>(more, 11), std::pair(10, 1));
}

TEST(FrameReader, BeginsInTheMiddleOfAFrame) {
  Bytes bytes = repeated(bota_frame(), 10);
  bytes.erase(bytes.begin(), bytes.begin() + 20);
  EXPECT_EQ(found_in<bota::Protocol>(bytes, 3), std::pair(9, 0))
      << "what it did not see begin is nothing wrong";
}

}  // namespace
}  // namespace kerf::drivers

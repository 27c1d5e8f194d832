#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/protocols/c2000_image.h>
#include <kerf/drivers/protocols/falcon.h>
#include <kerf/mechanisms/falcon.h>

#include "devices/falcon.h"
#include "devices/ftdi.h"

namespace kerf::emulators {
namespace {

namespace c2000 = drivers::c2000;
namespace wire = drivers::falcon;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t millisecond = 1'000'000;

TEST(C2000Image, IsAStreamOfWordsWithTheLowByteFirst) {
  const c2000::Block block{.destination = 0x3F8002, .words = {0x1234, 0x00FF}};
  EXPECT_THAT(
      c2000::make_image(0x3F8002, std::array{block}),
      ElementsAre(0xAA, 0x08, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x3F, 0x00, 0x02, 0x80,  //
                  0x02, 0x00, 0x3F, 0x00, 0x02, 0x80, 0x34, 0x12, 0xFF, 0x00, 0x00, 0x00));
}

TEST(C2000Image, IsReadToItsLastByteAndNoFurther) {
  const std::array blocks{c2000::Block{.destination = 0x3F8002, .words = {1, 2, 3}},
                          c2000::Block{.destination = 0x000400, .words = {4}}};
  const auto image = c2000::make_image(0x3F8002, blocks);
  EXPECT_EQ(c2000::problem_of(image), "");
  c2000::Stream stream;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const bool last = i + 1 == image.size();
    EXPECT_EQ(stream.take(image[i]), last ? c2000::Stream::State::finished : c2000::Stream::State::reading)
        << i;
  }
  EXPECT_EQ(stream.words(), 4U);
  EXPECT_EQ(stream.entry(), 0x3F8002U);
  for (std::size_t size = 1; size < image.size(); ++size) {
    EXPECT_EQ(c2000::problem_of(std::span(image).first(size)), "it ends too early");
  }
  auto longer = image;
  longer.push_back(0);
  EXPECT_EQ(c2000::problem_of(longer), "something follows its end");
}

TEST(C2000Image, SaysWhatIsWrongWithAFile) {
  EXPECT_EQ(c2000::problem_of({}), "it is empty");
  const std::array<std::uint8_t, 4> page{'<', 'h', 't', 'm'};
  EXPECT_THAT(std::string(c2000::problem_of(page)), HasSubstr("key 0x08AA"));
  EXPECT_EQ(c2000::problem_of(c2000::make_image(0x3F8002, {})), "it holds no program");
  const std::array far{c2000::Block{.destination = 0x3FFFFF, .words = {1, 2}}};
  EXPECT_THAT(std::string(c2000::problem_of(c2000::make_image(0x3F8002, far))), HasSubstr("outside"));
  const std::array fits{c2000::Block{.destination = 0x3FFFFF, .words = {1}}};
  EXPECT_EQ(c2000::problem_of(c2000::make_image(0x3F8002, fits)), "");
  EXPECT_THAT(std::string(c2000::problem_of(c2000::make_image(0x400000, fits))), HasSubstr("entry point"));
}

Setup request(std::uint8_t number, std::uint16_t value) {
  return {.request_type = 0x40, .request = number, .value = value, .index = 0, .length = 0};
}

TEST(Ftdi, DividesItsClock) {
  Ftdi bridge;
  Ftdi::Event event{};
  const auto baud = [&](std::uint16_t value) {
    EXPECT_TRUE(bridge.control(request(3, value), event));
    return bridge.baud();
  };
  EXPECT_DOUBLE_EQ(baud(0x4138), 9600.0);
  EXPECT_DOUBLE_EQ(baud(0x0015), 3e6 / 21.0);
  EXPECT_DOUBLE_EQ(baud(0x0002), 1.5e6);
  EXPECT_DOUBLE_EQ(baud(0x0000), 3e6);
  EXPECT_DOUBLE_EQ(baud(0x0001), 2e6);
  EXPECT_FALSE(bridge.control(request(0x33, 0), event));
}

TEST(Ftdi, AnswersWhenTheTimerExpiresOrAPacketIsFull) {
  Ftdi bridge;
  Ftdi::Event event{};
  (void)bridge.control(request(9, 1), event);
  std::array<std::uint8_t, 64> buffer{};
  Disturbance none = Disturbance::none;
  // Nothing to say: the status alone, a millisecond after the transfer came.
  EXPECT_FALSE(bridge.send(buffer, 1000, millisecond, none));
  EXPECT_EQ(bridge.next_event_ns(), millisecond + 1000);
  EXPECT_EQ(bridge.send(buffer, 1000, millisecond + 1000, none), 2U);
  EXPECT_EQ(buffer[0], 0x01);
  EXPECT_EQ(buffer[1], 0x60);
  // A few bytes wait for the timer; 62 do not.
  const std::vector<std::uint8_t> bytes(61, 7);
  bridge.put(bytes, 0);
  EXPECT_FALSE(bridge.send(buffer, 0, 500'000, none));
  bridge.put(std::array<std::uint8_t, 1>{8}, 600'000);
  EXPECT_FALSE(bridge.send(buffer, 0, 599'999, none));
  EXPECT_EQ(bridge.next_event_ns(), 600'000);
  EXPECT_EQ(bridge.send(buffer, 0, 600'000, none), 64U);
  EXPECT_EQ(buffer[63], 8);
}

TEST(Ftdi, NeverAnswersMoreThanTheTransferHolds) {
  Ftdi bridge;
  Disturbance none = Disturbance::none;
  const std::vector<std::uint8_t> bytes(100, 7);
  bridge.put(bytes, 0);
  std::array<std::uint8_t, 3> three{};
  EXPECT_EQ(bridge.send(three, 0, 0, none), 3U);
  // 99 are left: a long transfer has the status bytes again in its second packet.
  std::array<std::uint8_t, 512> much{};
  EXPECT_EQ(bridge.send(much, 0, 0, none), 64U + 2U + 37U);
  EXPECT_THAT(std::span(much).subspan(2, 62), Each(7));
  EXPECT_EQ(much[64], 0x01);
  EXPECT_EQ(much[65], 0x60);
  EXPECT_THAT(std::span(much).subspan(66, 37), Each(7));
}

/// The host's end of an emulated Falcon: time goes on as transfers need it.
class Host {
 public:
  explicit Host(const std::string& uri = "falcon")
      : device_(EmulatedFalcon::parse_options(drivers::parse_uri(uri))) {}

  void control(std::uint8_t number, std::uint16_t value) {
    EXPECT_TRUE(device_.control(request(number, value), {}, now_ns));
  }
  void send(std::span<const std::uint8_t> bytes) { device_.receive(2, bytes, now_ns); }
  void send(std::string_view text) {
    send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  /// One transfer, with its status bytes.
  Bytes receive(std::size_t size = 64, Disturbance disturbance = Disturbance::none) {
    Bytes buffer(size);
    const std::int64_t since_ns = now_ns;
    while (true) {
      if (const auto got = device_.send(1, buffer, since_ns, now_ns, disturbance)) {
        buffer.resize(*got);
        return buffer;
      }
      now_ns = device_.next_event_ns(now_ns).value();
    }
  }
  std::optional<wire::Report> ask(const wire::Command& command) {
    send(wire::encode(command));
    std::optional<wire::Report> report;
    wire::for_each_data_byte(receive(), [&](std::uint8_t byte) {
      if (const auto frame = reader.take(byte)) report = wire::parse_report(*frame);
    });
    return report;
  }
  void run_mode() {
    control(9, 1);
    control(3, 0x0002);
    control(0, 1);
    control(0, 2);
  }
  void hello_mode() {
    control(9, 16);
    control(3, 0x4138);
    control(1, 0x0100);
    control(1, 0x0101);
  }
  [[nodiscard]] std::string tell() const { return device_.tell(); }

  std::int64_t now_ns = 5'000'000'000;
  wire::FrameReader reader;

 private:
  EmulatedFalcon device_;
};

Bytes image_of(std::size_t words) {
  c2000::Block block{.destination = 0x3F8002, .words = {}};
  for (std::size_t i = 0; i < words; ++i) block.words.push_back(static_cast<std::uint16_t>(257 * i + 1));
  return c2000::make_image(0x3F8002, std::array{block});
}

void begin_loading(Host& host) {
  host.hello_mode();
  host.send("\x0A\x43\x0D");
  // One packet, whole: 7 bytes take 7.3 ms on the line, less than the 16 of the timer.
  EXPECT_THAT(host.receive(512), ElementsAre(0x01, 0x60, 0x0A, 0x44, 0x2C, 0x0D));
  host.control(1, 0x0100);
  host.control(3, 0x0015);
  host.send("A");
  EXPECT_THAT(host.receive(3), ElementsAre(0x01, 0x60, 0x41));
}

TEST(EmulatedFalcon, IsSilentWithoutFirmwareButForTheHello) {
  Host host;
  host.run_mode();
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(host.ask({.homing = true}));
  // Without the edge of DTR, and at another speed, there is no hello either.
  host.control(3, 0x4138);
  host.send("\x0A\x43\x0D");
  EXPECT_THAT(host.receive(), ElementsAre(0x01, 0x60));
  host.hello_mode();
  host.control(3, 0x0015);
  host.send("\x0A\x43\x0D");
  EXPECT_THAT(host.receive(), ElementsAre(0x01, 0x60));
}

TEST(EmulatedFalcon, EchoesAnImageAndRunsIt) {
  Host host;
  begin_loading(host);
  const Bytes image = image_of(300);
  for (std::size_t at = 0; at < image.size(); at += 62) {
    const auto block = std::span(image).subspan(at, std::min<std::size_t>(62, image.size() - at));
    const std::int64_t before_ns = host.now_ns;
    host.send(block);
    const Bytes back = host.receive(block.size() + 2);
    ASSERT_EQ(back.size(), block.size() + 2);
    EXPECT_TRUE(std::equal(block.begin(), block.end(), back.begin() + 2));
    // 62 bytes of 10 bits at 142 857 baud.
    if (block.size() == 62) {
      EXPECT_NEAR(1e-9 * static_cast<double>(host.now_ns - before_ns), 4.34e-3, 1e-5);
    }
  }
  host.run_mode();
  EXPECT_TRUE(host.ask({}));
  // It is still there for the next program; a new hello takes it away.
  host.run_mode();
  EXPECT_TRUE(host.ask({}));
  begin_loading(host);
  host.run_mode();
  EXPECT_FALSE(host.ask({}));
}

TEST(EmulatedFalcon, DoesNotRunHalfAnImageNorNoImage) {
  for (const bool half : {true, false}) {
    Host host;
    begin_loading(host);
    Bytes image = image_of(10);
    if (half) image.resize(image.size() - 1);
    if (!half) image[0] ^= 1U;
    host.send(image);
    (void)host.receive();
    host.run_mode();
    EXPECT_FALSE(host.ask({}));
    EXPECT_EQ(host.tell().find("key 0x08AA") != std::string::npos, !half);
  }
}

TEST(EmulatedFalcon, IsPacedByTheLatencyTimer) {
  Host host("falcon?firmware=loaded");
  host.run_mode();
  const std::int64_t start_ns = host.now_ns;
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(host.ask({}));
  EXPECT_EQ(host.now_ns - start_ns, 1000 * millisecond);
}

TEST(EmulatedFalcon, AReplyTakesItsTimeOnTheLine) {
  // 0.15 ms before the timer expires is too late for this packet, 0.2 ms are not.
  for (const bool late : {true, false}) {
    EmulatedFalcon device(EmulatedFalcon::parse_options(drivers::parse_uri("falcon?firmware=loaded")));
    (void)device.control(request(9, 1), {}, 0);
    (void)device.control(request(3, 0x0002), {}, 0);
    device.receive(2, wire::encode(wire::Command{}), late ? 850'000 : 800'000);
    Bytes buffer(64);
    Disturbance none = Disturbance::none;
    EXPECT_FALSE(device.send(1, buffer, 0, millisecond - 1, none));
    EXPECT_EQ(device.send(1, buffer, 0, millisecond, none), late ? 2U : 18U);
  }
}

TEST(EmulatedFalcon, TellsTheCountsOfItsPlace) {
  Host host("falcon?firmware=loaded&homed=on&sway=0m");
  host.run_mode();
  const auto at_rest = host.ask({.homing = true});
  ASSERT_TRUE(at_rest);
  // (0, 0, 0.12): published counts.
  EXPECT_THAT(at_rest->encoder, ElementsAre(-304, -304, -304));
  EXPECT_THAT(at_rest->homed, Each(true));
  // 3 N out of three equal motors, -251 units for each; the hand gives 300 N/m and 0.1 N of friction.
  std::optional<wire::Report> report;
  for (int i = 0; i < 3000; ++i) report = host.ask({.motor = {-753, -753, -753}, .homing = true});
  ASSERT_TRUE(report);
  const auto knob =
      mechanisms::Falcon::knob(mechanisms::Falcon::shoulder_of(report->encoder), {0.0, 0.0, 0.12});
  ASSERT_TRUE(knob);
  EXPECT_NEAR(knob->z(), 0.12 + 3.0 / 300.0, 0.1 / 300.0 + 1e-4);
  EXPECT_NEAR(knob->x(), 0.0, 1e-4);
}

TEST(EmulatedFalcon, IsHomedByAHandAndNotForEver) {
  Host host("falcon?firmware=loaded&offset=500");
  host.run_mode();
  // Relative to power-on, with an offset, until the hand has led the knob out and in.
  EXPECT_THAT(host.ask({.homing = true})->encoder, Each(testing::Ge(495)));
  int highest = 0;
  std::optional<wire::Report> report;
  for (int i = 0; i < 299; ++i) {
    report = host.ask({.homing = true});
    EXPECT_THAT(report->homed, Each(false)) << i;
    highest = std::max(highest, report->encoder[0]);
  }
  EXPECT_GT(highest, 600);
  (void)host.ask({.homing = true});
  report = host.ask({.homing = true});
  EXPECT_THAT(report->homed, Each(true));
  EXPECT_LT(report->encoder[0], 200);
  EXPECT_THAT(host.ask({})->homed, Each(false));
}

TEST(EmulatedFalcon, ClampsItsMotorsAndCountsIt) {
  Host host("falcon?firmware=loaded");
  host.run_mode();
  // As somebody put on the wire who does not clamp: -11005, nibbles 3, 0, 5, D.
  wire::Frame frame = wire::encode(wire::Command{});
  frame[1] = 0x41 + 0x3;
  frame[2] = 0x41 + 0x0;
  frame[3] = 0x41 + 0x5;
  frame[4] = 0x41 + 0xD;
  host.send(frame);
  (void)host.receive();
  EXPECT_THAT(host.tell(), HasSubstr("1 frames answered, 1 motor values clipped"));
}

TEST(EmulatedFalcon, LosesAndTearsRepliesWhenAsked) {
  Host host("falcon?firmware=loaded");
  host.run_mode();
  const auto frame = wire::encode(wire::Command{});
  host.send(frame);
  EXPECT_EQ(host.receive(64, Disturbance::drop).size(), 2U);
  host.send(frame);
  EXPECT_EQ(host.receive(64, Disturbance::split).size(), 2U + 8U);
  EXPECT_EQ(host.receive().size(), 2U + 8U);
  host.send(frame);
  EXPECT_EQ(host.receive(64, Disturbance::corrupt).size(), 2U + 15U);
  EXPECT_THAT(host.tell(), HasSubstr("17 bytes purged or lost"));
}

}  // namespace
}  // namespace kerf::emulators

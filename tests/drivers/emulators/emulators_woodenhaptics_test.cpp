#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/drivers/usb/hid_device.h>
#include <kerf/drivers/woodenhaptics_signs.h>
#include <kerf/mechanisms/woodenhaptics.h>

#include "devices/woodenhaptics.h"
#include "support/program.h"

namespace kerf::emulators {
namespace {

using drivers::woodenhaptics::Generation;
using drivers::woodenhaptics::Report;
using mechanisms::WoodenHaptics;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t begin = 5'000 * ms;  // of a clock that has gone for a while

EmulatedWoodenHaptics::Options options_of(const std::string& options) {
  return EmulatedWoodenHaptics::parse_options(drivers::parse_uri("woody?" + options));
}

/// A host that speaks to the emulator at times of its choice.
class Host {
 public:
  explicit Host(const std::string& options)
      : options_(options_of(options)), generation_(options_.generation), device_(options_) {}

  /// What a waiting transfer gets at that time, if anything.
  std::optional<Bytes> poll(std::int64_t at, Disturbance disturbance = Disturbance::none) {
    Bytes buffer(64);
    const std::uint8_t endpoint = generation_ == Generation::v3 ? 3 : 1;
    const auto size = device_.send(endpoint, buffer, at, begin + at, disturbance);
    if (!size) return std::nullopt;
    buffer.resize(*size);
    return buffer;
  }
  std::optional<Report> report(std::int64_t at) {
    const auto bytes = poll(at);
    return bytes ? drivers::woodenhaptics::parse_report(*bytes, generation_) : std::nullopt;
  }
  void order(const std::array<int, 3>& current_ma, std::int64_t at) {
    send(drivers::woodenhaptics::set_currents(current_ma, generation_), at);
  }
  void preset(const std::array<int, 6>& counts, std::int64_t at) {
    send(*drivers::woodenhaptics::preset_counters(counts, generation_), at);
  }
  EmulatedWoodenHaptics& device() { return device_; }
  const WoodenHaptics::Configuration& model() const { return *options_.model; }
  /// As the driver takes it, which has signs of its own.
  WoodenHaptics as_driven() const {
    return {*options_.model, drivers::woodenhaptics::signs_of(generation_, *options_.model).value()};
  }

 private:
  void send(const drivers::woodenhaptics::Output& output, std::int64_t at) {
    device_.receive(generation_ == Generation::v3 ? 4 : 1,
                    std::span(output.bytes).subspan(1, output.size - 1), begin + at);
  }

  EmulatedWoodenHaptics::Options options_;
  Generation generation_;
  EmulatedWoodenHaptics device_;
};

TEST(EmulatedWoodenHaptics, DescribesReportsOfTheLengthOfItsGeneration) {
  const auto sizes = [](const std::string& options) {
    return drivers::usb::hid_report_sizes(
        EmulatedWoodenHaptics(options_of(options)).description().reports[0]);
  };
  EXPECT_EQ(sizes("generation=v1"), (drivers::usb::HidReportSizes{8, 8}));
  EXPECT_EQ(sizes("generation=v2"), (drivers::usb::HidReportSizes{14, 14}));
  EXPECT_EQ(sizes("generation=v3"), (drivers::usb::HidReportSizes{64, 64}));
  const EmulatedWoodenHaptics teensy(options_of("generation=v3"));
  EXPECT_EQ(teensy.description().vendor(), 0x16C0);
  EXPECT_EQ(teensy.description().product(), 0x0486);
  EXPECT_EQ(drivers::usb::hid_report_sizes(teensy.description().reports[1]),
            (drivers::usb::HidReportSizes{64, 32}));
  // Each configuration is as long as it says.
  for (const char* generation : {"generation=v1", "generation=v2", "generation=v3"}) {
    const EmulatedWoodenHaptics device(options_of(generation));
    const Bytes& configuration = device.description().configuration;
    EXPECT_EQ(configuration[2] | configuration[3] << 8, configuration.size());
    EXPECT_EQ(device.description().device.size(), 18U);
  }
}

TEST(EmulatedWoodenHaptics, V1SendsAReportEachMillisecondByItself) {
  Host host("generation=v1");
  int reports = 0;
  for (std::int64_t at = 0; at < 100 * ms; at += ms / 10) {
    const auto report = host.report(at);
    if (!report) continue;
    EXPECT_EQ(report->counter, reports);
    ++reports;
  }
  EXPECT_EQ(reports, 100);
}

TEST(EmulatedWoodenHaptics, V1AppliesTheOldestOrderInEachTurn) {
  Host host("generation=v1");
  ASSERT_TRUE(host.poll(0));
  host.order({100, 0, 0}, ms / 4);
  host.order({200, 0, 0}, ms / 2);
  EXPECT_EQ(host.device().current_ma()[0], 0) << "an order waits for the turn";
  ASSERT_TRUE(host.poll(ms));
  EXPECT_EQ(host.device().current_ma()[0], 100);
  ASSERT_TRUE(host.poll(2 * ms));
  EXPECT_EQ(host.device().current_ma()[0], 200);
}

TEST(EmulatedWoodenHaptics, V2AndV3SendOneReportAndWaitForAnOrder) {
  for (const char* generation : {"generation=v2", "generation=v3"}) {
    Host host(generation);
    ASSERT_TRUE(host.poll(0));
    for (std::int64_t at = 0; at < 100 * ms; at += ms) EXPECT_FALSE(host.poll(at)) << "nobody gave an order";
    host.order({}, 100 * ms);
    EXPECT_TRUE(host.poll(100 * ms));
    host.order({}, 100 * ms + 1);
    EXPECT_FALSE(host.poll(100 * ms + 2)) << "one report a frame";
    EXPECT_TRUE(host.poll(101 * ms));
  }
}

TEST(EmulatedWoodenHaptics, V2AppliesTheNewestOfSeveralOrders) {
  Host host("generation=v2");
  // Its first report is not fetched yet: the orders wait, and the newest wins.
  host.order({100, 0, 0}, 0);
  host.order({200, 0, 0}, 1);
  EXPECT_EQ(host.device().current_ma()[0], 0);
  ASSERT_TRUE(host.poll(2));
  EXPECT_EQ(host.device().current_ma()[0], 200);
}

TEST(EmulatedWoodenHaptics, WithoutAnOrderForHalfASecondTheMotorsHaveNoCurrent) {
  for (const char* generation : {"generation=v1", "generation=v2", "generation=v3"}) {
    Host host(generation);
    (void)host.poll(0);
    host.order({0, 0, 500}, ms / 2);
    (void)host.poll(ms);
    EXPECT_EQ(host.device().current_ma()[2], 500) << generation;
    (void)host.poll(500 * ms);
    EXPECT_EQ(host.device().current_ma()[2], 500) << generation;
    EXPECT_NE(host.device().force().norm(), 0.0);
    (void)host.poll(502 * ms);
    EXPECT_THAT(host.device().current_ma(), ElementsAre(0, 0, 0)) << generation;
    EXPECT_EQ(host.device().watchdog_trips(), 1U);
    (void)host.poll(503 * ms);
    EXPECT_EQ(host.device().force().norm(), 0.0);
  }
}

TEST(EmulatedWoodenHaptics, CountersWrapAtSixteenBits) {
  Host host("generation=v2&counter_offset=32767");
  int least = 0;
  int most = 0;
  for (std::int64_t at = 0; at < 2000 * ms; at += ms) {
    if (const auto report = host.report(at)) {
      least = std::min(least, report->encoder[1]);
      most = std::max(most, report->encoder[1]);
    }
    host.order({}, at);
  }
  // The hand sways to both sides of home, where the counter is about to wrap.
  EXPECT_LT(least, -32000);
  EXPECT_GT(most, 32000);
}

TEST(EmulatedWoodenHaptics, ItsCountersStandStillWhileTheyStick) {
  Host host("generation=v1");
  const auto a = [&](std::int64_t at) { return host.report(at)->encoder[1]; };
  host.device().stick(true);
  const int stuck = a(100 * ms);
  host.device().stick(true);
  EXPECT_EQ(a(600 * ms), stuck);
  host.device().stick(false);
  EXPECT_NE(a(601 * ms), stuck);
}

TEST(EmulatedWoodenHaptics, PresetsItsCountersAndForgetsTheButton) {
  Host host("generation=v2&button=0.1s&sway=0m");
  ASSERT_TRUE(host.poll(0));
  host.order({10, 20, 30}, 50 * ms);
  EXPECT_FALSE(host.report(50 * ms)->button);
  host.order({10, 20, 30}, 200 * ms);
  EXPECT_TRUE(host.report(200 * ms)->button);
  host.order({10, 20, 30}, 300 * ms);
  EXPECT_TRUE(host.report(300 * ms)->button) << "it is latched";
  host.preset({1, -2, 6000, 40, 50, -60}, 301 * ms);
  EXPECT_THAT(host.device().current_ma(), ElementsAre(0, 0, 0)) << "for that cycle";
  const auto report = host.report(301 * ms);
  EXPECT_THAT(report->encoder, ElementsAre(1, -2, 6000, 40, 50, -60));
  EXPECT_FALSE(report->button);
}

TEST(EmulatedWoodenHaptics, TellsThePoseByItsCounters) {
  for (const char* options :
       {"generation=v1&model=woody-2016", "generation=v2&model=aluhaptics", "generation=v3"}) {
    Host host(options);
    const WoodenHaptics mechanism = host.as_driven();
    double farthest = 0.0;
    for (std::int64_t at = 0; at < 1000 * ms; at += ms) {
      host.order({}, at);
      const auto report = host.report(at);
      if (!report || at < 100 * ms) continue;
      const Eigen::Vector3d told =
          mechanism.tip(mechanism.angles({report->encoder[0], report->encoder[1], report->encoder[2]}));
      // Half a count of each encoder, and up to a millisecond of 0.04 m/s.
      EXPECT_LE((told - host.device().tip()).norm(), 0.13e-3) << options;
      farthest = std::max(farthest, (told - host.model().centre_m).norm());
    }
    EXPECT_GT(farthest, 0.008) << "the hand moves";
  }
}

TEST(EmulatedWoodenHaptics, ItsMotorsPushAsTheDocumentedCheckSays) {
  // At home with 0.0259 N·m/A: 1 N along x is -0.660 A in B, along y 0.591 A in A, along z -0.788 A in C.
  const auto force = [](const std::array<int, 3>& current_ma) {
    Host host("generation=v1&model=woody-2016&sway=0m");
    (void)host.poll(0);
    host.order(current_ma, 0);
    (void)host.poll(ms);
    (void)host.poll(ms + 1);  // a nanosecond after it was applied nothing has moved
    return host.device().force();
  };
  EXPECT_LE((force({0, -660, 0}) - Eigen::Vector3d::UnitX()).norm(), 1e-3);
  EXPECT_LE((force({591, 0, 0}) - Eigen::Vector3d::UnitY()).norm(), 1e-3);
  EXPECT_LE((force({0, 0, -788}) - Eigen::Vector3d::UnitZ()).norm(), 1e-3);
}

TEST(EmulatedWoodenHaptics, ItsMotorsMoveTheHandThatHoldsIt) {
  Host host("generation=v1&model=woody-2016&sway=0m");
  const Eigen::Vector3d home = host.device().tip();
  for (std::int64_t at = 0; at < 1000 * ms; at += ms) {
    (void)host.poll(at);
    host.order({0, 0, -788}, at);
  }
  // 1 N against a hand of 300 N/m, but for friction of 0.1 N that may hold it back, and a Jacobian that turns
  // with it.
  const Eigen::Vector3d moved = host.device().tip() - home;
  EXPECT_NEAR(moved[2], 1.0 / 300.0, 0.1 / 300.0 + 1e-4);
  EXPECT_LE(std::abs(moved[1]), 1e-9);
}

// The one place where the driver's signs, which are those of the makers' host programs, meet the emulator's,
// which are those of firmware and mounting.
TEST(WoodenHapticsSigns, AForceMovesTheTipItsOwnWayAndIsReadSo) {
  int variants = 0;
  for (const std::string generation : {"v1", "v2", "v3"}) {
    for (const auto& model : WoodenHaptics::configurations()) {
      if (generation == "v1" && model.linkage) continue;  // refused on both sides
      ++variants;
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        SCOPED_TRACE(generation + " " + std::string(model.name) + " " + "xyz"[axis]);
        Host host("sway=0m&generation=" + generation + "&model=" + std::string(model.name));
        const WoodenHaptics driven = host.as_driven();
        const Eigen::Vector3d force = 0.4 * Eigen::Vector3d::Unit(axis);
        const Eigen::Vector3d stood = host.device().tip();
        std::optional<Eigen::Vector3d> first;
        Eigen::Vector3d read = stood;
        for (std::int64_t at = 0; at < 300 * ms; at += ms) {
          if (const auto report = host.report(at)) {
            const auto angles = driven.angles({report->encoder[0], report->encoder[1], report->encoder[2]});
            read = driven.tip(angles);
            if (!first) first = read;
            std::array<int, 3> current_ma{};
            const auto currents = driven.currents(force, angles);
            for (std::size_t i = 0; i < 3; ++i) {
              current_ma[i] = static_cast<int>(std::lround(1e3 * currents.ampere[i]));
            }
            host.order(current_ma, at);
          }
        }
        // 0.4 N less 0.1 N of friction at 300 N/m.
        EXPECT_NEAR((host.device().tip() - stood)[axis], 1.1e-3, 0.3e-3);
        EXPECT_NEAR((read - *first)[axis], 1.1e-3, 0.3e-3);
        EXPECT_LE((read - host.device().tip()).norm(), 0.2e-3) << "the same place";
      }
    }
  }
  EXPECT_EQ(variants, 11);
}

// What the makers' programs send and read, for one device of each kind (haptikfabrikenapi; CHAI3D).
TEST(WoodenHapticsSigns, AreThoseOfTheMakersPrograms) {
  const auto& woody = *WoodenHaptics::find("woody-2019");
  const auto moved_by_a = [&](Generation generation) {
    const WoodenHaptics driven(woody, *drivers::woodenhaptics::signs_of(generation, woody));
    return (driven.tip(driven.angles({300, 0, 0})) - driven.home()).y();
  };
  const auto ampere_for_y = [&](Generation generation) {
    const WoodenHaptics driven(woody, *drivers::woodenhaptics::signs_of(generation, woody));
    return driven.currents(Eigen::Vector3d::UnitY(), driven.angles({0, 0, 0})).ampere[0];
  };
  EXPECT_NEAR(moved_by_a(Generation::v1), -14.4e-3, 0.05e-3);
  EXPECT_NEAR(moved_by_a(Generation::v2), 14.4e-3, 0.05e-3);
  EXPECT_NEAR(moved_by_a(Generation::v3), 14.4e-3, 0.05e-3);
  for (const auto generation : {Generation::v1, Generation::v2, Generation::v3}) {
    EXPECT_NEAR(ampere_for_y(generation), 0.048, 0.0005);
  }
}

TEST(EmulatedWoodenHaptics, ItsAmplifiersCutMotorForMotor) {
  Host host("generation=v2");
  (void)host.poll(0);
  host.order({5000, -5000, 1000}, 0);
  EXPECT_THAT(host.device().current_ma(), ElementsAre(3000, -3000, 1000));
  EXPECT_EQ(host.device().cut(), 1U);
}

TEST(EmulatedWoodenHaptics, V3IgnoresAndSendsNoiseBehindItsFourteenBytes) {
  Host host("generation=v3&sway=0m");
  const auto first = host.poll(0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->size(), 64U);
  EXPECT_GT(std::count_if(first->begin() + 14, first->end(), [](std::uint8_t byte) { return byte != 0; }),
            40);
  Bytes order(64, 0xEE);
  const std::array<std::uint8_t, 8> head{0x64, 0x00, 0x9C, 0xFF, 0x00, 0x00, 0x00, 0x00};
  std::copy(head.begin(), head.end(), order.begin());
  host.device().receive(4, order, begin + 1);
  EXPECT_THAT(host.device().current_ma(), ElementsAre(100, -100, 0));
  host.device().receive(2, order, begin + 2);  // of the debugging interface
  Disturbance none = Disturbance::none;
  Bytes buffer(64);
  EXPECT_FALSE(host.device().send(1, buffer, begin, begin + 10 * ms, none));
}

TEST(EmulatedWoodenHaptics, DisturbsAReportWhenAskedTo) {
  Host host("generation=v1&sway=0m");
  ASSERT_TRUE(host.poll(0));
  EXPECT_FALSE(host.poll(ms, Disturbance::drop));
  EXPECT_FALSE(host.poll(ms));
  EXPECT_EQ(host.poll(2 * ms, Disturbance::split)->size(), 3U);
  EXPECT_EQ(host.poll(2 * ms)->size(), 5U);
  const auto turned = host.poll(3 * ms, Disturbance::corrupt);
  EXPECT_EQ(drivers::woodenhaptics::parse_report(*turned, Generation::v1)->encoder[0], 0x4000);
  EXPECT_EQ(host.report(4 * ms)->encoder[0], 0);
  EXPECT_EQ(host.report(5 * ms)->counter, 5) << "the dropped one was counted";
}

TEST(EmulatedWoodenHaptics, WritesATraceOfWhatItDid) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "trace.csv";
  {
    Host host("generation=v2&sway=0m&trace=" + file);
    (void)host.poll(0);
    host.order({100, -200, 300}, ms);
    (void)host.poll(ms);
    (void)host.poll(600 * ms);
  }
  const std::string text = test::read_text(file);
  EXPECT_THAT(
      text,
      HasSubstr("t_s,event,mA_a,mA_b,mA_c,enc_a,enc_b,enc_c,x,y,z,watchdog\n0,report,0,0,0,0,0,0,0.025,"));
  EXPECT_THAT(text, HasSubstr("\n0.001,order,100,-200,300,0,0,0,"));
  EXPECT_THAT(text, HasSubstr("\n0.501,watchdog,0,0,0,"));
}

TEST(EmulatedWoodenHaptics, RefusesWhatItIsNot) {
  const auto refusal = [](const std::string& options) -> std::string {
    try {
      (void)options_of(options);
    } catch (const drivers::DeviceError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("generation=v4"), HasSubstr("expected v1, v2 or v3"));
  EXPECT_THAT(refusal("model=omega"), HasSubstr("expected woody-2016"));
  EXPECT_THAT(refusal("generation=v1&model=polhem-v3"),
              HasSubstr("there is no polhem-v3 with the reports of V1"));
  EXPECT_THAT(refusal("colour=red"), HasSubstr("has no option 'colour'"));
}

}  // namespace
}  // namespace kerf::emulators

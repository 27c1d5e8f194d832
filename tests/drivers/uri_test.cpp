#include "kerf/drivers/uri.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/spacemouse.h>

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const std::string& uri) {
  try {
    (void)open_device(uri);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(Uri, IsANameAndOptions) {
  const Uri uri = parse_uri("sim:scissors?seed=3&noise=off");
  EXPECT_EQ(uri.name, "sim:scissors");
  EXPECT_EQ(uri.options, (std::map<std::string, std::string>{{"seed", "3"}, {"noise", "off"}}));
  EXPECT_TRUE(parse_uri("falcon:0").options.empty());
}

TEST(Uri, TakesTextsAsTheyStand) {
  UriOptions options(parse_uri("x?path=0:0:0mm,1:2:3mm&empty="));
  EXPECT_EQ(options.text("path"), "0:0:0mm,1:2:3mm");
  EXPECT_EQ(options.text("empty"), "");
  EXPECT_EQ(options.text("other"), std::nullopt);
}

TEST(Uri, TakesNumbersWithTheirUnit) {
  UriOptions options(parse_uri("x?open=40deg&stroke=1.2s&grip=500"));
  EXPECT_NEAR(options.number("open", {"deg", 0.0, 0.0, 1.0}), 40.0 * std::numbers::pi / 180.0, 1e-15);
  EXPECT_EQ(options.number("stroke", {"s", 0.0, 0.0, 10.0}), 1.2);
  EXPECT_THROW((void)options.number("grip", {"N/m", 0.0, 0.0, 1000.0}), DeviceError) << "the unit is missing";
  EXPECT_EQ(options.number("pause", {"s", 0.3, 0.0, 10.0}), 0.3);
}

TEST(Uri, KnowsWhichOptionsNameFiles) {
  UriOptions options(parse_uri("falcon:0?firmware=a.bin"));
  EXPECT_EQ(options.file("firmware"), "a.bin");
  EXPECT_EQ(options.file("calibration"), std::nullopt);
  EXPECT_THROW((void)options.file("led"), std::logic_error);
}

TEST(Uri, TakesAModelForAFileOfTheSimulatedAxisAlone) {
  EXPECT_TRUE(names_a_file("sim:axis", "model"));
  EXPECT_FALSE(names_a_file("hid:1234:0006", "model")) << "woody-2019";
  EXPECT_TRUE(names_a_file("u6:0", "calibration"));
}

TEST(Uri, TakesLengthsTimesAndForcesInThousandths) {
  UriOptions options(parse_uri("x?step=0.05mm&delay=2.5ms&noise=20mN&mass=3mkg"));
  EXPECT_DOUBLE_EQ(options.number("step", {"m", 0.0, 0.0, 1.0}), 0.05e-3);
  EXPECT_DOUBLE_EQ(options.number("delay", {"s", 0.0, 0.0, 1.0}), 2.5e-3);
  EXPECT_DOUBLE_EQ(options.number("noise", {"N", 0.0, 0.0, 1.0}), 20e-3);
  EXPECT_THROW((void)options.number("mass", {"kg", 0.0, 0.0, 1.0}), DeviceError);
}

TEST(Uri, TakesANumberForAllAxesOrOneForEach) {
  UriOptions options(parse_uri("x?mass=1kg&delay=1ms,2ms,3ms&limit=1N,2N&slew="));
  EXPECT_THAT(options.numbers("mass", {"kg", 0.0, 0.0, 9.0}, 3), testing::ElementsAre(1.0, 1.0, 1.0));
  EXPECT_THAT(options.numbers("delay", {"s", 0.0, 0.0, 9.0}, 3), testing::ElementsAre(1e-3, 2e-3, 3e-3));
  EXPECT_THAT(options.numbers("other", {"s", 0.0, 0.0, 9.0}, 3), testing::IsEmpty());
  EXPECT_THROW((void)options.numbers("limit", {"N", 0.0, 0.0, 9.0}, 3), DeviceError);
  EXPECT_THROW((void)options.numbers("slew", {"N/s", 0.0, 0.0, 9.0}, 3), DeviceError);
}

TEST(Uri, RefusesWhatIsNoDevice) {
  EXPECT_THAT(refusal("sim:saw"), AllOf(HasSubstr("sim:saw"), HasSubstr("kerf devices")));
  EXPECT_THAT(refusal(""), HasSubstr("kerf devices"));
}

TEST(Uri, RefusesAnUnknownOptionAndListsThoseThereAre) {
  EXPECT_THAT(refusal("sim:scissors?sed=3"),
              AllOf(HasSubstr("'sed'"), HasSubstr("seed"), HasSubstr("stroke")));
}

TEST(Uri, RefusesABadValueAndSaysWhatWasExpected) {
  EXPECT_THAT(refusal("sim:scissors?seed=three"), AllOf(HasSubstr("'three'"), HasSubstr("a number")));
  EXPECT_THAT(refusal("sim:scissors?seed=3.5"), HasSubstr("whole number"));
  EXPECT_THAT(refusal("sim:scissors?seed=-1"), HasSubstr("from 0"));
  EXPECT_THAT(refusal("sim:scissors?seed=nan"), HasSubstr("'nan'"));
  EXPECT_THAT(refusal("sim:scissors?seed="), HasSubstr("'seed'"));
  EXPECT_THAT(refusal("sim:scissors?noise=no"), AllOf(HasSubstr("'no'"), HasSubstr("on or off")));
  EXPECT_THAT(refusal("sim:scissors?open=40rad"), HasSubstr("with the unit deg"));
  EXPECT_THAT(refusal("sim:scissors?stroke=0s"), HasSubstr("from 0.05 to 100"));
  EXPECT_THAT(refusal("sim:scissors?open=10deg&close=20deg"), HasSubstr("smaller angle"));
}

TEST(Uri, RefusesOptionsThatAreNone) {
  EXPECT_THAT(refusal("sim:scissors?noise"), HasSubstr("NAME=VALUE"));
  EXPECT_THAT(refusal("sim:scissors?seed=1&&noise=off"), HasSubstr("NAME=VALUE"));
  EXPECT_THAT(refusal("sim:scissors?seed=1&seed=2"), HasSubstr("twice"));
}

TEST(Uri, OfASpaceMouseGivesItsTravelInItsUnits) {
  const auto options = SpaceMouse::parse_options(parse_uri("spacemouse:0?reach=0.05m&swing=90deg"));
  EXPECT_NEAR(options.reach_m, 0.05, 1e-12);
  EXPECT_NEAR(options.swing_rad, 0.5 * std::numbers::pi, 1e-12);
  EXPECT_NO_THROW((void)SpaceMouse::parse_options(parse_uri("spacemouse:0?swing=360deg")));
  EXPECT_THROW((void)SpaceMouse::parse_options(parse_uri("spacemouse:0?swing=361deg")), DeviceError);
}

}  // namespace
}  // namespace kerf::drivers

#include "kerf/drivers/force_calibration.h"

#include <chrono>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string good = R"(provenance = "a certificate"
serial = 360000001
units = { force = "N", torque = "N·m", signal = "V" }
matrix = [
  [2, 0, 0, 0, 0, 0],
  [0, 3, 0, 0, 0, 0],
  [0, 0, 5, 0, 0, 0],
  [0, 0, 0, 0.1, 0, 0],
  [0, 0, 0, 0, 0.2, 0],
  [1, 0, 0, 0, 0, 0.3],
]
bias = [0.5, 0, 0, 0, 0, -0.5]
[axes]
theta = { component = "-tz", lever_m = 0.04 }
x_s = "fx"
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = good;
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error(from);
  return text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_force_calibration(text, "c.toml");
  } catch (const DeviceError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "taken";
}

TEST(ForceCalibration, MakesAWrenchOfVolts) {
  const auto calibration = parse_force_calibration(good, "c.toml");
  const Axes wrench = calibration.wrench({1.5, 1.0, -1.0, 2.0, 3.0, 0.5});
  EXPECT_THAT(wrench, testing::ElementsAre(2.0, 3.0, -5.0, 0.2, testing::DoubleNear(0.6, 1e-15),
                                           testing::DoubleNear(1.0 + 0.3, 1e-15)));
  EXPECT_EQ(calibration.serial, 360000001U);
  ASSERT_EQ(calibration.mounts.size(), 2U);
  EXPECT_EQ(calibration.mounts[0].axis, "theta");
  EXPECT_EQ(calibration.mounts[0].component, 5U);
  EXPECT_EQ(calibration.mounts[0].sign, -1.0);
  EXPECT_EQ(calibration.mounts[0].lever_m, 0.04);
  EXPECT_EQ(calibration.mounts[1].component, 0U);
}

TEST(ForceCalibration, TakesTheUnitsOfTheFile) {
  const auto pounds =
      parse_force_calibration(replaced(R"({ force = "N", torque = "N·m", signal = "V" })",
                                       R"({ force = "lbf", torque = "lbf·in", signal = "mV" })"),
                              "c.toml");
  // 2 lbf/mV is 2 x 4.4482216 N over 1e-3 V; 0.1 lbf·in/mV is 0.1 x 0.1129848 N·m over 1e-3 V; 0.5 mV.
  EXPECT_NEAR(pounds.matrix(0, 0), 8896.4432, 1e-3);
  EXPECT_NEAR(pounds.matrix(3, 3), 11.29848, 1e-5);
  EXPECT_DOUBLE_EQ(pounds.bias_v[0], 0.5e-3);
}

TEST(ForceCalibration, ComesBackFromItsOwnTomlBitForBit) {
  auto calibration = parse_force_calibration(good, "c.toml");
  calibration.matrix(0, 1) = 1.0 / 3.0;
  calibration.provenance = "with \"quotes\" and a \\";
  const auto again = parse_force_calibration(to_toml(calibration), "again");
  EXPECT_EQ(again.matrix, calibration.matrix);
  EXPECT_EQ(again.bias_v, calibration.bias_v);
  EXPECT_EQ(again.provenance, calibration.provenance);
  EXPECT_EQ(again.serial, calibration.serial);
  EXPECT_EQ(again.mounts.size(), 2U);
  EXPECT_EQ(again.mounts[0].sign, -1.0);
}

TEST(ForceCalibration, NamesTheFileAndWhatToDoIfThereIsNone) {
  try {
    (void)read_force_calibration("/nowhere/c.toml");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/nowhere/c.toml"), HasSubstr("examples/u6.calibration.toml")));
  }
}

TEST(ForceCalibration, RefusesWhatIsNoToml) { EXPECT_THAT(refusal("units ="), HasSubstr("c.toml:1: ")); }

TEST(ForceCalibration, RefusesAnUnknownKey) {
  EXPECT_THAT(refusal(replaced("serial", "seriel")), HasSubstr("c.toml:2: unknown key 'seriel'"));
  EXPECT_THAT(refusal(replaced("lever_m", "lever")), HasSubstr("c.toml:14: unknown key 'lever'"));
}

TEST(ForceCalibration, RefusesASerialThatIsNone) {
  EXPECT_THAT(refusal(replaced("360000001", "-1")), HasSubstr("c.toml:2: 'serial' must be the number"));
}

TEST(ForceCalibration, RefusesMissingUnits) {
  EXPECT_THAT(refusal(replaced(R"(units = { force = "N", torque = "N·m", signal = "V" })", "")),
              HasSubstr("c.toml: 'units' is missing"));
  EXPECT_THAT(refusal(replaced(R"(, signal = "V")", "")), HasSubstr("the unit of 'signal' is missing"));
}

TEST(ForceCalibration, RefusesAUnitThatItDoesNotKnow) {
  EXPECT_THAT(refusal(replaced(R"("N·m")", R"("kg")")),
              HasSubstr("c.toml:3: the unit of 'torque' is \"kg\", expected"));
}

TEST(ForceCalibration, RefusesAMatrixOfTheWrongSize) {
  EXPECT_THAT(refusal(replaced("  [0, 3, 0, 0, 0, 0],\n", "")), HasSubstr("'matrix' must be 6 rows"));
  EXPECT_THAT(refusal(replaced("[0, 3, 0, 0, 0, 0]", "[0, 3, 0, 0, 0]")),
              HasSubstr("c.toml:6: row fy of 'matrix' must be 6 numbers, found 5"));
}

TEST(ForceCalibration, RefusesAMatrixThatIsSingular) {
  EXPECT_THAT(refusal(replaced("[0, 3, 0, 0, 0, 0]", "[4, 0, 0, 0, 0, 0]")),
              HasSubstr("'matrix' is singular"));
}

TEST(ForceCalibration, RefusesWhatIsNoNumber) {
  EXPECT_THAT(refusal(replaced("[0, 3,", "[0, \"3\",")),
              HasSubstr("c.toml:6: row fy of 'matrix'[1] must be a finite"));
  EXPECT_THAT(refusal(replaced("[0.5,", "[nan,")), HasSubstr("c.toml:12: 'bias'[0] must be a finite number"));
}

TEST(ForceCalibration, RefusesABiasOfTheWrongSize) {
  EXPECT_THAT(refusal(replaced("bias = [0.5, ", "bias = [")),
              HasSubstr("c.toml:12: 'bias' must be 6 numbers, found 5"));
}

TEST(ForceCalibration, RefusesToBeWithoutProvenance) {
  EXPECT_THAT(refusal(replaced("provenance = \"a certificate\"", "")),
              HasSubstr("c.toml: 'provenance' is missing"));
}

TEST(ForceCalibration, RefusesAComponentThatThereIsNot) {
  EXPECT_THAT(refusal(replaced("\"fx\"", "\"fw\"")),
              HasSubstr("c.toml:15: [axes] 'x_s' is \"fw\", expected one of fx,"));
}

TEST(ForceCalibration, RefusesALeverThatIsNone) {
  EXPECT_THAT(refusal(replaced("lever_m = 0.04", "lever_m = 0")),
              HasSubstr("c.toml:14: 'lever_m' must be more than 0"));
}

constexpr const char* dated = R"(date = 2026-03-01
serial_number = "FT1"
temperature = 22.5
stale_after = 100
units)";

std::string with_quality(const std::string& text) {
  return text +
         "[quality]\nnoise = [0.001, 0.001, 0.001, 0.001, 0.001, 0.001]\n"
         "bias_half_width = [0, 0, 0, 0, 0, 0]\nanything = 3\n";
}

TEST(ForceCalibration, KeepsWhenAndOfWhatItIsThroughItsOwnToml) {
  const auto calibration = parse_force_calibration(with_quality(replaced("units", dated)), "c.toml");
  const auto again = parse_force_calibration(to_toml(calibration), "again");
  ASSERT_TRUE(again.date.has_value());
  EXPECT_EQ(*again.date, std::chrono::year(2026) / 3 / 1);
  EXPECT_EQ(again.serial_number, "FT1");
  EXPECT_EQ(again.temperature, 22.5);
  EXPECT_EQ(again.stale_after_days, 100.0);
  ASSERT_TRUE(again.noise_v.has_value());
  EXPECT_EQ((*again.noise_v)[5], 0.001);
}

TEST(ForceCalibration, IsStaleTheDayAfterItsTime) {
  using std::chrono::days;
  const auto calibration = parse_force_calibration(replaced("units", dated), "c.toml");
  const std::chrono::sys_days made(std::chrono::year(2026) / 3 / 1);
  EXPECT_TRUE(doubts_of(calibration, "c.toml", made + days(100)).empty());
  EXPECT_THAT(doubts_of(calibration, "c.toml", made + days(101)),
              testing::ElementsAre(HasSubstr("is 101 days old, and stale after 100")));
  EXPECT_TRUE(doubts_of(parse_force_calibration(good, "c.toml"), "c.toml", made + days(9999)).empty());
}

TEST(ForceCalibration, IsOfOneTransducer) {
  const auto calibration = parse_force_calibration(replaced("units", dated), "c.toml");
  const std::chrono::sys_days made(std::chrono::year(2026) / 3 / 1);
  EXPECT_TRUE(doubts_of(calibration, "c.toml", made, "FT1").empty());
  EXPECT_THAT(doubts_of(calibration, "c.toml", made, "FT2"),
              testing::ElementsAre(HasSubstr("of the transducer FT1")));
}

// Five standard deviations of 100 readings of 1 mV are 0.5 mV.
TEST(ForceCalibration, SaysThatItsBiasHasMovedBeyondTheNoise) {
  const auto calibration = parse_force_calibration(with_quality(good), "c.toml");
  EXPECT_FALSE(moved_bias(calibration, "c.toml", {0.5 + 0.49e-3, 0, 0, 0, 0, -0.5}, 100).has_value());
  const auto line = moved_bias(calibration, "c.toml", {0.5 + 0.51e-3, 0, 0, 0, 0, -0.5}, 100);
  ASSERT_TRUE(line.has_value());
  EXPECT_THAT(*line, HasSubstr("fx 0.001"));
  EXPECT_FALSE(
      moved_bias(parse_force_calibration(good, "c.toml"), "c.toml", {9, 9, 9, 9, 9, 9}, 100).has_value());
}

TEST(ForceCalibration, MayTellFewerComponentsThanSix) {
  const auto cell = parse_force_calibration(R"(provenance = "a load cell"
units = { force = "N", torque = "N·m", signal = "V" }
components = ["fz"]
matrix = [ [4] ]
bias = [0.5]
)",
                                            "cell.toml");
  const Axes wrench = cell.wrench({1.5, 9, 9, 9, 9, 9});
  EXPECT_EQ(wrench[2], 4.0);
  EXPECT_TRUE(std::isnan(wrench[0]));
  EXPECT_EQ(parse_force_calibration(to_toml(cell), "again").wrench({1.5, 9, 9, 9, 9, 9})[2], 4.0);
}

TEST(ForceCalibration, RefusesADayThatIsNone) {
  EXPECT_THAT(refusal(replaced("units", "date = \"1 March\"\nunits")), HasSubstr("'date' must be a day"));
}

}  // namespace
}  // namespace kerf::drivers

#include "kerf/drivers/device_model.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Numbers that no short decimal is.
DeviceModel full_model() {
  DeviceModel model;
  model.kerf = "0.1.0 (abcdef0)";
  model.date = "2026-01-31T12:00:00Z";
  model.rate_hz = 1000.0;
  model.held = true;
  model.conditions = "a \"firm\" grip, \\ warm\nsecond line";
  model.temperature_degc = 21.3;
  model.uri = "falcon:0";
  model.model = "Novint Falcon";
  model.serial = "";
  model.port = "1-2.3";
  AxisModel x;
  x.name = "x";
  x.limits = {
      .lower = -0.05, .upper = 0.05, .force = 9.0, .slew = 2000.0, .speed = 5.0, .acceleration = 200.0};
  double value = 1.0 / 3.0;
  for (const AxisNumber& one : axis_numbers()) {
    x.*one.member = Estimate{value, std::nextafter(value, 0.0), value * (1.0 + 1e-15)};
    value /= 7.0;
  }
  x.stiffness->upper = std::numeric_limits<double>::infinity();
  x.gravity = Estimate{-0.1, -0.2, -0.0};
  x.hand_mass = Estimate{0.1, 0.09, 0.11};
  x.hand_damping = Estimate{5.0, 4.0, 6.0};
  x.hand_stiffness = Estimate{500.0, 400.0, 600.0};
  x.gravity_table = GravityTable{.position = {-0.05, 0.1 / 3.0}, .force = {0.1, -0.2}};
  x.validation = {.fits = false,
                  .error = 0.21,
                  .verdict = "this model predicts the device to 21 %",
                  .why_not = {"play of 0.4 mm where the force changes its sign", "it's \"loose\""}};
  AxisModel turn;
  turn.name = "rz";
  turn.position_unit = "rad";
  turn.force_unit = "N·m";
  turn.mass = Estimate{2.5e-4, 2.4e-4, 2.6e-4};
  model.axes = {x, turn};
  return model;
}

TEST(DeviceModel, IsReadAsItWasWrittenToTheLastBit) {
  const DeviceModel model = full_model();
  const DeviceModel again = parse_device_model(to_toml(model), "m.device.toml");
  EXPECT_TRUE(again == model) << to_toml(again);
  EXPECT_EQ(to_toml(again), to_toml(model));
  EXPECT_TRUE(std::signbit(again.axes[0].gravity->upper)) << "a negative zero keeps its sign";
}

TEST(DeviceModel, KeepsApartWhatIsUnknownAndWhatIsZero) {
  DeviceModel model = full_model();
  model.serial.reset();
  model.axes[0].viscous.reset();
  model.axes[1].viscous = Estimate::exactly(0.0);
  model.axes[0].validation.fits.reset();
  const DeviceModel again = parse_device_model(to_toml(model), "m.device.toml");
  EXPECT_FALSE(again.serial.has_value());
  EXPECT_FALSE(again.axes[0].viscous.has_value());
  EXPECT_EQ(again.axes[1].viscous, Estimate::exactly(0.0));
  EXPECT_FALSE(again.axes[0].mechanics().has_value()) << "of mass alone nothing is judged";
  EXPECT_EQ(again.fits(), std::nullopt);
}

TEST(DeviceModel, FitsOnlyIfEachOfItsAxesIsSaidTo) {
  DeviceModel model = full_model();
  EXPECT_EQ(model.fits(), false);
  EXPECT_THAT(model.why_not(), testing::ElementsAre("x: play of 0.4 mm where the force changes its sign",
                                                    "x: it's \"loose\""));
  model.axes[0].validation.fits = true;
  EXPECT_EQ(model.fits(), std::nullopt) << "nobody has looked at rz";
  model.axes[1].validation.fits = true;
  EXPECT_EQ(model.fits(), true);
}

TEST(DeviceModel, HasTheMeanOfBothFrictionsAsTheOneThatMechanicsHave) {
  AxisModel axis;
  axis.mass = Estimate::exactly(0.06);
  axis.viscous = Estimate::exactly(0.2);
  axis.coulomb_up = Estimate::exactly(0.3);
  EXPECT_FALSE(axis.mechanics());
  axis.coulomb_down = Estimate::exactly(0.1);
  ASSERT_TRUE(axis.mechanics());
  EXPECT_EQ(axis.mechanics()->coulomb_n, 0.2);
  EXPECT_EQ(axis.mechanics()->mass_kg, 0.06);
}

TEST(GravityTable, IsAStraightLineBetweenItsPlacesAndLevelBeyond) {
  const GravityTable table{.position = {0.0, 0.1, 0.3}, .force = {1.0, 2.0, -2.0}};
  EXPECT_EQ(table.at(-1.0), 1.0);
  EXPECT_DOUBLE_EQ(table.at(0.05), 1.5);
  EXPECT_EQ(table.at(0.1), 2.0);
  EXPECT_NEAR(table.at(0.2), 0.0, 1e-15);
  EXPECT_EQ(table.at(0.5), -2.0);
}

const std::string short_model = R"(format = 1
date = "2026-01-31T12:00:00Z"
rate_hz = 1000
held = false
[device]
uri = "sim:axis"
model = "sim:axis"
[[axis]]
name = "x"
position_unit = "m"
force_unit = "N"
mass = { value = 0.06, lower = 0.05, upper = 0.07, unit = "kg" }
)";

std::string with(const std::string& from, const std::string& to) {
  std::string text = short_model;
  const auto at = text.find(from);
  if (at == std::string::npos) throw std::logic_error(from);
  return text.replace(at, from.size(), to);
}

std::string refused(const std::string& text) {
  try {
    (void)parse_device_model(text, "m.device.toml");
  } catch (const DeviceError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    EXPECT_THAT(error.what(), testing::StartsWith("m.device.toml:"));
    return error.what();
  }
  return "taken";
}

TEST(DeviceModel, IsTakenWithWhatIsRequiredAlone) {
  EXPECT_EQ(refused(short_model), "taken");
  EXPECT_EQ(parse_device_model(short_model, "").axes[0].mass, (Estimate{0.06, 0.05, 0.07}));
}

TEST(DeviceModel, SaysInOneLineWhatIsWrongWhere) {
  EXPECT_THAT(refused("format = "), HasSubstr("not TOML"));
  EXPECT_THAT(refused(""), HasSubstr("m.device.toml:1: 'format' is missing; expected 1"));
  EXPECT_THAT(refused(with("format = 1", "format = 2")), HasSubstr("m.device.toml:1: 'format' is 2"));
  EXPECT_THAT(refused(with("format = 1", "format = 2\nlater = 3")), HasSubstr("'format' is 2"))
      << "not the key that it does not know";
  EXPECT_THAT(refused(with("rate_hz = 1000", "rate = 1000")), HasSubstr("3: unknown key 'rate'"));
  EXPECT_THAT(refused(with("rate_hz = 1000", "rate_hz = 0")), HasSubstr("'rate_hz' is 0"));
  EXPECT_THAT(refused(with("held = false", "held = 0")), HasSubstr("'held' must be true or false"));
  EXPECT_THAT(refused(with("2026-01-31T12:00:00Z", "31.1.2026")), HasSubstr("'date' is \"31.1.2026\""));
  EXPECT_THAT(refused(with("2026-01-31T12:00:00Z", "2026-13-31T12:00:00Z")), HasSubstr("'date'"));
  EXPECT_THAT(refused(with("uri = \"sim:axis\"\n", "")), HasSubstr("'uri' is missing"));
  EXPECT_THAT(refused(with("\"N\"", "\"mN\"")), HasSubstr("'force_unit' is \"mN\", expected N or N·m"));
  EXPECT_THAT(refused(with("value = 0.06", "value = 0.08")),
              HasSubstr("12: 'mass' is 0.08 and its interval"));
  EXPECT_THAT(refused(with("value = 0.06, lower = 0.05", "value = 0, lower = 0")),
              HasSubstr("'mass' must be more than 0"));
  EXPECT_THAT(refused(with("lower = 0.05, ", "")), HasSubstr("'mass' has no lower"));
  EXPECT_THAT(refused(with("value = 0.06", "value = nan")), HasSubstr("must be a finite number"));
  EXPECT_THAT(refused(with("value = 0.06", "value = \"0.06\"")), HasSubstr("must be a finite number"));
  EXPECT_THAT(refused(with(", unit = \"kg\"", "")), HasSubstr("'mass' has no unit; expected \"kg\""));
  EXPECT_THAT(refused(with("\"kg\"", "\"g\"")), HasSubstr("'mass' is given in g, expected kg"));
  EXPECT_THAT(refused(with("mass = {", "mass = 0.06 #")), HasSubstr("'mass' must be written { value = "));
  EXPECT_THAT(refused(with("mass = {", "masse = {")), HasSubstr("unknown key 'masse' in [[axis]]"));
  EXPECT_THAT(refused(short_model + "viscous = { value = -1, lower = -2, upper = 0, unit = \"N·s/m\" }\n"),
              HasSubstr("expected no negative number"));
  EXPECT_THAT(refused(short_model + "gravity_table = { position = [0, 1], force = [1] }\n"),
              HasSubstr("2 places and 1 forces"));
  EXPECT_THAT(refused(short_model + "gravity_table = { position = [1, 1], force = [1, 2] }\n"),
              HasSubstr("must grow"));
  EXPECT_THAT(refused(short_model + "validation = { fits = \"yes\" }\n"),
              HasSubstr("'fits' must be true or"));
  EXPECT_THAT(refused(short_model + "limits = { lower = 1, upper = 0 }\n"), HasSubstr("ranges from 1 to 0"));
  EXPECT_THAT(refused(short_model + "[[axis]]\nname = \"x\"\nposition_unit = \"m\"\nforce_unit = \"N\"\n"),
              HasSubstr("axis 'x' stands twice"));
}

TEST(DeviceModel, IsRefusedWhereThereIsNoFile) {
  try {
    (void)read_device_model("nowhere.device.toml");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("nowhere.device.toml"), HasSubstr("kerf identify")));
  }
}

/// The file that other programs read: it changes only with its format's number.
TEST(DeviceModel, IsWrittenAsTheGoldenFile) {
  std::ifstream file(KERF_SOURCE_DIR "/tests/drivers/model/golden.device.toml");
  std::ostringstream golden;
  golden << file.rdbuf();
  EXPECT_EQ(to_toml(full_model()), golden.str());
}

}  // namespace
}  // namespace kerf::drivers

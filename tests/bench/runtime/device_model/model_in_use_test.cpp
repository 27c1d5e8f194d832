#include "device_model/model_in_use.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/device_models.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* now = "2026-03-12T12:00:00Z";  // 40 days on

/// A device of one axis whose driver knows nothing of its mass.
drivers::DeviceInfo unknown_device() {
  drivers::DeviceInfo device{.uri = "falcon:0", .model = "Novint Falcon"};
  device.axes.push_back(
      {.name = "x", .position_unit = "m", .force_unit = "N", .resolution = 50e-6, .force_limit = 9.0});
  device.serial = "1";
  return device;
}
drivers::DeviceModel its_model() {
  drivers::DeviceModel model = test::model_of("falcon:0");
  model.model = "Novint Falcon";
  model.serial = "1";
  return model;
}

class TakenModel : public testing::Test {
 protected:
  TakenModel() { setenv("XDG_DATA_HOME", folder_.path().c_str(), 1); }
  ~TakenModel() override { unsetenv("XDG_DATA_HOME"); }

  std::optional<ModelInUse> take(drivers::DeviceInfo& device, const drivers::DeviceModel& model,
                                 double rate_hz = 1000.0) {
    write_model_file(file(), model);
    return take_model(device, {.file = file(), .rate_hz = rate_hz, .now = now, .warn = {}});
  }
  [[nodiscard]] std::string file() const { return (folder_ / "x.device.toml").string(); }

  test::TemporaryFolder folder_;
};

TEST_F(TakenModel, GivesAnAxisWhatNoDriverKnows) {
  drivers::DeviceInfo device = unknown_device();
  const auto use = take(device, its_model());
  ASSERT_TRUE(use);
  EXPECT_THAT(use->axes, ElementsAre("x"));
  EXPECT_THAT(use->doubts, IsEmpty());
  ASSERT_TRUE(device.axes[0].mechanics);
  EXPECT_EQ(device.axes[0].mechanics->mass_kg, 0.08);
  EXPECT_EQ(device.axes[0].mechanics->viscous_n_s_per_m, 2.0);
  EXPECT_EQ(device.axes[0].delay_s, 1.3e-3);
  EXPECT_EQ(device.axes[0].resolution, 20e-6) << "who names a model wants its numbers";
  EXPECT_EQ(in_words(*use),
            "device model " + file() + " (x): measured 40 days ago, free, at 1000 Hz, on the bench");
}

TEST_F(TakenModel, IsFoundWithoutBeingAskedWhereTheDriverDoesNotKnow) {
  const auto kept = KeptModels(KeptModels::usual_folder()).keep(its_model());
  drivers::DeviceInfo device = unknown_device();
  const auto use = take_model(device, {.rate_hz = 1000.0, .now = now, .warn = {}});
  ASSERT_TRUE(use);
  EXPECT_EQ(use->from.file, kept);
  EXPECT_TRUE(device.axes[0].mechanics);
  EXPECT_EQ(device.axes[0].resolution, 50e-6) << "which the driver knows";
  drivers::DeviceInfo known = unknown_device();
  known.axes[0].mechanics = drivers::Mechanics{.mass_kg = 1.0};
  EXPECT_FALSE(take_model(known, {.rate_hz = 1000.0, .now = now, .warn = {}}));
  EXPECT_EQ(known.axes[0].mechanics->mass_kg, 1.0);
  drivers::DeviceInfo other = unknown_device();
  other.serial = "2";
  EXPECT_FALSE(take_model(other, {.rate_hz = 1000.0, .now = now, .warn = {}}));
  EXPECT_FALSE(other.axes[0].mechanics);
}

TEST_F(TakenModel, SaysWhatSpeaksAgainstIt) {
  drivers::DeviceModel model = its_model();
  model.date = "2025-01-31T12:00:00Z";
  model.serial = "7";
  model.axes[0].validation = {.fits = false, .error = 0.3, .verdict = "", .why_not = {"play of 0.4 mm"}};
  drivers::DeviceInfo device = unknown_device();
  const auto use = take(device, model, 4000.0);
  ASSERT_TRUE(use);
  EXPECT_THAT(use->doubts,
              ElementsAre(HasSubstr("does not fit the device that it was made of: x: play of 0.4 mm"),
                          HasSubstr("is 405 days old"),
                          HasSubstr("with serial number '7', and this one has serial number '1'"),
                          HasSubstr("measured at 1000 Hz, and 4000 Hz is judged")));
  EXPECT_TRUE(device.axes[0].mechanics) << "it is taken all the same";
  const auto json = as_json(use);
  EXPECT_EQ(json.at("fits"), false);
  EXPECT_EQ(json.at("serial"), "7");
  EXPECT_EQ(json.at("doubts").size(), 4U);
  EXPECT_TRUE(as_json(std::nullopt).is_null());
}

TEST_F(TakenModel, LeavesUnknownWhatTheModelDoesNotKnow) {
  drivers::DeviceModel model = its_model();
  model.axes[0].viscous.reset();
  drivers::DeviceInfo device = unknown_device();
  const auto use = take(device, model);
  ASSERT_TRUE(use);
  EXPECT_FALSE(device.axes[0].mechanics);
  EXPECT_THAT(use->axes, IsEmpty());
  EXPECT_THAT(use->doubts, ElementsAre(HasSubstr("does not know viscous of axis 'x'")));
}

TEST_F(TakenModel, GivesTheLowerEndsToWhoeverCountsOnThem) {
  write_model_file(file(), its_model());
  drivers::DeviceInfo device = unknown_device();
  ASSERT_TRUE(
      take_model(device, {.file = file(), .rate_hz = 1000.0, .lower_ends = true, .now = now, .warn = {}}));
  EXPECT_EQ(device.axes[0].mechanics->mass_kg, 0.07);
  EXPECT_EQ(device.axes[0].mechanics->viscous_n_s_per_m, 1.9);
}

TEST_F(TakenModel, RefusesAModelOfOtherAxes) {
  drivers::DeviceModel model = its_model();
  model.axes[0].name = "theta";
  drivers::DeviceInfo device = unknown_device();
  try {
    (void)take(device, model);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("the model has theta, and falcon:0 has no such axis"));
  }
}

TEST(DaysBetween, CountsAcrossALeapDay) {
  EXPECT_DOUBLE_EQ(days_between("2028-02-28T12:00:00Z", "2028-03-01T00:00:00Z"), 1.5);
  EXPECT_DOUBLE_EQ(days_between("2026-01-31T12:00:00Z", now), 40.0);
}

TEST(ConditionsInWords, SaysAgeHandAndRate) {
  drivers::DeviceModel model = its_model();
  model.conditions.clear();
  model.held = true;
  model.temperature_degc = 21.5;
  EXPECT_EQ(conditions_in_words(model, 0.2), "measured today, held, at 1000 Hz, at 21.5 °C");
  EXPECT_EQ(conditions_in_words(model, 1.2), "measured yesterday, held, at 1000 Hz, at 21.5 °C");
  EXPECT_THAT(conditions_in_words(model, -3.0), HasSubstr("dated in the future"));
}

}  // namespace
}  // namespace kerf::bench

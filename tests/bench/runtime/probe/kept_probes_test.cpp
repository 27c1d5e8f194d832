#include "probe/kept_probes.h"

#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/drivers/sign_tables.h>

#include "probe/probe.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

drivers::DeviceInfo device_like(const std::string& model, const std::string& serial,
                                const std::string& port) {
  drivers::DeviceInfo device{.uri = "hid:1234:0006?most_current=1A&model=woody-2019", .model = model};
  for (const char* name : {"x", "y"}) {
    device.axes.push_back({.name = name, .position_unit = "m", .force_unit = "N", .force_limit = 5.0});
  }
  device.serial = serial;
  device.port = port;
  return device;
}

const drivers::DeviceInfo mine = device_like("WoodenHaptics woody-2019 (V2)", "0123456789", "1-2");

ProbeResult probed(const drivers::DeviceInfo& device, PushVerdict x, PushVerdict y) {
  return {.device = device,
          .axes = {{.axis = 0, .force = 0.5, .judgement = {.verdict = x}},
                   {.axis = 1, .force = 0.5, .judgement = {.verdict = y}}},
          .finished = true};
}

/// A file of its own for one test, where require_probed() finds it.
class ProbeStore : public testing::Test {
 protected:
  ProbeStore() { setenv("XDG_DATA_HOME", folder_.path().c_str(), 1); }
  ~ProbeStore() override { unsetenv("XDG_DATA_HOME"); }

  [[nodiscard]] std::optional<KeptProbe> found(const drivers::DeviceInfo& device) {
    return kept_.find(device, [this](std::string_view line) { warnings_.emplace_back(line); });
  }
  void require(const drivers::DeviceInfo& device) {
    require_probed(device, [this](std::string_view line) { warnings_.emplace_back(line); });
  }

  test::TemporaryFolder folder_;
  KeptProbes kept_{folder_ / "kerf" / "probes.json"};
  std::vector<std::string> warnings_;
};

using enum PushVerdict;

TEST_F(ProbeStore, IsFoundAgainOfTheSameDeviceOnly) {
  EXPECT_FALSE(found(mine));
  kept_.keep(probed(mine, right, wrong));
  const auto kept = found(mine);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->axes_that_are(right), "x");
  EXPECT_EQ(kept->axes_that_are(wrong), "y");
  EXPECT_FALSE(found(device_like("WoodenHaptics aluhaptics (V2)", "0123456789", "1-2"))) << "another model";
  EXPECT_FALSE(found(device_like("WoodenHaptics woody-2019 (V1)", "0123456789", "1-2"))) << "a generation";
  EXPECT_FALSE(found(device_like(mine.model, "0123456780", "1-2"))) << "another serial number";
  EXPECT_FALSE(found(device_like(mine.model, "0123456789", "1-3"))) << "they all have one serial number";
  EXPECT_THAT(warnings_, testing::IsEmpty());
}

TEST_F(ProbeStore, IsReplacedByTheNextOfTheSameDevice) {
  kept_.keep(probed(mine, wrong, wrong));
  kept_.keep(probed(device_like(mine.model, "7", "1-4"), unknown, right));
  kept_.keep(probed(mine, right, right));
  EXPECT_EQ(found(mine)->axes_that_are(right), "x, y");
  EXPECT_EQ(found(device_like(mine.model, "7", "1-4"))->axes_that_are(unknown), "x");
  const auto json = nlohmann::json::parse(test::read_text(kept_.file()));
  ASSERT_EQ(json.at("probes").size(), 2U);
  EXPECT_EQ(json.at("probes").at(1).at("uri"), "hid:1234:0006?model=woody-2019");
}

TEST_F(ProbeStore, IsStaleOnceTheDriversTakeOtherSigns) {
  kept_.keep(probed(mine, right, right));
  std::string text = test::read_text(kept_.file());
  const std::string now = fmt::format("\"sign_tables\": {}", drivers::sign_tables_version);
  ASSERT_NE(text.find(now), std::string::npos);
  text.replace(text.find(now), now.size(),
               fmt::format("\"sign_tables\": {}", drivers::sign_tables_version - 1));
  test::write_text(kept_.file(), text);
  EXPECT_FALSE(found(mine));
}

TEST_F(ProbeStore, OfADamagedFileIsNoneWithAWarning) {
  kept_.keep(probed(mine, right, right));
  const std::string whole = test::read_text(kept_.file());
  for (const std::string& damaged : {whole.substr(0, whole.size() / 2), std::string(), std::string("[]"),
                                     std::string("{\"probes\": [3]}")}) {
    warnings_.clear();
    test::write_text(kept_.file(), damaged);
    EXPECT_FALSE(found(mine)) << damaged;
    EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("probes.json"))) << damaged;
  }
  kept_.keep(probed(mine, right, right));
  EXPECT_TRUE(found(mine));
}

TEST_F(ProbeStore, OfManyKeptAtOnceNoneIsLost) {
  std::vector<std::jthread> writers;
  for (int one = 0; one < 8; ++one) {
    writers.emplace_back([this, one] {
      for (int again = 0; again < 5; ++again) {
        kept_.keep(probed(device_like(mine.model, fmt::format("{}", one), "1-2"), right, right));
      }
    });
  }
  writers.clear();
  for (int one = 0; one < 8; ++one) {
    EXPECT_TRUE(found(device_like(mine.model, fmt::format("{}", one), "1-2"))) << one;
  }
  EXPECT_EQ(nlohmann::json::parse(test::read_text(kept_.file())).at("probes").size(), 8U);
}

TEST_F(ProbeStore, IsMissedWhereADeviceIsToRender) {
  require(mine);
  EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("kerf devices --probe 'hid:1234:0006?")));
}

TEST_F(ProbeStore, ThatIsRightSaysNothing) {
  kept_.keep(probed(mine, right, right));
  require(mine);
  EXPECT_THAT(warnings_, testing::IsEmpty());
}

TEST_F(ProbeStore, ThatCouldNotTellIsWarnedOf) {
  kept_.keep(probed(mine, right, unknown));
  require(mine);
  EXPECT_THAT(warnings_, testing::ElementsAre(HasSubstr("along y")));
}

TEST_F(ProbeStore, ThatIsWrongRefusesToRender) {
  kept_.keep(probed(mine, wrong, unknown));
  try {
    require(mine);
    FAIL() << "it renders";
  } catch (const drivers::DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("along x moved the handle the wrong way"));
    EXPECT_THAT(error.what(), HasSubstr("model="));
  }
}

TEST_F(ProbeStore, IsNotNeededOfWhatIsSimulatedOrHasNoForce) {
  drivers::DeviceInfo simulated = mine;
  simulated.simulated = true;
  require(simulated);
  drivers::DeviceInfo cap = mine;
  for (drivers::AxisInfo& axis : cap.axes) axis.force_limit = 0.0;
  require(cap);
  EXPECT_THAT(warnings_, testing::IsEmpty());
}

}  // namespace
}  // namespace kerf::bench

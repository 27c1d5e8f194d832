#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "emulator.h"
#include "support/program.h"
#include "wall.h"

// kerf devices --probe on emulated devices, whose wiring is a source of its own.

namespace kerf::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A file of its own for one test in which probes are kept.
class Probe : public testing::Test {
 protected:
  Probe() { setenv("XDG_DATA_HOME", folder_.path().c_str(), 1); }
  ~Probe() override { unsetenv("XDG_DATA_HOME"); }

  /// For as long as it takes to see whether the device is refused.
  [[nodiscard]] Outcome rendered_on(const std::string& uri) const {
    write_text(folder_ / "wall.law.toml", wall_below(-1.0, "1"));
    return run_kerf({"record", "--device", uri, "--law", folder_ / "wall.law.toml", "--seconds", "0.1",
                     "--force", "-o", folder_ / "r.h5"});
  }
  /// The device is right on every axis, and nothing is warned of once that is known.
  void expect_right(const std::string& uri) const {
    SCOPED_TRACE(uri);
    EXPECT_THAT(rendered_on(uri).errors, HasSubstr("kerf devices --probe"));
    const Outcome probed = run_kerf({"devices", "--probe", uri, "--yes"});
    EXPECT_EQ(probed.exit_status, 0) << probed.errors << probed.output;
    EXPECT_THAT(probed.errors, HasSubstr("Hold the handle"));
    const Outcome rendered = rendered_on(uri);
    EXPECT_EQ(rendered.exit_status, 0) << rendered.errors;
    EXPECT_THAT(rendered.errors, Not(HasSubstr("--probe")));
  }

  TemporaryFolder folder_;
};

TEST_F(Probe, FindsAFalconRight) {
  const Emulator emulator("falcon?firmware=loaded&homed=on");
  ASSERT_TRUE(becomes_attached("falcon:0"));
  expect_right("falcon:0");
}

TEST_F(Probe, FindsAWoodenHapticsV1Right) {
  const Emulator emulator("woody?generation=v1");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  expect_right("hid:1234:0006");
}

TEST_F(Probe, FindsAWoodenHapticsV2RightAndRefusesItOnceItIsWrong) {
  const Emulator emulator("woody?generation=v2");
  ASSERT_TRUE(becomes_attached("hid:1234:0006"));
  expect_right("hid:1234:0006");
  const auto kept = folder_ / "kerf" / "probes.json";
  auto json = nlohmann::json::parse(read_text(kept));
  EXPECT_EQ(json.at("probes").at(0).at("serial"), "0123456789");
  EXPECT_NE(json.at("probes").at(0).at("port"), "");
  json["probes"][0]["axes"][1]["verdict"] = "wrong";
  write_text(kept, json.dump());
  const Outcome refused = rendered_on("hid:1234:0006");
  EXPECT_EQ(refused.exit_status, 3);
  EXPECT_THAT(refused.errors, HasSubstr("along y moved the handle the wrong way"));
}

}  // namespace
}  // namespace kerf::test

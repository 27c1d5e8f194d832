#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/protocols/woodenhaptics.h>
#include <kerf/drivers/woodenhaptics_signs.h>
#include <kerf/mechanisms/woodenhaptics.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "emulator.h"
#include "support/program.h"
#include "wall.h"
#include "woodenhaptics_bench.h"

namespace kerf::test {
namespace {

using mechanisms::WoodenHaptics;
using testing::HasSubstr;

/// Of the wall: ten for one of them, fewer for the others, because a guest takes its time.
std::size_t seconds_of(const Generation& one) { return one.emulator.ends_with("v2") ? 10 : 2; }

/// As the driver takes it.
WoodenHaptics mechanism_of(const Generation& one) {
  using drivers::woodenhaptics::signs_of;
  const auto& model = *WoodenHaptics::find(one.model);
  return {model, signs_of(*drivers::woodenhaptics::generation_of(one.report_size), model).value()};
}

/// The law of a wall below the middle of a model's workspace, where the hand holds it.
std::string wall_below_middle(const WoodenHaptics& mechanism) {
  return wall_below(mechanism.configuration().centre_m[2], "1");
}

std::array<double, 3> row_of(const std::vector<double>& values, std::size_t row) {
  return {values[3 * row], values[3 * row + 1], values[3 * row + 2]};
}

std::array<double, 3> wanted_currents(const WoodenHaptics& mechanism, const schema::Recording& recording,
                                      std::size_t row) {
  const auto [x, y, z] = row_of(recording.position, row);
  const auto [fx, fy, fz] = row_of(recording.force_commanded, row);
  const auto angles = mechanism.angles_of({x, y, z});
  return angles ? mechanism.currents({fx, fy, fz}, *angles).ampere : std::array{1e9, 1e9, 1e9};
}

/// Whether the currents that stand in a row are those, within a milliampere.
bool has_currents(const schema::Recording& recording, std::size_t row, const std::array<double, 3>& ampere) {
  for (std::size_t motor = 0; motor < 3; ++motor) {
    if (std::abs(recording.channels[motor].values[row] - ampere[motor]) > 1e-3) return false;
  }
  return true;
}

TEST(WoodenHapticsLoop, AVirtualWallIsClosedOverEachGeneration) {
  for (const Generation& one : generations) {
    SCOPED_TRACE(one.emulator);
    const std::size_t seconds = seconds_of(one);
    const TemporaryFolder folder;
    const WoodenHaptics mechanism = mechanism_of(one);
    write_text(folder / "wall.law.toml", wall_below_middle(mechanism));
    {
      const Emulator emulator(one.emulator + "&trace=" + (folder / "trace.csv").string());
      ASSERT_TRUE(becomes_attached(one.uri));
      const auto outcome = run_kerf({"record", "--device", one.uri, "--law", folder / "wall.law.toml",
                                     "--seconds", std::to_string(seconds), "-o", folder / "wall.h5"});
      ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
    }
    EXPECT_TRUE(schema::validate(folder / "wall.h5").empty());
    const auto recording = schema::read_recording(folder / "wall.h5");
    ASSERT_EQ(recording.rows(), 1000 * seconds) << "no tick was missed";
    EXPECT_THAT(recording.header.device_toml, HasSubstr("model = \"" + one.model + "\""));

    // The wall has pushed back as stiff as it is, and the force has moved the hand: 10 mm of sway at 300 N/m
    // against 400 N/m leave 4.3 mm and 1.7 N at most, a little more while its arm is loaded.
    double deepest = 0.0;
    double strongest = 0.0;
    const double height = mechanism.configuration().centre_m[2];
    std::size_t unsent = 0;
    std::vector<std::array<int, 3>> sent;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      deepest = std::max(deepest, height - recording.position[3 * row + 2]);
      strongest = std::max(strongest, recording.force_commanded[3 * row + 2]);
      EXPECT_EQ(recording.flags[row] & (schema::flag_device_fault | schema::flag_position_jump), 0U);
      std::array<int, 3> current{};
      for (std::size_t motor = 0; motor < 3; ++motor) {
        current[motor] = static_cast<int>(std::lround(1e3 * recording.channels[motor].values[row]));
      }
      if (sent.empty() || sent.back() != current) sent.push_back(current);
      // What stands beside a position was sent since the tick before: for its force, at its pose.
      if (row > 0) unsent += !has_currents(recording, row, wanted_currents(mechanism, recording, row - 1));
    }
    EXPECT_NEAR(deepest, 0.0043, 0.0006);
    EXPECT_NEAR(strongest, 1.7, 0.25);
    EXPECT_EQ(unsent, 0U);

    // And all of it arrived, in its order, within a milliampere.
    const auto orders = read_orders(folder / "trace.csv");
    std::size_t at = 0;
    std::size_t found = 0;
    for (const auto& current : sent) {
      while (at < orders.size() && orders[at].current_ma != current) ++at;
      found += at < orders.size();
    }
    EXPECT_GT(sent.size(), 100 * seconds);
    EXPECT_EQ(found, sent.size());
    EXPECT_EQ(orders.back().current_ma, (std::array{0, 0, 0})) << "zero force at the end";
  }
}

TEST(WoodenHapticsLoop, ARecordingOutlivesTheDevice) {
  for (const Generation& one : {generations[0], generations[1]}) {
    SCOPED_TRACE(one.emulator);
    const TemporaryFolder folder;
    const WoodenHaptics mechanism = mechanism_of(one);
    write_text(folder / "wall.law.toml", wall_below_middle(mechanism));
    const Emulator emulator(one.emulator, {"--fault", "unplug@1.2"});
    ASSERT_TRUE(becomes_attached(one.uri));
    const auto outcome = run_kerf({"record", "--device", one.uri, "--law", folder / "wall.law.toml",
                                   "--seconds", "10", "-o", folder / "short.h5"});
    EXPECT_EQ(outcome.exit_status, 3);
    EXPECT_THAT(outcome.errors, HasSubstr("the device was lost"));
    EXPECT_TRUE(schema::validate(folder / "short.h5").empty());
    const auto recording = schema::read_recording(folder / "short.h5");
    EXPECT_EQ(recording.header.status, "aborted: the device was lost");
    ASSERT_GT(recording.rows(), 500U);
    const auto last = row_of(recording.force_commanded, recording.rows() - 1);
    EXPECT_EQ(last, (std::array{0.0, 0.0, 0.0}));
  }
}

// tests/usb/same-twice runs it in two guests: what it writes must be the same to the last bit.
TEST(WoodenHapticsTwice, WritesTheSameRecordingInEachGuest) {
  const char* folder = std::getenv("KERF_TWICE");
  if (folder == nullptr) GTEST_SKIP() << "KERF_TWICE names no folder";
  for (const Generation& one : generations) {
    const WoodenHaptics mechanism = mechanism_of(one);
    const TemporaryFolder own;
    write_text(own / "wall.law.toml", wall_below_middle(mechanism));
    const Emulator emulator(one.emulator);
    ASSERT_TRUE(becomes_attached(one.uri));
    const auto outcome = run_kerf({"record", "--device", one.uri, "--law", own / "wall.law.toml", "--seconds",
                                   "0.5", "-o", own / "wall.h5"});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
    const auto recording = schema::read_recording(own / "wall.h5");
    std::string text;
    for (std::size_t row = 0; row < recording.rows(); ++row) {
      std::array<char, 256> line{};
      const auto [x, y, z] = row_of(recording.position, row);
      const auto [fx, fy, fz] = row_of(recording.force_commanded, row);
      (void)std::snprintf(line.data(), line.size(), "%a %a %a %a %a %a %a %u\n", x, y, z, fx, fy, fz,
                          recording.channels[0].values[row], recording.flags[row]);
      text += line.data();
    }
    write_text(std::string(folder) + "/" + one.emulator.substr(one.emulator.size() - 2), text);
  }
}

}  // namespace
}  // namespace kerf::test

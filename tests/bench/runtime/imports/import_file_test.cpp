#include "imports/import_file.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

class ImportFileTest : public testing::Test {
 protected:
  [[nodiscard]] ImportFile read(const std::string& text) const {
    test::write_text(folder_ / "a.import.toml", text);
    return read_import_file(folder_ / "a.import.toml");
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  }
  [[nodiscard]] test::Outcome import(const std::vector<std::string>& more) const {
    test::write_text(folder_ / "data.csv", "0,1,2,3,5\n1,2,3,4,6\n2,4,4,5,7\n");
    std::vector<std::string> arguments{"import", (folder_ / "data.csv").string(), "--force", "-o",
                                       (folder_ / "r.h5").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_kerf(arguments);
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImportFileTest, SaysAllThatTheOptionsOfAnImportSay) {
  const ImportFile file = read(
      "map = [\"time=1[ms]\", \"position=2[deg]\"]\nsheet = \"2\"\nstretch = 3\nrate = 100\nresample = "
      "50.5\nvelocity_window = 0.1\norigin = [1, 2.5, -3]\npoint = [0, 0, 0.08]\nstrict = true\n");
  EXPECT_EQ(file.map, "time=1[ms],position=2[deg]");
  EXPECT_EQ(file.options.sheet, "2");
  EXPECT_EQ(file.options.stretch, 3U);
  EXPECT_EQ(file.options.rate_hz, 100.0);
  EXPECT_EQ(file.options.resample_hz, 50.5);
  EXPECT_EQ(file.options.velocity_window_s, 0.1);
  EXPECT_EQ(file.options.places.origin_m, (std::array{1.0, 2.5, -3.0}));
  EXPECT_EQ(file.options.places.point_m, (std::array{0.0, 0.0, 0.08}));
  EXPECT_TRUE(file.options.strict);
}

TEST_F(ImportFileTest, StandsBehindWhatIsGiven) {
  const ImportOptions file =
      read("map = \"position=1[m]\"\nrate = 100\nstretch = 2\norigin = [1, 0, 0]\n").options;
  const ImportOptions all = with_file_behind({.rate_hz = 50.0}, file);
  EXPECT_EQ(all.rate_hz, 50.0);
  EXPECT_EQ(all.stretch, 2U);
  EXPECT_EQ(all.places.origin_m[0], 1.0);
  EXPECT_FALSE(all.places.point_m);
}

TEST_F(ImportFileTest, IsRefusedWithItsLine) {
  EXPECT_THAT(refusal("rate = 1\n"), HasSubstr("a.import.toml:1: no 'map'"));
  EXPECT_THAT(refusal("map = 3\n"), HasSubstr("a.import.toml:1: "));
  EXPECT_THAT(refusal("\nmap = \"time\"\n"), HasSubstr("a.import.toml:2: --map: 'time' has no '='"));
  EXPECT_THAT(refusal("map = [\"time=1[s]\", 3]\n"), HasSubstr("a list of texts"));
  const std::string map = "map = \"position=1[m]\"\n";
  EXPECT_THAT(refusal(map + "speed = 1\n"), HasSubstr("'speed'"));
  EXPECT_THAT(refusal(map + "rate = 0\n"),
              HasSubstr("a.import.toml:2: 'rate' is 0, expected a number above"));
  EXPECT_THAT(refusal(map + "rate = inf\n"), HasSubstr("a.import.toml:2: "));
  EXPECT_THAT(refusal(map + "stretch = 1.5\n"), HasSubstr("expected a whole number from 1 to 1000000"));
  EXPECT_THAT(refusal(map + "origin = [1, 2]\n"), HasSubstr("'origin' must be three numbers [m]"));
  EXPECT_THAT(refusal(map + "sensor_rotation = [1, 2]\n"),
              HasSubstr("'sensor_rotation' must be three numbers [deg]"));
  EXPECT_THAT(refusal(map + "point = [1, 2, nan]\n"), HasSubstr("a.import.toml:2: "));
  EXPECT_THAT(refusal("map = \n"), HasSubstr("a.import.toml:1"));
}

TEST_F(ImportFileTest, IsWhatMapMayName) {
  const std::string file = (folder_ / "tool.import.toml").string();
  test::write_text(file, "map = \"time=1[s],position=2:4[mm]\"\norigin = [0.001, 0, 0]\n");
  const test::Outcome imported = import({"--map", file, "--map", "extra=5[1]"});
  ASSERT_EQ(imported.exit_status, 0) << imported.errors;
  const schema::Recording recording = schema::read_recording(folder_ / "r.h5");
  EXPECT_EQ(recording.dimensions(), 3U);
  EXPECT_NEAR(recording.position[0], 0.0, 1e-15);
  EXPECT_EQ(recording.channels.at(0).name, "extra");
  EXPECT_THAT(import({"--map", file, "--map", file}).errors, HasSubstr("--map names two files"));
  EXPECT_THAT(import({"--map", (folder_ / "none.toml").string()}).errors, HasSubstr("none.toml"));
}

}  // namespace
}  // namespace kerf::bench

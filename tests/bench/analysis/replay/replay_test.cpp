#include "replay/replay.h"

#include <array>
#include <atomic>
#include <cmath>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "motion.h"
#include "replay/replay_files.h"
#include "support/kelvin_law.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

const std::atomic<bool> never{false};

Source sine(std::ptrdiff_t gap_begin = 0, std::ptrdiff_t gap_end = 0) {
  return select_rows(test::without_rows(test::sine_of_scissors(), gap_begin, gap_end), {}, "sine.h5");
}

class ReplayThrough : public testing::Test {
 protected:
  ReplayThrough() {
    std::filesystem::create_directory(folder_ / "other");
    for (const char* name : {"k.law.toml", "other/k.law.toml"})
      test::write_text(folder_ / name, test::kelvin_law);
  }
  [[nodiscard]] std::vector<NamedLaw> laws() const {
    return read_named_laws({(folder_ / "k.law.toml").string(), (folder_ / "other/k.law.toml").string()});
  }
  test::TemporaryFolder folder_;
};

TEST_F(ReplayThrough, NumbersLawsOfOneName) {
  const auto named = laws();
  ASSERT_THAT(named, SizeIs(2));
  EXPECT_EQ(named[0].name, "k");
  EXPECT_EQ(named[1].name, "k#2");
}

TEST_F(ReplayThrough, SaysWhatItsJsonSays) {
  const ThroughReplay replay = replay_through(sine(), laws(), {}, never);
  const auto json = open_loop_as_json(replay.source, replay.result);
  const auto lines = through_lines(replay);
  ASSERT_THAT(lines, SizeIs(3));
  const auto& axis = json.at("laws").at(0).at("axes").at(0);
  EXPECT_EQ(lines[1],
            fmt::format("  {:20} {:8} {:9.3g} {:8.2f} {:9.3g} {:9.3f} {:8.2f}  1/1 (+0.0 ms), 0/0, 0/0", "k",
                        "theta", axis.at("rms").get<double>(), axis.at("rms_jnd").get<double>(),
                        axis.at("worst").get<double>(), axis.at("worst_at_s").get<double>(),
                        axis.at("worst_jnd").get<double>()));
  EXPECT_THAT(replay.notes, IsEmpty());
}

TEST_F(ReplayThrough, NotesWhatIsSpecialAboutTheRecording) {
  EXPECT_THAT(replay_through(sine(100, 200), laws(), {}, never).notes,
              ElementsAre(HasSubstr("kept as they are")));
  EXPECT_THAT(replay_through(sine(100, 200), laws(), {.bridge = true}, never).notes,
              ElementsAre(HasSubstr("bridged by straight lines")));
  schema::Recording uneven = test::sine_of_scissors();
  uneven.time[7] += 1e-5;
  EXPECT_THAT(replay_through(select_rows(uneven, {}, "uneven.h5"), laws(), {}, never).notes,
              ElementsAre(StartsWith("the times are no whole ticks of one period")));
  schema::Recording written = test::sine_of_scissors();  // with as many digits as a text has
  for (double& time_s : written.time) time_s = std::nextafter(time_s, 1e9);
  EXPECT_THAT(replay_through(select_rows(written, {}, "written.h5"), laws(), {}, never).notes, IsEmpty());
}

TEST(ReplayPath, SaysHowFarOffItsPathTheDeviceWas) {
  const PathReplay replay = replay_path(
      sine(), {.run = {.device_uri = "sim:scissors?hand=off", .seconds = 1e6, .virtual_time = true}}, never);
  EXPECT_TRUE(replay.report.finished);
  EXPECT_GT(replay.report.error_rms(0), 0.0);
  EXPECT_LT(replay.report.error_rms(0), replay.report.axes[0].worst);
  EXPECT_THAT(path_lines(replay),
              ElementsAre(fmt::format(
                  "  theta: {:.3g} rad off the path (rms), {:.3g} at worst; {} ticks at the "
                  "coupling's force limit",
                  replay.report.error_rms(0), replay.report.axes[0].worst, replay.report.axes[0].limited)));
}

TEST(AlongAxis, LeavesOneAxisOfEveryColumn) {
  Source source = sine();
  schema::Recording& recording = source.recording;
  recording.axes.push_back({.name = "x_s", .position_unit = "m", .force_unit = "N"});
  for (auto* column :
       {&recording.position, &recording.velocity, &recording.force_commanded, &recording.force_measured}) {
    const std::vector<double> one = *column;
    column->clear();
    for (const double value : one) column->insert(column->end(), {value, value + 7.0});
  }
  const schema::Recording one = along_axis(source, 1).recording;
  const schema::Recording expected = test::sine_of_scissors();
  ASSERT_THAT(one.axes, SizeIs(1));
  EXPECT_EQ(one.axes[0].name, "x_s");
  ASSERT_EQ(one.position.size(), expected.position.size());
  EXPECT_EQ(one.position[5], expected.position[5] + 7.0);
  EXPECT_EQ(one.force_measured[5], expected.force_measured[5] + 7.0);
}

}  // namespace
}  // namespace kerf::bench

#include "views/thumbnail.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::SizeIs;

/// A force that grows by one newton a row.
schema::Recording ramp(std::size_t rows) {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {schema::Axis{}};
  for (std::size_t i = 0; i < rows; ++i) {
    recording.time.push_back(1e-3 * static_cast<double>(i));
    recording.tick.push_back(i);
    recording.position.push_back(0.0);
    recording.velocity.push_back(0.0);
    recording.force_measured.push_back(static_cast<double>(i));
  }
  return recording;
}

class Thumbnail : public testing::Test {
 protected:
  json of(const schema::Recording& recording) {
    schema::write_recording(file_, recording);
    return json::parse(thumbnails_.of(file_));
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "r.h5";
  Thumbnails thumbnails_;
};

TEST_F(Thumbnail, HasTheExtremesOfEachColumn) {
  const std::size_t rows = 100 * Thumbnails::columns;
  const json small = of(ramp(rows));
  EXPECT_EQ(small["signal"], "force measured");
  ASSERT_THAT(small["low"], SizeIs(Thumbnails::columns));
  const auto low = small["low"].get<std::vector<int>>();
  const auto high = small["high"].get<std::vector<int>>();
  EXPECT_EQ(low.front(), 0);
  EXPECT_EQ(high.back(), 100);
  EXPECT_TRUE(std::ranges::is_sorted(low));
  for (std::size_t k = 0; k < low.size(); ++k) EXPECT_GE(high[k], low[k]) << k;
}

TEST_F(Thumbnail, MissesNoPeakOfARecordingOfAMinute) {
  schema::Recording recording = ramp(60'000);
  for (double& force : recording.force_measured) force = 0.0;
  recording.force_measured[41'234] = 5.0;
  const auto high = of(recording)["high"].get<std::vector<int>>();
  EXPECT_EQ(std::ranges::max(high), 100);
  EXPECT_EQ(std::ranges::count(high, 100), 1);
}

TEST_F(Thumbnail, HasAColumnARowOfAShortRecordingAndNoneOfAnEmptyOne) {
  EXPECT_THAT(of(ramp(3))["low"], ElementsAre(0, 50, 100));
  EXPECT_THAT(of(ramp(1))["low"], ElementsAre(50));
  EXPECT_THAT(of(ramp(0))["low"], SizeIs(0));
}

TEST_F(Thumbnail, LeavesOutWhatIsNoNumber) {
  schema::Recording recording = ramp(3);
  recording.force_measured[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(of(recording)["high"], ElementsAre(0, -1, 100));
}

TEST_F(Thumbnail, CountsCyclesAndThoseThatAreNotGood) {
  schema::Recording recording = ramp(12);
  EXPECT_EQ(of(recording)["cycles"], -1);
  recording.cycles.emplace();
  for (std::uint32_t cycle = 1; cycle <= 3; ++cycle) {
    const std::uint64_t begin = 4 * (cycle - 1);
    recording.cycles->phases.push_back(
        {.cycle = cycle, .phase = schema::Phase::closing, .begin = begin, .end = begin + 2});
    recording.cycles->phases.push_back(
        {.cycle = cycle, .phase = schema::Phase::opening, .begin = begin + 2, .end = begin + 4});
  }
  recording.cycle_flags.emplace();
  recording.cycle_flags->created = "2026-01-01T00:00:00Z";
  recording.cycle_flags->flags = {{.cycle = 1, .fault = "clipped", .reason = "clipped in 2 rows"},
                                  {.cycle = 1, .fault = "outlier", .reason = "too large"},
                                  {.cycle = 2, .fault = "clipped", .reason = "clipped in 1 row"},
                                  {.cycle = 2, .fault = "accepted", .reason = "it does not matter"}};
  const json small = of(recording);
  EXPECT_EQ(small["cycles"], 3);
  EXPECT_EQ(small["flagged"], 1);
}

TEST_F(Thumbnail, IsMadeAnewWhenTheFileHasChanged) {
  EXPECT_THAT(of(ramp(3))["low"], SizeIs(3));
  EXPECT_THAT(of(ramp(5))["low"], SizeIs(5));
}

TEST_F(Thumbnail, SaysWhyThereIsNone) { EXPECT_ANY_THROW((void)thumbnails_.of(folder_.path() / "no.h5")); }

}  // namespace
}  // namespace kerf::bench

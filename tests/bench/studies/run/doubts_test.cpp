#include "run/doubts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/studies/studied.h"

namespace kerf::bench {
namespace {

using test::five_specimens;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Doubts, AreNoneOfSpecimensThatDifferAsSpecimensDo) {
  auto recordings = five_specimens("liver", 1.0);
  for (DrawerRecording& one : five_specimens("skin", 4.0)) recordings.push_back(std::move(one));
  doubt_recordings(recordings);
  for (const DrawerRecording& one : recordings) EXPECT_THAT(one.doubts, IsEmpty()) << one.name;
}

TEST(Doubts, NameTheUnitThatWasMistaken) {
  auto recordings = five_specimens("liver", 1.0);
  recordings[2].result.travel *= 1000.0;
  recordings[3].result.period_s *= 1000.0;
  for (StudiedCycle& cycle : recordings[4].result.cycles) cycle.peak *= 9.80665;
  doubt_recordings(recordings);
  EXPECT_THAT(recordings[0].doubts, IsEmpty());
  EXPECT_THAT(recordings[2].doubts, ElementsAre(HasSubstr("mm taken for m")));
  EXPECT_THAT(recordings[3].doubts, ElementsAre(HasSubstr("ms taken for s")));
  EXPECT_THAT(recordings[4].doubts, ElementsAre(HasSubstr("kgf")));
  EXPECT_FALSE(recordings[4].counts());
  recordings[4].file.accepted = "the knife was blunt";
  EXPECT_TRUE(recordings[4].counts());
}

TEST(Doubts, OfForcesAreAmongRecordingsOfOneTissue) {
  auto recordings = five_specimens("liver", 1.0);
  for (DrawerRecording& one : five_specimens("cartilage", 30.0)) recordings.push_back(std::move(one));
  doubt_recordings(recordings);
  for (const DrawerRecording& one : recordings) EXPECT_THAT(one.doubts, IsEmpty()) << one.name;
}

TEST(Doubts, AreOfWhatClosesTheOtherWayOrIsAnotherAxis) {
  auto recordings = five_specimens("liver", 1.0);
  recordings[1].result.closing_direction = -1.0;
  recordings[2].result.position_unit = "rad";
  doubt_recordings(recordings);
  EXPECT_THAT(recordings[1].doubts, ElementsAre(HasSubstr("other way round")));
  EXPECT_THAT(recordings[2].doubts, ElementsAre(HasSubstr("N over rad")));
}

TEST(Doubts, AreOfARecordingWithoutAGoodCycle) {
  auto recordings = five_specimens("liver", 1.0);
  for (StudiedCycle& cycle : recordings[0].result.cycles) {
    cycle.is_good = false;
    cycle.reason = "the sensor is clipped in 9 rows";
  }
  auto all_count = recordings;
  doubt_recordings(recordings);
  EXPECT_THAT(recordings[0].doubts,
              ElementsAre(HasSubstr("none of its 2 cycles is good; of the first, the sensor")));
  doubt_recordings(all_count, true);
  EXPECT_THAT(all_count[0].doubts, IsEmpty());
}

TEST(Doubts, AreOfWhatNoBlankWasTakenOffBesideThoseThatAreLessOne) {
  auto recordings = five_specimens("liver", 1.0);
  for (DrawerRecording& one : five_specimens("skin", 1.0)) recordings.push_back(std::move(one));
  recordings.push_back(test::studied({.name = "blank", .tissue = "", .peak = 0.9}));
  recordings.back().file.blank = true;
  for (DrawerRecording& one : recordings)
    if (!one.file.blank) one.result.blank.emplace().why_none = "it covers no row";
  for (const std::size_t less : {0U, 1U, 3U}) recordings[less].result.blank->name = "blank";
  doubt_recordings(recordings);
  EXPECT_THAT(recordings[0].doubts, IsEmpty());
  EXPECT_FALSE(recordings[0].share_of_tool.has_value());  // it was taken off
  EXPECT_THAT(recordings[2].doubts,
              ElementsAre(HasSubstr("off 3 of its tissue and speed (it covers no row)")));
  EXPECT_TRUE(recordings[2].share_of_tool.has_value());
  EXPECT_THAT(recordings[5].doubts, IsEmpty());  // none was taken off any skin
}

TEST(Doubts, OfBlanksAreNoneAndTheirShareIsKnown) {
  auto recordings = five_specimens("liver", 1.0);
  recordings.push_back(test::studied({.name = "blank", .tissue = "", .peak = 0.5}));
  recordings.back().file.blank = true;
  doubt_recordings(recordings);
  EXPECT_THAT(recordings.back().doubts, IsEmpty());
  EXPECT_FALSE(recordings.back().counts());
  ASSERT_TRUE(recordings[0].share_of_tool.has_value());
  EXPECT_NEAR(*recordings[0].share_of_tool, 0.5, 1e-12);
  EXPECT_TRUE(recordings[0].counts());
}

}  // namespace
}  // namespace kerf::bench

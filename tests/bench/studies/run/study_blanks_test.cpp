#include "run/study_blanks.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/studies/rubbed.h"
#include "segment/segment.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double friction_n = 0.3;
constexpr test::Tissue no_tissue{.parallel_stiffness = 0.0, .seconds = 6.0};

class StudyBlankTaken : public testing::Test {
 protected:
  StudyBlank blank(const std::string& name, const schema::Recording& recording) {
    schema::write_recording(folder_ / (name + ".h5"), recording);
    return {.name = name, .recording = folder_ / (name + ".h5"), .key = ""};
  }
  static schema::Recording cut(double friction) {
    schema::Recording recording = test::rubbed_punch({.seconds = 6.0, .seed = 2}, friction);
    recording.cycles = find_cycles(recording, {});
    return recording;
  }
  test::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

// Away from the turns, where friction changes its sign, the tissue is left.
TEST_F(StudyBlankTaken, LeavesTheTissue) {
  schema::Recording less = cut(friction_n);
  const schema::Recording tissue = cut(0.0);
  const StudiedBlank taken =
      take_blank_off(less, {.all = {blank("air", test::rubbed_punch(no_tissue, friction_n))}}, warnings_);
  EXPECT_EQ(taken.name, "air");
  EXPECT_NEAR(taken.taken_rms, 1.1 * friction_n, 0.03);
  EXPECT_FALSE(taken.is_hardly_known());
  double most = 0.0;
  std::size_t rows = 0;
  for (const schema::PhaseSpan& span : less.cycles->phases) {
    if (span.phase != schema::Phase::closing && span.phase != schema::Phase::opening) continue;
    for (std::size_t row = span.begin + 20; row + 20 < span.end; ++row, ++rows)
      most = std::max(most, std::abs(less.force_measured[row] - tissue.force_measured[row]));
  }
  EXPECT_GT(rows, 2000U);
  EXPECT_LT(most, 0.02);
}

TEST_F(StudyBlankTaken, OfSeveralIsTheOneThatCoversMost) {
  test::Tissue shallow = no_tissue;
  shallow.depth_m = 0.002;
  schema::Recording less = cut(friction_n);
  const StudiedBlank taken =
      take_blank_off(less,
                     {.all = {blank("shallow", test::rubbed_punch(shallow, friction_n)),
                              blank("deep", test::rubbed_punch(no_tissue, friction_n))}},
                     warnings_);
  EXPECT_EQ(taken.name, "deep");
}

TEST_F(StudyBlankTaken, IsNoneOfAnotherDeviceOrElsewhere) {
  schema::Recording other = test::rubbed_punch(no_tissue, friction_n);
  other.header.device_uri = "falcon:0";
  schema::Recording elsewhere = test::rubbed_punch(no_tissue, friction_n);
  for (double& position : elsewhere.position) position += 1.0;
  schema::Recording less = cut(friction_n);
  const schema::Recording before = less;
  const StudyBlanks blanks{.all = {blank("falcon", other), blank("elsewhere", elsewhere), {.name = "gone"}}};
  const StudiedBlank taken = take_blank_off(less, blanks, warnings_);
  EXPECT_FALSE(taken.is_taken());
  EXPECT_THAT(taken.why_none,
              testing::AllOf(HasSubstr("falcon: its device is 'falcon:0'"),
                             HasSubstr("elsewhere: it covers no row"), HasSubstr("gone could not be used")));
  EXPECT_EQ(less.force_measured, before.force_measured);
}

TEST(FittingBlanks, AreOfTheSameRigAndSpeed) {
  StudyPlan plan;
  plan.files = {{.path = "a", .speed = "slow", .rig = "rig1", .blank = true},
                {.path = "b", .speed = "fast", .rig = "rig1", .blank = true},
                {.path = "c", .speed = "", .rig = "rig1", .blank = true},
                {.path = "d", .speed = "slow", .rig = "rig2", .blank = true},
                {.path = "e", .ignored = "why", .speed = "slow", .rig = "rig1", .blank = true}};
  EXPECT_THAT(fitting_blanks(plan, {.speed = "slow", .rig = "rig1"}), ElementsAre(0U));
  EXPECT_THAT(fitting_blanks(plan, {.speed = "medium", .rig = "rig1"}), ElementsAre(2U));
  EXPECT_THAT(fitting_blanks(plan, {.speed = "slow", .rig = "rig2"}), ElementsAre(3U));
  EXPECT_THAT(fitting_blanks(plan, {.speed = "slow"}), IsEmpty());
  EXPECT_THAT(fitting_blanks(plan, {.speed = "slow", .rig = "rig1", .less_blank = "d"}), ElementsAre(3U))
      << "a person has named it";
}

}  // namespace
}  // namespace kerf::bench

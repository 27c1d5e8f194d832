#include "import/unit_doubts.h"

#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/measured_data.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What an import of a punch by hand warns of: 12 degrees, 7.5 N, a row every 3 ms for a minute.
std::vector<std::string> warnings_of_punch(const std::string& header, const std::string& map) {
  const test::TemporaryFolder folder;
  std::string text = header + "\n";
  for (int i = 0; i < 20'000; ++i)
    text += fmt::format("{},{:.2f},{:.3f}\n", 3 * i, 0.06 * (i % 201), 0.03 * (i % 251));
  test::write_text(folder / "t.csv", text);
  return import_text(folder / "t.csv", {.map = parse_map(map)}).warnings;
}

TEST(UnitDoubts, AreNoneWhereMapAndHeadingAgree) {
  EXPECT_THAT(warnings_of_punch("t_ms,angle_deg,force_N", "time=1[ms],position=2[deg],force=3[N]"),
              IsEmpty());
  EXPECT_THAT(warnings_of_punch("t_ms,angle_deg,force_N", "time=1,position=2,force=3"), IsEmpty());
  EXPECT_THAT(warnings_of_punch("t_ms,angle_deg,force_V", "time=1,position=2,raw=3[1]"), IsEmpty());
  EXPECT_THAT(warnings_of_punch("a,b [counts],c", "time=1[ms],position=2[0.5 deg],force=3[N]"), IsEmpty());
}

TEST(UnitDoubts, NameTheUnitOfTheHeadingAndThatOfTheMap) {  // finding L5
  EXPECT_THAT(
      warnings_of_punch("t_ms,angle_deg,force_N", "time=1[ms],position=2[mm],force=3[N]"),
      ElementsAre("column 2 'angle_deg' is in deg as the file says, and mapped to position in mm; which is "
                  "right?"));
  EXPECT_THAT(warnings_of_punch("t_ms,angle_deg,force_N", "time=1[ms],position=2[deg],force=3[gf]"),
              ElementsAre(HasSubstr("is in N as the file says, and mapped to force_measured in gf")));
}

TEST(UnitDoubts, NameRawNumbersThatAreTakenForAUnitOneToOne) {
  EXPECT_THAT(
      warnings_of_punch("t_ms,encoder [counts],force (N)", "time=1,position=2[deg],force=3"),
      ElementsAre("column 2 'encoder [counts]' is in counts as the file says, and mapped to position in "
                  "deg one to one; how many are one deg?"));
  EXPECT_THAT(warnings_of_punch("t_ms,encoder [counts],force (N)", "time=1,position=2[counts/4 deg],force=3"),
              IsEmpty());
}

TEST(UnitDoubts, NameAUnitThatIsNotKnownAndIsTakenForOneOfOurs) {
  EXPECT_THAT(
      warnings_of_punch("t_ms,angle (deg),force (dyn)", "time=1,position=2,force=3[N]"),
      ElementsAre(HasSubstr("is in dyn as the file says, and mapped to force_measured in N one to one")));
  EXPECT_THAT(warnings_of_punch("t_ms,angle (deg),force (dyn)", "time=1,position=2,force=3[0.00001 N]"),
              IsEmpty());
}

TEST(UnitDoubts, AreNoneOfASignOrAFactorThatSomebodyChose) {
  const std::string header = "t_ms,angle_deg,force_N";
  EXPECT_THAT(warnings_of_punch(header, "time=1,position=2[-1 deg],force=3[-1 N]"), IsEmpty());
  EXPECT_THAT(warnings_of_punch(header, "time=1,position=2,force=3[0.5 N]"), IsEmpty());
  EXPECT_THAT(warnings_of_punch(header, "time=1,position=2,force=3[-1 mN]"),
              ElementsAre(HasSubstr("which is right?")));
}

TEST(UnitDoubts, AreNoneOfAMassThatIsTakenForItsWeight) {
  EXPECT_THAT(warnings_of_punch("t_ms,angle_deg,force (g)", "time=1,position=2,force=3[gf]"), IsEmpty());
  EXPECT_THAT(warnings_of_punch("t_ms,angle_deg,force (lbs)", "time=1,position=2,force=3[-1 lbf]"),
              IsEmpty());
  EXPECT_THAT(warnings_of_punch("t_ms,angle_deg,force (g)", "time=1,position=2,force=3[N]"),
              ElementsAre(HasSubstr("which is right?")));
}

TEST(UnitDoubts, NameWhatNoHandDoes) {
  EXPECT_THAT(warnings_of_punch("a,b,c", "time=1[ms],position=2[deg],force=3[kN]"),
              ElementsAre("force_measured reaches 7500 N with its column in kN; is that unit right?"));
  EXPECT_THAT(warnings_of_punch("a,b,c", "time=1[ms],position=2[rad],force=3[N]"),
              ElementsAre("position goes over 12 rad with its column in rad; is that unit right?"));
  EXPECT_THAT(
      warnings_of_punch("a,b,c", "time=1[s],position=2[deg],force=3[N]"),
      ElementsAre("the recording takes 16.7 hours at 0.333 Hz with its time in s; is that unit right?"));
  EXPECT_THAT(warnings_of_punch("a,b,c", "time=1[ms],position=2[deg],force=3[Nm]"), IsEmpty()) << "7.5 N·m";
}

TEST(UnitDoubts, OfAPunchInGramsThatIsTakenForNewtons) {
  const std::string file = "meniscus/9_meniscus_slow_1824.txt";
  KERF_NEEDS_DATA(file);
  const auto warnings = [&](const std::string& map) {
    return import_text(test::measured_file(file), {.map = parse_map(map)}).warnings;
  };
  EXPECT_THAT(warnings("time=5[ms],position=4[deg],force=2[N]"), Contains(HasSubstr("reaches 705.8 N")));
  EXPECT_THAT(warnings("time=5[s],position=4[deg],force=2[gf]"), Contains(HasSubstr("takes 14.0 hours")));
}

}  // namespace
}  // namespace kerf::bench

#include "import/column_map.h"

#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::HasSubstr;

const TextLayout punch{.separator = ',',
                       .columns = {{"t", "t", "ms"},
                                   {"Angle", "Angle", ""},
                                   {"Load, total [gf]", "Load, total", "gf"},
                                   {"x", "x", "mm"},
                                   {"Load [V]", "Load [V]", "V"}}};

std::string refusal(const std::string& map) {
  try {
    (void)match_columns(parse_map(map), punch, "punch.csv");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ColumnMap, TakesNumbersNamesFactorsAndTheFilesUnits) {
  const auto columns = match_columns(
      parse_map(R"(time=1,position=Angle[0.5 deg],force="Load, total"[mN],sway=4)"), punch, "punch.csv");
  ASSERT_EQ(columns.size(), 4U);
  EXPECT_EQ(columns[0].unit, (Unit{1e-3, "s"}));
  EXPECT_TRUE(columns[0].unit_from_file);
  EXPECT_EQ(columns[1].index, 1U);
  EXPECT_DOUBLE_EQ(columns[1].unit.factor, 0.5 * std::numbers::pi / 180.0);
  EXPECT_EQ(columns[2].channel, "force_measured");
  EXPECT_EQ(columns[2].index, 2U);
  EXPECT_EQ(columns[2].unit, (Unit{1e-3, "N"})) << "the map's unit wins over the file's";
  EXPECT_EQ(columns[3].channel, "sway");
  EXPECT_EQ(columns[3].unit, (Unit{1e-3, "m"}));
}

TEST(ColumnMap, TakesAHeadingWithOrWithoutItsUnit) {
  const auto columns = match_columns(
      parse_map(R"( time = t , force = "Load, total [gf]", raw = "Load [V]"[1], position = 4 [mm] )"), punch,
      "punch.csv");
  EXPECT_EQ(columns[1].index, 2U);
  EXPECT_EQ(columns[1].unit_text, "gf");
  EXPECT_EQ(columns[2].index, 4U);
  EXPECT_EQ(columns[2].unit_text, "1");
  EXPECT_EQ(columns[3].index, 3U);
}

TEST(ColumnMap, IsMadeFromColumnsThatAreShownByTheirNumbers) {
  const TextLayout layout{.separator = ',', .columns = {{"t [s]", "t", "s"}, {}}};
  EXPECT_EQ(describe_columns(layout, "0,1\n1,2\n2,3\n3,4\n"),
            "  1  t [s]: 0 1 2 ...\n  2  (no name): 1 2 3 ...");
}

TEST(ColumnMap, SaysWhatIsWrongWithIt) {
  EXPECT_THAT(refusal("time"), HasSubstr("'time' has no '='; expected CHANNEL=COLUMN[unit]"));
  EXPECT_THAT(refusal("=1[s]"), HasSubstr("no channel name"));
  EXPECT_THAT(refusal("time=[s]"), HasSubstr("names no column"));
  EXPECT_THAT(refusal("time=1[]"), HasSubstr("empty unit"));
  EXPECT_THAT(refusal("time=1s]"), HasSubstr("closes a bracket"));
  EXPECT_THAT(refusal("time=1[s],time=2[s]"), HasSubstr("'time' is mapped twice"));
  EXPECT_THAT(
      refusal("position=9[mm]"),
      HasSubstr("punch.csv: --map asks for column '9' for position, but the file has 1 't', 2 'Angle'"));
  EXPECT_THAT(refusal("position=0[mm]"), HasSubstr("column '0'"));
  EXPECT_THAT(refusal("position=angle[deg]"), HasSubstr("column 'angle'"));
  EXPECT_THAT(refusal("position=2"),
              HasSubstr("has no unit in the file; give one in brackets: position=2[m]"));
  EXPECT_THAT(refusal("position=2[furlong]"), HasSubstr("unknown unit 'furlong'"));
  EXPECT_THAT(refusal("position=2[N]"),
              HasSubstr("position in 'N' is not a unit of position; expected one of the kind m or rad"));
  EXPECT_THAT(refusal("time=1[mm],position=2[deg]"), HasSubstr("expected one of the kind s"));
  EXPECT_THAT(refusal("time=1[s]"), HasSubstr("maps no position"));
  EXPECT_THAT(refusal("position=4,force=3[g]"),
              HasSubstr("expected one of the kind N or N·m; a weight is written gf"));
  EXPECT_THAT(refusal("position=4,force=3[V]"), HasSubstr("'V' is not a unit of force"));
  EXPECT_THAT(refusal("position=4,force=3[N],force_commanded=2[N*m]"),
              HasSubstr("one force is in N and the other in N·m"));
  EXPECT_THAT(refusal("position=4,velocity=2[deg/s]"),
              HasSubstr("velocity in rad/s does not fit a position in m"));
}

}  // namespace
}  // namespace kerf::bench

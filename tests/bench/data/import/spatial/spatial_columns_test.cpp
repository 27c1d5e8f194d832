#include "import/spatial/spatial_columns.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TextLayout tool_layout() {
  TextLayout layout{.separator = ',', .columns = {}};
  for (const char* name : {"t", "x", "y", "z", "qx", "qy", "qz", "qw", "fx", "fy", "fz", "tx", "ty", "a:b"})
    layout.columns.push_back({.heading = name, .name = name, .unit = ""});
  return layout;
}

struct Matched {
  std::vector<MappedColumn> columns;
  std::optional<SpatialMap> spatial;
};
Matched matched(const std::string& map) {
  const auto entries = parse_map(map);
  auto columns = match_columns(entries, tool_layout(), "tool.csv");
  auto spatial = spatial_map_of(entries, columns);
  return {.columns = std::move(columns), .spatial = std::move(spatial)};
}
std::string refusal_of_map(const std::string& map) {
  try {
    (void)matched(map);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}
std::vector<std::string> columns_of(const std::string& map) {
  std::vector<std::string> texts;
  for (const MappedColumn& column : matched(map).columns)
    texts.push_back(column.channel + "=" + std::to_string(column.index + 1) + "[" + column.unit_text + "]");
  return texts;
}

const std::string place = "position=x:z[m]";
const std::string turn = ",orientation=5:8[quaternion xyzw]";

TEST(SpatialColumns, StandSideBySideByNumbersOrHeadings) {
  EXPECT_THAT(columns_of("position=2:4[mm],orientation=qx:qw[quaternion wxyz]"),
              ElementsAre("position.x=2[mm]", "position.y=3[mm]", "position.z=4[mm]", "orientation.1=5[1]",
                          "orientation.2=6[1]", "orientation.3=7[1]", "orientation.4=8[1]"));
  EXPECT_THAT(columns_of(R"(position="x":"z"[m],orientation=9:11[euler zyx 0.1 deg])"),
              ElementsAre("position.x=2[m]", "position.y=3[m]", "position.z=4[m]", "orientation.1=9[0.1 deg]",
                          "orientation.2=10[0.1 deg]", "orientation.3=11[0.1 deg]"));
}

TEST(SpatialColumns, OfAWrenchHaveTwoUnitsAndAFrame) {
  const Matched all = matched(place + turn + ",wrench=9:14[-1 N 0.5 N·m sensor]");
  EXPECT_EQ(all.columns[7].channel, "force.x");
  EXPECT_EQ(all.columns[7].unit, (Unit{-1.0, "N"}));
  EXPECT_EQ(all.columns[12].channel, "torque.z");
  EXPECT_EQ(all.columns[12].unit, (Unit{0.5, "N·m"}));
  EXPECT_EQ(all.spatial->frame, "sensor");
  EXPECT_TRUE(all.spatial->has_torque);
}

TEST(SpatialColumns, AreNamedOneByOneWhereTheyDoNotStandSideBySide) {
  const Matched all = matched(
      "position.y=y[mm],position.x=x[mm],position.z=4[m],force.x=fx[mN world],"
      "force.z=11[N world],force.y=fy[N world]");
  EXPECT_EQ(all.columns[0].index, 2U);
  EXPECT_FALSE(all.spatial->orientation);
  EXPECT_EQ(all.spatial->frame, "world");
}

TEST(SpatialColumns, LeaveMapsOfOneAxisAsTheyAre) {
  EXPECT_THAT(columns_of("position=x[m],force=a:b[N],torque=tx[N·m],frame=ty[1]"),
              ElementsAre("position=2[m]", "force_measured=14[N]", "torque=12[N·m]", "frame=13[1]"));
  EXPECT_FALSE(matched("position=x[m],force=fx[N]").spatial);
}

TEST(SpatialColumns, AreRefusedWithoutAFrame) {
  EXPECT_THAT(refusal_of_map(place + turn + ",wrench=9:14[N N·m]"),
              HasSubstr("--map: wrench=9:14[N N·m] does not say in which frame it is; end the brackets with "
                        "sensor (axes that turn with the tool) or world"));
  EXPECT_THAT(refusal_of_map(place + turn + ",force=9:11[N]"), HasSubstr("does not say in which frame"));
  EXPECT_THAT(refusal_of_map(place + turn + ",force.x=9[N],force.y=10[N],force.z=11[N]"),
              HasSubstr("force.x=9[N] does not say in which frame"));
  EXPECT_THAT(refusal_of_map(place + turn + ",force=9:11[N world],torque=12:14[N·m sensor]"),
              HasSubstr("one force is in the frame world and another in sensor"));
}

TEST(SpatialColumns, AreRefusedWithoutWhatGoesWithThem) {
  EXPECT_THAT(refusal_of_map("position.x=2[m],position.z=4[m]"), HasSubstr("is mapped without position.y"));
  EXPECT_THAT(refusal_of_map("time=t[s],orientation=5:8[quaternion xyzw]"),
              HasSubstr("orientation.1 is mapped without position.x"));
  EXPECT_THAT(refusal_of_map(place + ",force=9:11[N sensor]"), HasSubstr("needs the sensor's orientation"));
  EXPECT_THAT(refusal_of_map(place + ",wrench=9:14[N N·m world]"), HasSubstr("without an orientation"));
  EXPECT_THAT(refusal_of_map(place + turn + ",torque=9:11[N·m world]"), HasSubstr("without its force"));
  EXPECT_THAT(refusal_of_map(place + ",force=9[N]"), HasSubstr("force_measured is of one axis"));
  EXPECT_THAT(refusal_of_map(place + ",velocity=9[m/s]"), HasSubstr("velocity is of one axis"));
  EXPECT_THAT(refusal_of_map(place + ",position.x=9[m]"), HasSubstr("'position.x' is mapped twice"));
}

TEST(SpatialColumns, AreRefusedWithoutTheirForm) {
  for (const char* form : {"", "[deg]", "[quaternion]", "[quaternion xyz]", "[rotvec]", "[euler xxy deg]",
                           "[euler xYz deg]", "[euler xyz]", "[matrix rad]", "[quaternion xyzw rad]"}) {
    EXPECT_THAT(refusal_of_map(place + ",orientation=5:8" + form),
                HasSubstr("does not say how it is written; expected [quaternion xyzw]"))
        << form;
  }
}

TEST(SpatialColumns, AreRefusedIfTheyAreNotAsManyAsItTakes) {
  EXPECT_THAT(
      refusal_of_map(place + ",orientation=5:7[quaternion xyzw]"),
      HasSubstr("orientation=5:7 is from column 5 to 7; expected 4 columns side by side for quaternion"));
  EXPECT_THAT(refusal_of_map(place + ",orientation=5[rotvec rad]"), HasSubstr("expected FIRST:LAST"));
  EXPECT_THAT(refusal_of_map("position=4:2[m]"), HasSubstr("from column 4 to 2; expected 3"));
  EXPECT_THAT(refusal_of_map(place + ",force=9[N world]"), HasSubstr("has a frame and is one column"));
  EXPECT_THAT(refusal_of_map("position=2:40[m]"), HasSubstr("asks for column '40'"));
  EXPECT_THAT(refusal_of_map(place + turn + ",wrench=9:14[N·m N sensor]"),
              HasSubstr("has not a unit of force and one of torque"));
  EXPECT_THAT(refusal_of_map(place + ",orientation=5:7[rotvec mm]"),
              HasSubstr("is not a unit of orientation"));
}

}  // namespace
}  // namespace kerf::bench

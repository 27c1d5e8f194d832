#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/import.h"
#include "support/measured_data.h"

// Measurements of other labs, as they published them.

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class RealText : public testing::Test {
 protected:
  static Imported imported(const std::string& data, const std::string& map, double rate_hz = 0.0) {
    return import_text(test::measured_file(data), {.map = parse_map(map), .rate_hz = rate_hz});
  }
  static double highest(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  }
};

TEST(MeasuredData, AreMissedWithTheCommandThatBringsThem) {
  EXPECT_THAT(test::why_left_out("meniscus/9_meniscus_slow_1824.txt"),
              StartsWith("measured data: scripts/fetch-data brings them\n"));
  EXPECT_THAT(test::why_left_out("liver/pig_liver_20150826_region1.csv"),
              StartsWith("measured data that no public address has as it is\n"));
}

TEST_F(RealText, OfEveryPunchHasOneLineThatIsNotData) {
  const std::map<std::string, std::size_t> rows{{"7_blank_slow_1819", 17421},
                                                {"8_blank_fast_1821", 12100},
                                                {"9_meniscus_slow_1824", 17687},
                                                {"11_meniscus_fast_1826", 23988},
                                                {"15_skin_knee_lateral_slow_1900", 22062}};
  for (const auto& [name, count] : rows) {
    KERF_NEEDS_DATA("meniscus/" + name + ".txt");
    const Imported result = imported("meniscus/" + name + ".txt", "time=5[ms],position=4[deg],force=2[gf]");
    EXPECT_EQ(result.recording.rows(), count) << name;
    EXPECT_THAT(result.bad_lines, ElementsAre(count + 1)) << name;
    EXPECT_THAT(result.misplaced_lines, IsEmpty()) << name;
    EXPECT_EQ(result.layout.separator, '\t') << name;
  }
}

TEST_F(RealText, OfATendonBringsItsUnitsAlong) {
  for (const auto& [name, count] :
       std::map<std::string, std::size_t>{{"relaxation_fresh_1", 1888}, {"failure_fresh_5", 1185}}) {
    KERF_NEEDS_DATA("tendon/" + name + ".csv");
    const Imported result = imported("tendon/" + name + ".csv",
                                     "time=Time,position=Extension,force=Load,stress=Tensile stress,"
                                     "strain=Tensile strain (Extension)");
    EXPECT_EQ(result.recording.rows(), count) << name;
    EXPECT_THAT(result.bad_lines, IsEmpty()) << name;
    EXPECT_TRUE(result.layout.quoted) << name;
    EXPECT_EQ(result.recording.channels.at(0).unit, "Pa") << name;
    EXPECT_EQ(result.columns.at(3).unit_text, "MPa") << name;
  }
}

TEST_F(RealText, OfVhbHasItsHeaderInUtf8AndGbk) {
  for (const auto& [name, count] :
       std::map<std::string, std::size_t>{{"relaxation_4d0", 36244}, {"cycle_0d03_1d5_gbk", 1675}}) {
    KERF_NEEDS_DATA("vhb/" + name + ".csv");
    const Imported result = imported("vhb/" + name + ".csv", "time=时间,position=位移,force=3");
    EXPECT_EQ(result.recording.rows(), count) << name;
    EXPECT_THAT(result.bad_lines, IsEmpty()) << name;
    EXPECT_EQ(result.columns.at(1).unit_text, "mm") << name;
  }
}

TEST_F(RealText, OfAGrasperNamesAUnitOfTimeThatIsWrong) {
  const std::string file = "grasper/Tool_4_Maryland_L_2_33.TXT";
  KERF_NEEDS_DATA(file);
  const std::string rest =
      R"(,position="Back-end CUI Encoder [counts]"[0.0439453125 deg],force=3[3.9811e-5 Nm])";
  const Imported result = imported(file, "time=1[s]" + rest);
  EXPECT_EQ(result.recording.rows(), 20000U);
  EXPECT_EQ(result.recording.time.back(), 19.999);
  EXPECT_EQ(result.recording.axes[0].force_unit, "N·m");
  EXPECT_THAT(result.warnings,
              ElementsAre(HasSubstr("column 1 'Back-end Time [ms]' is in ms as the file says, "
                                    "and mapped to time in s; which is right?")));
  EXPECT_THAT(imported(file, "time=Back-end Time" + rest).warnings,
              Contains(HasSubstr("the rate is 1e+06 Hz; is the unit of time right?")));
}

TEST_F(RealText, OfALiverHasNoTimes) {
  const std::string file = "liver/pig_liver_20150826_region1.csv";
  KERF_NEEDS_DATA(file);
  const std::string map = "position=depth_mm,force=normal_force_N,site=site[1]";
  EXPECT_THROW((void)imported(file, map), std::invalid_argument);
  const Imported result = imported(file, map, 10.0);
  EXPECT_EQ(result.recording.rows(), 2210U);
  EXPECT_EQ(highest(result.recording.channels.at(0).values), 220.0);
}

TEST_F(RealText, OfAPeelerKeepsItsLabelsAndTorques) {
  KERF_NEEDS_DATA("peeling/demo4.csv");
  const Imported result =
      imported("peeling/demo4.csv", "time=t_s,position=z_m,force=fz_N,torque=tz_Nm,label=label[1]");
  EXPECT_EQ(result.recording.rows(), 13820U);
  EXPECT_EQ(result.recording.channels.at(0).unit, "N·m");
  EXPECT_EQ(highest(result.recording.channels.at(1).values), 4.0);
  EXPECT_THAT(result.warnings, IsEmpty());
}

}  // namespace
}  // namespace kerf::bench

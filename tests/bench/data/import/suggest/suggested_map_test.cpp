#include "import/suggest/suggested_map.h"

#include <cmath>
#include <functional>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/file_text.h"
#include "import/suggest/time_column.h"
#include "support/measured_data.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

std::string suggested_for(const std::string& text) {
  return suggest_map(find_layout(text, "t.txt"), text).in_words();
}

/// Lines of a tool that goes to and fro, and of its force, behind or before other columns.
std::string lines_of(int count, const std::function<std::string(int row, const std::string& others)>& line) {
  std::string text;
  for (int row = 0; row < count; ++row)
    text += line(row, fmt::format("{:.3f}\t{:.3f}", std::sin(0.01 * row), std::cos(0.02 * row))) + '\n';
  return text;
}

TEST(SuggestedMap, GoesByTheUnitsThatAreKnownThenByNamesAndElseByPlace) {
  const TextLayout punched{.separator = ',',
                           .columns = {{"t [ms]", "t", "ms"},
                                       {"Angle", "Angle", ""},
                                       {"Load, total [gf]", "Load, total", "gf"},
                                       {"way [mm]", "way", "mm"}}};
  EXPECT_EQ(suggest_map(punched, "").in_words(), "--map 'time=1[ms],position=4[mm],force=3[gf]'");
  TextLayout layout{.columns = {{}, {}, {}}};
  EXPECT_EQ(suggest_map(layout, "").in_words(), "--map 'time=1[s],position=2[mm],force=3[N]'");
  layout.columns.pop_back();
  EXPECT_EQ(suggest_map(layout, "").in_words(), "--map 'position=1[mm],force=2[N]' --rate HZ");
  layout.columns = {{"site", "site", ""}, {"F_N", "F_N", "N"}, {"depth_mm", "depth_mm", "mm"}};
  EXPECT_EQ(suggest_map(layout, "").in_words(), "--map 'position=3[mm],force=2[N]' --rate HZ");
  layout.columns = {{"Load", "Load", ""}, {"Angle", "Angle", ""}, {"Time", "Time", ""}};
  EXPECT_EQ(suggest_map(layout, "").in_words(), "--map 'time=3[s],position=2[deg],force=1[N]'");
}

TEST(SuggestedMap, AsksHowManyOfRawNumbersAreOne) {
  const TextLayout layout{.columns = {{"t [ms]", "t", "ms"},
                                      {"Encoder [counts]", "Encoder", "", "counts"},
                                      {"Torque [adc]", "Torque", "", "adc"}}};
  EXPECT_EQ(suggest_map(layout, "").in_words(),
            "--map 'time=1[ms],position=2[counts/? mm],force=3[counts/? Nm]'");
}

TEST(SuggestedMap, AsksWhatOneOfAUnitIsThatIsNotKnown) {
  const TextLayout layout{
      .columns = {{"t [ms]", "t", "ms"}, {"x [mm]", "x", "mm"}, {"Load [dyn]", "Load", "", "dyn"}}};
  const SuggestedMap suggested = suggest_map(layout, "");
  EXPECT_EQ(suggested.map, "time=1[ms],position=2[mm],force=3[? N]");
  EXPECT_THAT(suggested.remarks, ElementsAre(HasSubstr("column 3 is in dyn, which is no unit known here")));
}

TEST(SuggestedMap, AsksWhatAFactorInAHeadingMeans) {
  const std::string text = "t [ms],x [mm],Force (N) x10\n0,1,2\n1,2,3\n";
  const SuggestedMap suggested = suggest_map(find_layout(text, "t.csv"), text);
  EXPECT_EQ(suggested.map, "time=1[ms],position=2[mm],force=3[? N]");
  EXPECT_THAT(suggested.remarks,
              ElementsAre(HasSubstr("column 3 is in (N) x10 as its heading says, a factor")));
}

TEST(SuggestedMap, AsksHowManyOfWholeThousandsAreOne) {
  const std::string text = "t [ms],x [mm],Fz\n0,1,-1234567\n1,2,20\n2,3,40\n";
  const SuggestedMap suggested = suggest_map(find_layout(text, "t.csv"), text);
  EXPECT_EQ(suggested.map, "time=1[ms],position=2[mm],force=3[counts/? N]");
  EXPECT_THAT(suggested.remarks, ElementsAre(HasSubstr("column 3 has whole numbers of a thousand and more")));
  const std::string said = "t [ms],x [mm],Fz [mN]\n0,1,-1234\n1,2,20\n2,3,40\n";
  EXPECT_EQ(suggest_map(find_layout(said, "t.csv"), said).map, "time=1[ms],position=2[mm],force=3[mN]");
}

TEST(SuggestedMap, SaysWhichUnitsAreGuesses) {
  const std::string text = "t,x [mm],Force\n0.0,1,0.2\n0.1,2,0.3\n";
  EXPECT_THAT(
      suggest_map(find_layout(text, "t.csv"), text).remarks,
      ElementsAre("the file says no unit where the map has s of column 1, N of column 3: a guess, to be set "
                  "right by who knows it"));
}

TEST(SuggestedMap, TakesAWeightForTheForceThatItIs) {
  const auto of = [](const std::string& unit) {
    return suggest_map({.columns = {{"Time", "Time", "s"}, {"Way", "Way", "mm"}, {"Force", "Force", unit}}},
                       "");
  };
  EXPECT_EQ(of("g").map, "time=1[s],position=2[mm],force=3[gf]");
  EXPECT_EQ(of("kg").map, "time=1[s],position=2[mm],force=3[kgf]");
  EXPECT_EQ(of("lbs").map, "time=1[s],position=2[mm],force=3[lbf]");
  EXPECT_THAT(of("lbs").remarks,
              ElementsAre("column 3 is in lbs, a mass: what weighs that is a force in lbf"));
}

TEST(SuggestedMap, TakesNoCountOfRowsForTheTime) {
  for (const auto* name :
       {"Sample", "index", "Points", "field.header.seq", "F/T Sequence", "n", "#", "Row"}) {
    EXPECT_EQ(suggested_for(std::string(name) + "\tForce [N]\tPosition [mm]\n" +
                            lines_of(900,
                                     [](int row, const std::string& others) {
                                       return fmt::format("{}\t{}", row, others);
                                     })),
              "--map 'position=3[mm],force=2[N]' --rate HZ")
        << name;
  }
}

TEST(SuggestedMap, NamesTheRateThatTheFileSaysInHz) {
  const auto with = [](const std::string& line) {
    return suggested_for(line + "\nx [mm]\tF [N]\n" +
                         lines_of(90, [](int, const std::string& others) { return others; }));
  };
  EXPECT_THAT(with("Sample Frequency (Hz): 2000"), EndsWith(" --rate 2000"));
  EXPECT_THAT(with("Sampling rate: 2 kHz"), EndsWith(" --rate 2000"));
  EXPECT_THAT(with("fs = 250 Hz"), EndsWith(" --rate 250"));
  EXPECT_THAT(with("RECORDING RATE = 0.0005"), EndsWith(" --rate HZ")) << "seconds, or what?";
  EXPECT_THAT(with("Sample rate: 100 Hz\nScan rate: 200 Hz"), EndsWith(" --rate HZ")) << "one of two";
  EXPECT_THAT(with("Sample rate: 100 of 200 Hz"), EndsWith(" --rate HZ"));
}

TEST(SuggestedMap, TakesWhatWasMeasuredAndNotWhatWasAskedFor) {
  EXPECT_EQ(suggested_for("Time (s),Target position (mm),Position (mm),Force setpoint (N),Force (N)\n"
                          "0.0,1,2,3,4\n0.1,2,3,4,5\n"),
            "--map 'time=1[s],position=3[mm],force=5[N]'");
  EXPECT_EQ(suggested_for("Points,Elapsed Time,Disp,Load 1,Disp Cmd\n1,0.0,0.1,0.2,0.3\n2,0.1,0.2,0.3,0.4\n"),
            "--map 'time=2[s],position=3[mm],force=4[N]'");
}

TEST(SuggestedMap, ReadsTheNamesThatRobotsGive) {
  EXPECT_EQ(
      suggested_for("%time,field.header.seq,field.header.stamp,field.wrench.force.x,field.wrench.torque.x\n"
                    "1592491823000100463,100,1592491823000050463,0.1,0.2\n"
                    "1592491823010100463,101,1592491823010050463,0.2,0.3\n"),
      "--map 'time=1[s],force=4[N]'")
      << "too few lines for the unit of the time";
  EXPECT_EQ(suggested_for("timestamp actual_TCP_pose_0 actual_TCP_pose_1 actual_TCP_force_0\n"
                          "18233.104 0.41 -0.13 0.1\n18233.114 0.42 -0.13 0.2\n"),
            "--map 'time=1[s],position=2[m],force=4[N]'");
}

TEST(SuggestedMap, LeavesOutWhatNoColumnSays) {
  const TextLayout layout{
      .columns = {{"Load [N]", "Load", "N"}, {"Load [mV]", "Load", "mV"}, {"Time [s]", "Time", "s"}}};
  EXPECT_EQ(suggest_map(layout, "").map, "time=3[s],force=1[N]");
  EXPECT_THAT(suggest_map(layout, "").remarks,
              ElementsAre("no column says that it is the position: add position=COLUMN[mm]"));
}

TEST(SuggestedMap, TakesNoColumnOfTextsAndSaysWhyTheTimeIsNone) {
  const std::string text = "Time,Pos (mm),Force (N)\n12:34:56.00,0.1,0.2\n12:34:56.01,0.2,0.3\n";
  const SuggestedMap suggested = suggest_map(find_layout(text, "t.csv"), text);
  EXPECT_EQ(suggested.in_words(), "--map 'position=2[mm],force=3[N]' --rate HZ");
  EXPECT_THAT(
      suggested.remarks,
      ElementsAre(HasSubstr("column 1 is the time by its name, but '12:34:56.00' is neither a number nor")));
}

TEST(SuggestedMap, TakesStampsWithoutAUnitAndAFinerClockBeforeThem) {
  EXPECT_EQ(
      suggested_for("Stamp,x (mm),F (N)\n2026-01-31 12:00:00.0,0.1,0.2\n2026-01-31 12:00:00.1,0.2,0.3\n"),
      "--map 'time=1,position=2[mm],force=3[N]'");
  EXPECT_EQ(suggested_for("PC Time,Elapsed (s),x (mm),F (N)\n2026-01-31 12:00:00,0.0,0.1,0.2\n"
                          "2026-01-31 12:00:00,0.1,0.2,0.3\n"),
            "--map 'time=2[s],position=3[mm],force=4[N]'");
}

TEST(SuggestedMap, TakesTheUnnamedColumnThatCountsOnForTheTime) {
  const auto last = [](double step) {
    return lines_of(900, [step](int row, const std::string& others) {
      return fmt::format("{}\t{}", others, 17000.0 + step * row);
    });
  };
  EXPECT_EQ(suggested_for(last(0.001)), "--map 'time=3[s],position=1[mm],force=2[N]'");
  EXPECT_EQ(suggested_for(last(2.5)), "--map 'time=3[ms],position=1[mm],force=2[N]'");
  EXPECT_EQ(suggested_for(last(1000)), "--map 'time=3[us],position=1[mm],force=2[N]'");
}

TEST(SuggestedMap, TakesAHeadersWordBeforeAColumnThatCountsOn) {
  const auto of = [](const std::string& header) {
    return suggested_for(header + '\n' + lines_of(900, [](int row, const std::string& others) {
                           return fmt::format("{}\t{}", others, row);
                         }));
  };
  EXPECT_EQ(of("a\tb\tc"), "--map 'time=3[ms],position=1[mm],force=2[N]'");
  EXPECT_EQ(of("Time\tb\tc"), "--map 'time=1[s],position=2[mm],force=3[N]'");
  EXPECT_EQ(of("a\tb [s]\tc"), "--map 'time=2[s],position=1[mm],force=3[N]'");
  EXPECT_EQ(of("a\tb\tc [mm]"), "--map 'position=3[mm]' --rate HZ")
      << "a way; either of two may be the force";
  EXPECT_EQ(of("F\tb\tPosition"), "--map 'time=2[s],position=3[mm],force=1[N]'") << "likewise";
}

TEST(SuggestedMap, TakesNoColumnForTheTimeThatOnlySometimesGrows) {
  const auto with = [](const std::function<double(int)>& third) {
    return suggested_for(lines_of(900, [&](int row, const std::string& others) {
      return fmt::format("{}\t{:.6f}", others, third(row));
    }));
  };
  const std::string by_place = "--map 'time=1[s],position=2[mm],force=3[N]'";
  EXPECT_EQ(with([](int row) { return row < 450 ? 0.01 * row : 9.0 - 0.01 * row; }), by_place)
      << "to and fro";
  EXPECT_EQ(with([](int row) { return std::exp(0.05 * row); }), by_place) << "ever faster";
  EXPECT_EQ(with([](int row) { return 0.01 * std::floor(row / 4.0); }), by_place) << "in stairs";
  const std::string by_time = "--map 'time=3[s],position=1[mm],force=2[N]'";
  EXPECT_EQ(with([](int row) { return 0.01 * row + (row > 400 ? 5.0 : 0.0); }), by_time) << "a gap";
  EXPECT_EQ(with([](int row) { return 0.01 * (row % 300 == 7 ? row - 1 : row); }), by_time) << "a line twice";
}

TEST(SuggestedMap, TakesAClockBeforeACountOfLines) {
  EXPECT_EQ(suggested_for(lines_of(300,
                                   [](int row, const std::string& others) {
                                     return fmt::format("{}\t{:.4f}\t{}", row + 1, 0.0025 * row, others);
                                   })),
            "--map 'time=2[s],position=1[mm],force=3[N]'");
}

TEST(SuggestedMap, FindsTheTimeOfMeasuredDataWithoutAHeader) {
  const std::string punch = "meniscus/9_meniscus_slow_1824.txt";
  KERF_NEEDS_DATA(punch);
  const FileText text(test::measured_file(punch), {.max_bytes = std::size_t{64} << 20U, .sheet = {}});
  EXPECT_EQ(suggest_map(find_layout(text.text(), text.name()), text.text()).in_words(),
            "--map 'time=5[ms],position=1[mm],force=2[N]'");
}

}  // namespace
}  // namespace kerf::bench

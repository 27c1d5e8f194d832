#include "import/text/text_layout.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/text/text_table.h"

namespace kerf::bench {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;

TextLayout layout_of(const std::string& text) { return find_layout(text, "data.txt"); }

TEST(TextLayout, RecognisesTheSeparator) {
  EXPECT_EQ(layout_of("1\t2\t3\n4\t5\t6\n").separator, '\t');
  EXPECT_EQ(layout_of("1,2,3\n4,5,6\n").separator, ',');
  EXPECT_EQ(layout_of("1;2;3\n4;5;6\n").separator, ';');
  EXPECT_EQ(layout_of("1  2 3\n 4 5   6\n").separator, ' ');
  EXPECT_EQ(layout_of("1, 2, 3\n4, 5, 6\n").separator, ',');
  EXPECT_EQ(layout_of("1\t2\t3\t\r\n4\t5\t6\t\r\n").columns.size(), 3U) << "a separator may end the line";
}

TEST(TextLayout, RecognisesADecimalComma) {
  for (const auto* text : {"1,5;2,5\n3,5;4,5\n", "1,5\t2,5\n3,5\t4,5\n", "1,5 2,5\n3,5 4,5\n",
                           "\"1,5\",\"2,5\"\n\"3,5\",\"4,5\"\n"}) {
    EXPECT_EQ(layout_of(text).point, ',') << text;
    EXPECT_EQ(layout_of(text).columns.size(), 2U) << text;
  }
  EXPECT_EQ(layout_of("1.5;2.5\n3.5;4.5\n").point, '.');
}

TEST(TextLayout, FindsPreambleHeaderAndUnits) {
  const TextLayout layout = layout_of(
      "Specimen : Label,\"sample-5\"\r\nSpecimen : Length,\"25.77\",mm\r\n\r\nExtension,Load,Time,Strain "
      "(Ext)\r\n"
      "(mm),(N),(s),(mm/mm)\r\n\"0.0\",\"1.0\",\"0.1\",\"0.0\"\r\n\"0.0\",\"1.0\",\"0.2\",\"0.0\"\r\n");
  EXPECT_EQ(layout.preamble_lines, 5U);
  EXPECT_EQ(layout.header_line, 4U);
  EXPECT_EQ(layout.units_line, 5U);
  ASSERT_EQ(layout.columns.size(), 4U);
  EXPECT_EQ(layout.columns[1].name, "Load");
  EXPECT_EQ(layout.columns[1].unit, "N");
  EXPECT_EQ(layout.columns[3].name, "Strain (Ext)");
}

TEST(TextLayout, TakesUnitsInEitherKindOfBracketsAlsoWithoutAHeader) {
  const TextLayout named = layout_of("t,x,F\n[s],[mm],[N]\n0,1,2\n1,2,3\n");
  EXPECT_EQ(named.header_line, 1U);
  EXPECT_EQ(named.units_line, 2U);
  EXPECT_EQ(named.columns[2].unit, "N");
  const TextLayout nameless = layout_of("(s),(mm)\n0,1,2\n1,2,3\n");
  EXPECT_EQ(nameless.header_line, 0U);
  EXPECT_EQ(nameless.units_line, 1U);
  ASSERT_EQ(nameless.columns.size(), 3U);
  EXPECT_EQ(nameless.columns[1].unit, "mm");
  EXPECT_EQ(nameless.columns[2].unit, "") << "units of fewer columns than there are";
}

TEST(TextLayout, FindsUnitsInTheHeader) {
  const TextLayout layout = layout_of("% comment\n%t_s, Angle [deg], Load (N), count\n0,1,2,3\n1,2,3,4\n");
  EXPECT_EQ(layout.columns[0].name, "t_s");
  EXPECT_EQ(layout.columns[0].unit, "s");
  EXPECT_EQ(layout.columns[1].name, "Angle");
  EXPECT_EQ(layout.columns[1].unit, "deg");
  EXPECT_EQ(layout.columns[2].unit, "N");
  EXPECT_EQ(layout.columns[3].unit, "");
}

TEST(TextLayout, KnowsRawNumbersFromUnits) {
  const TextLayout named = layout_of("t_s,Encoder [counts],Force (raw),Count (left)\n0,1,2,3\n1,2,3,4\n");
  EXPECT_EQ(named.columns[1].name, "Encoder");
  EXPECT_EQ(named.columns[1].unit, "");
  EXPECT_EQ(named.columns[1].unknown_unit, "counts");
  EXPECT_EQ(named.columns[2].unknown_unit, "raw");
  EXPECT_EQ(named.columns[3].unknown_unit, "");
  EXPECT_EQ(named.columns[3].name, "Count (left)");
  const TextLayout below = layout_of("t,x,F\ns,mm,counts\n0,1,2\n1,2,3\n");
  EXPECT_EQ(below.units_line, 2U);
  EXPECT_EQ(below.columns[2].unknown_unit, "counts");
  EXPECT_EQ(layout_of("raw,counts\n0,1\n1,2\n").columns[0].name, "raw") << "names";
}

TEST(TextLayout, TakesNoWordAtTheEndOfANameForAUnit) {
  const TextLayout layout = layout_of("v_in,width (in),flow_h,f_N\n0,1,2,3\n1,2,3,4\n");
  EXPECT_EQ(layout.columns[0].unit, "") << "what goes in, not inches";
  EXPECT_EQ(layout.columns[1].unit, "in");
  EXPECT_EQ(layout.columns[2].unit, "");
  EXPECT_EQ(layout.columns[3].unit, "N");
}

TEST(TextLayout, KeepsWhatTheFileSaysInPlaceOfAKnownUnit) {
  const TextLayout layout =
      layout_of("Time [S],Depth (mNM),Load [dyn],Strain (Ext),M[0]\n0,1,2,3,4\n1,2,3,4,5\n");
  EXPECT_EQ(layout.columns[0].unknown_unit, "S") << "siemens, or seconds in capitals";
  EXPECT_EQ(layout.columns[0].name, "Time");
  EXPECT_EQ(layout.columns[1].unknown_unit, "mNM");
  EXPECT_EQ(layout.columns[2].unknown_unit, "dyn");
  EXPECT_EQ(layout.columns[2].unit, "");
  EXPECT_EQ(layout.columns[3].unknown_unit, "") << "a word";
  EXPECT_EQ(layout.columns[4].unknown_unit, "") << "a number";
  EXPECT_EQ(layout_of("torque_nm\n0\n1\n").columns[0].unknown_unit, "nm") << "N·m, or nanometres";
}

TEST(TextLayout, TakesALineOfUnitsBelowNamesThoughOneIsBlankOrUnknown) {
  const auto units_of = [](const std::string& row) {
    const TextLayout layout = layout_of("Points,Time,Disp,Load\n" + row + "\n1,0.0,0.1,0.2\n2,0.1,0.2,0.3\n");
    EXPECT_EQ(layout.header_line, 1U) << row;
    EXPECT_EQ(layout.units_line, 2U) << row;
    EXPECT_EQ(layout.columns[3].name, "Load") << row;
    return layout.columns;
  };
  EXPECT_EQ(units_of("\" \",\"Sec\",\"mm\",\"N\"")[1].unit, "Sec");
  EXPECT_EQ(units_of(",sec,mm,N")[0].unit, "");
  EXPECT_EQ(units_of("segments,s,mm,N")[0].unknown_unit, "segments");
  EXPECT_EQ(units_of("(1),(s),(mm),(stone)")[3].unknown_unit, "stone");
}

TEST(TextLayout, CallsColumnsWithoutNamesByTheirUnits) {
  const TextLayout layout = layout_of("sec,mm,N\n0.0,0.1,0.2\n0.1,0.2,0.3\n");
  EXPECT_EQ(layout.header_line, 0U);
  EXPECT_EQ(layout.columns[0].name, "sec");
  EXPECT_EQ(layout.columns[2].unit, "N");
  const TextLayout mixed = layout_of("Way,mN,t\n0.0,0.1,0.2\n0.1,0.2,0.3\n");
  EXPECT_EQ(mixed.columns[1].unit, "mN");
  EXPECT_EQ(mixed.columns[0].unit, "");
  EXPECT_EQ(layout_of("N,t,x,F\n1,0.0,0.1,0.2\n").columns[0].unit, "") << "a count, beside a force";
  EXPECT_EQ(layout_of("t,h,F\n0.0,0.1,0.2\n").columns[1].unit, "") << "a height";
}

TEST(TextLayout, FindsUnitsBehindASlashOrInWords) {
  const TextLayout layout = layout_of("Weg in mm;Kraft / mN;Zeit / s;Kraft / Weg\n0;1;2;3\n1;2;3;4\n");
  EXPECT_EQ(layout.columns[0].name, "Weg");
  EXPECT_EQ(layout.columns[0].unit, "mm");
  EXPECT_EQ(layout.columns[1].unit, "mN");
  EXPECT_EQ(layout.columns[2].unit, "s");
  EXPECT_EQ(layout.columns[3].name, "Kraft / Weg");
}

/// "unit" or "?unknown" of one heading.
std::string unit_in(const std::string& heading) {
  const TextLayout layout = layout_of("t;" + heading + "\n0;1\n1;2\n");
  const TextColumn& column = layout.columns.at(1);
  return column.unknown_unit.empty() ? column.unit : "?" + column.unknown_unit;
}

TEST(TextLayout, FindsAUnitThatIsAWordOfTheHeading) {
  for (const auto* heading :
       {"Force mN", "Fz, mN", "Force_mN", "Force: mN", "Force {mN}", "Force <mN>", "Force|mN", "Force=mN",
        "Force-mN", "Force.mN", "Force/mN", "Force mN filtered", "mN Force", "Force_mN_filtered",
        "Force [mN] filtered", "Force (mN, filtered)", "Load (mN) 2", "Probe mN", "Fx mN"}) {
    EXPECT_EQ(unit_in(heading), "mN") << heading;
  }
  EXPECT_EQ(unit_in("Fx N"), "N");
  EXPECT_EQ(unit_in("Fz, N"), "N");
  EXPECT_EQ(unit_in("Position m"), "m");
  EXPECT_EQ(unit_in("Time ms"), "ms");
  EXPECT_EQ(unit_in("time_ms_min"), "ms");
  EXPECT_EQ(unit_in("time min"), "min");
  EXPECT_EQ(unit_in("Angle °"), "°");
  EXPECT_EQ(unit_in("Load kg"), "kg");
  EXPECT_EQ(unit_in("Load mV"), "mV");
  EXPECT_EQ(unit_in("Force V"), "V");
  EXPECT_EQ(unit_in("Torque N-m"), "N m");
  EXPECT_EQ(unit_in("torque_N_m"), "N m");
  EXPECT_EQ(unit_in("Speed mm/s"), "mm/s");
  EXPECT_EQ(unit_in("k_N_per_mm"), "N/mm");
  EXPECT_EQ(unit_in("Extension (mm) from Preload"), "mm");
}

TEST(TextLayout, TakesNoWordForAUnitThatDoesNotFitTheName) {
  for (const auto* heading :
       {"Trial N", "Position x", "Force A", "Force max", "Force min", "Load min", "Position in base",
        "Test s", "Marker m", "Cross bar", "Force in hand", "Stroke rev", "Fx1", "Force 2"}) {
    EXPECT_EQ(unit_in(heading), "") << heading;
  }
}

TEST(TextLayout, DoubtsAUnitWhoseCapitalsOrPairsSayTwoThings) {
  EXPECT_EQ(unit_in("Force MN"), "?MN");
  EXPECT_EQ(unit_in("Time MS"), "?MS");
  EXPECT_EQ(unit_in("speed_mm_s"), "?mm_s") << "not seconds";
  EXPECT_EQ(unit_in("Weg (\u00e6m)"), "?\u00e6m") << "a spoiled µ";
}

TEST(TextLayout, DoubtsAFactorInTheHeading) {
  EXPECT_EQ(unit_in("Force (N) x10"), "?(N) x10");
  EXPECT_EQ(unit_in("Force x10 (N)"), "?x10 (N)");
  EXPECT_EQ(unit_in("Force [N*10]"), "?N*10");
  for (const auto* heading :
       {"Force (x0.1 N)", "Force (N x10)", "Force x10", "Force N x 10", "10*Force (N)", "Force (N) *2",
        "Force (N)/10", "Force (N) 1e-3", "Force x 10^3 [N]", "Force (kN/10)", "Force (N) ×10",
        "Force 10x (N)", "Force 10 mN", "Load cell (50 N)"}) {
    EXPECT_EQ(unit_in(heading).substr(0, 1), "?") << heading;
  }
  EXPECT_EQ(unit_in("Fx10 (N)"), "N") << "a name";
  EXPECT_EQ(unit_in("x2 (mm)"), "mm") << "likewise";
  EXPECT_EQ(unit_in("marker_x10 (mm)"), "mm") << "likewise";
  EXPECT_EQ(unit_in("x10 (mm)"), "mm") << "likewise";
  EXPECT_EQ(unit_in("Force 2 N"), "N") << "of the second sensor";
  EXPECT_EQ(unit_in("Kraft / 10 mN"), "10 mN") << "as DIN 1313 has it";
}

TEST(TextLayout, TakesNoStatisticForAUnit) {
  const TextLayout layout =
      layout_of("pos_mm_min,pos_mm_max,adc_min,time_min,force_mN_\n0,1,2,3,4\n1,2,3,4,5\n");
  EXPECT_EQ(layout.columns[0].unit, "mm");
  EXPECT_EQ(layout.columns[1].unit, "mm");
  EXPECT_EQ(layout.columns[2].unit, "") << "not minutes";
  EXPECT_EQ(layout.columns[3].unit, "min");
  EXPECT_EQ(layout.columns[4].unit, "mN") << "as programs make a name of 'force (mN)'";
}

TEST(TextLayout, ReadsNamesAndUnitsThatCommentsSay) {
  const TextLayout jpk = layout_of(
      "# k: 0.05 N/m\n# columns: vDeflection height time\n# fancyNames: \"V\" \"H\"\n"
      "# units: N m s\n#\n1e-9 2e-6 0.0\n2e-9 3e-6 0.1\n");
  EXPECT_EQ(jpk.header_line, 2U);
  EXPECT_EQ(jpk.units_line, 4U);
  EXPECT_EQ(jpk.columns[1].name, "height");
  EXPECT_EQ(jpk.columns[1].unit, "m");
  const TextLayout gauge = layout_of("MAX = 195.5,3.9\nUNIT = gf,mm\n2ND PEAK = ---,---\n0.0,0.1\n0.1,0.2\n");
  EXPECT_EQ(gauge.header_line, 0U) << "a value of the file is no heading";
  EXPECT_EQ(gauge.units_line, 2U);
  EXPECT_EQ(gauge.columns[0].unit, "gf");
  EXPECT_EQ(gauge.columns[1].unit, "mm");
}

TEST(TextLayout, BeginsBelowTheNamesOfItsColumns) {
  const TextLayout layout = layout_of(
      "Channel\tA\tB\nScale\t1.0\t500.0\nOffset\t0.0\t0.0\n\nTest Data\n\n"
      "Sample\tA\tB\tStim\n0\t0.1\t0.2\t0\n1\t0.2\t0.3\t0\n2\t0.3\t0.4\t0\n"
      "3\t0.4\t0.5\t0\n4\t0.5\t0.6\t0\n");
  EXPECT_EQ(layout.header_line, 7U);
  EXPECT_EQ(layout.preamble_lines, 7U);
  EXPECT_EQ(layout.columns.size(), 4U);
}

TEST(TextLayout, FindsNamesBesideRemarksThatHoldNumbers) {
  for (const auto* before :
       {"# 2024-01-03 run 5\nt [ms],x [mm],f [mN]\n", "# 1,2,3\nt [ms],x [mm],f [mN]\n",
        "t [ms],x [mm],f [mN]\n# 2024-01-03 run 5\n# 3 4 5\n", "1,2,3\nt [ms],x [mm],f [mN]\n",
        "run,5,2024\noperator,7\nt [ms],x [mm],f [mN]\n", "# run 5\n# t [ms],x [mm],f [mN]\n# gain 5, 3\n"}) {
    const TextLayout layout = layout_of(std::string(before) + "0,1,2\n3,4,5\n6,7,8\n");
    EXPECT_EQ(layout.columns.at(2).unit, "mN") << before;
    EXPECT_EQ(layout.columns.at(0).unit, "ms") << before;
  }
  const TextLayout twice = layout_of("t [ms],x [mm]\n0,1\n1,2\nt [ms],x [mm]\n3,4\n4,5\n");
  EXPECT_EQ(twice.header_line, 1U) << "no line of data is taken for a remark";
}

TEST(TextLayout, ReadsATableOfMoreTextsThanNumbersBelowNames) {
  std::string text = "label;phase;who;x (mm);F (N)\n";
  for (int i = 0; i < 9; ++i) text += "cut;go;anna;0," + std::to_string(i) + ";3,5\n";
  const TextLayout layout = layout_of(text);
  EXPECT_EQ(layout.separator, ';');
  EXPECT_EQ(layout.point, ',');
  EXPECT_EQ(layout.columns.at(4).unit, "N");
  EXPECT_EQ(layout.preamble_lines, 1U);
}

TEST(TextLayout, ReadsATableOfWhichAllIsQuoted) {
  for (const auto* text : {"\"t\",\"x\",\"F\",\"label\"\n\"0.00\",\"0.10\",\"0.2\",\"press\"\n",
                           "\"t\";\"x\";\"F\";\"label\"\n\"0.00\";\"0.10\";\"0.2\";\"press; hold\"\n"}) {
    EXPECT_EQ(layout_of(text).columns.size(), 4U) << text;
    EXPECT_EQ(layout_of(text).columns[1].name, "x") << text;
  }
}

TEST(TextLayout, ReadsTwoNumbersBesideADateAndATimeOfDay) {
  const TextLayout layout = layout_of(
      "Date;Time;Pos [mm];Fz "
      "[N]\n02.05.2016;12:11:10,000;0,0000;0,0039\n02.05.2016;12:11:10,010;0,0006;0,0043\n");
  EXPECT_EQ(layout.point, ',');
  EXPECT_EQ(layout.preamble_lines, 1U);
  EXPECT_EQ(layout.columns[3].unit, "N");
}

TEST(TextLayout, ReadsHeadersInOtherEncodings) {
  const std::string units = "\n(s),(mm)\n1,2\n3,4\n";
  EXPECT_EQ(layout_of("\xEF\xBB\xBFtime,\xE4\xBD\x8D\xE7\xA7\xBB" + units).columns[1].name, "位移");
  EXPECT_EQ(layout_of("\xCA\xB1\xBC\xE4,\xCE\xBB\xD2\xC6" + units).columns[1].name, "位移") << "GBK";
  EXPECT_EQ(layout_of("temps,d\xE9placement [\xB5m]\n1,2\n3,4\n").columns[1].name, "déplacement")
      << "Latin-1";
  EXPECT_EQ(layout_of("temps,d\xE9placement [\xB5m]\n1,2\n3,4\n").columns[1].unit, "µm");
  EXPECT_EQ(layout_of("\x8e\x9e\x8a\xd4 (s),\x95\xcf\x88\xca [\x83\xcam]\n1,2\n3,4\n").columns[1].name,
            "変位")
      << "Shift-JIS";
  EXPECT_EQ(layout_of("t,\x89\xd7\x8f\x64 (N)\n1,2\n3,4\n").columns[1].unit, "N");
  EXPECT_EQ(layout_of("t,Force d\x92"
                      "appui (\xb5N)\n1,2\n3,4\n")
                .columns[1]
                .heading,
            "Force d’appui (µN)")
      << "of Windows";
  EXPECT_EQ(layout_of("t,Winkel (\xb0)\n1,2\n3,4\n").columns[1].unit, "°");
  EXPECT_EQ(layout_of("temps,𝜃\n1,2\n3,4\n").columns[1].name, "𝜃") << "UTF-8 of four bytes";
  EXPECT_EQ(layout_of("\xEF\xBB\xBFtime,x\n1,2\n3,4\n").columns[0].name, "time")
      << "the byte order mark is not part of it";
}

TEST(TextLayout, NeedsNoHeader) {
  const TextLayout layout = layout_of("1,2\n3,4\n");
  EXPECT_EQ(layout.header_line, 0U);
  EXPECT_EQ(layout.preamble_lines, 0U);
  EXPECT_EQ(layout.columns[0].name, "");
}

TEST(TextLayout, RefusesWhatIsNoTable) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      (void)layout_of(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(""), "data.txt: the file is empty; expected lines of numbers");
  EXPECT_THAT(refusal("no number\nin here\n"),
              HasSubstr("data.txt: no line of numbers in the first 2 lines"));
  EXPECT_THAT(refusal("{\"t\": 0.0, \"f\": [0, 0, 0.1, 0, 0, 0]}\n"),
              HasSubstr("it is JSON, which is not read"));
  EXPECT_THAT(refusal("[\n{\n\"t\": 0.0,\n\"x\": 0.1\n}\n]\n"), HasSubstr("it is JSON, which is not read"));
  EXPECT_THAT(refusal("[INFO] t=0.0 pos=(0.1, 0, 0) force=(0.2, 0, 0)\n"), HasSubstr("a log of NAME=VALUE"));
  EXPECT_THAT(refusal(std::string("\x7f"
                                  "ELF\0\0\0",
                                  7)),
              HasSubstr("a binary file"));
}

TEST(SplitLine, TakesOffBlanksAndQuotes) {
  EXPECT_THAT(split_line(R"( a , "b,c" ,,d)", ','), ElementsAre("a", "b,c", "", "d"));
  EXPECT_THAT(split_line("  a \t b  ", ' '), ElementsAre("a", "b"));
  EXPECT_THAT(split_line("a\t\tb", '\t'), ElementsAre("a", "", "b"));
}

TEST(TextTable, HasLongNumbersThemselvesUnlessTheyAreCountedFromTheFirst) {
  const std::string text = "raw,t\n2000000010,1700000000.123456789\n2000000030,1700000000.123556789\n";
  TextLayout layout = find_layout(text, "raw.csv");
  constexpr std::array<std::size_t, 2> both{0, 1};
  std::atomic<std::size_t> done{0};
  EXPECT_THAT(parse_table(text, layout, both, done).columns[0], ElementsAre(2000000010.0, 2000000030.0));
  count_from_first(layout, 1, text);
  const TextTable table = parse_table(text, layout, both, done);
  EXPECT_THAT(table.columns[0], ElementsAre(2000000010.0, 2000000030.0));
  EXPECT_THAT(table.columns[1], ElementsAre(DoubleNear(0.123456789, 1e-15), DoubleNear(0.123556789, 1e-15)));
}

}  // namespace
}  // namespace kerf::bench

#include "import/text/text_layout.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

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

TEST(TextLayout, TakesNoWordAtTheEndOfANameForAUnit) {
  const TextLayout layout = layout_of("v_in,width (in),flow_h,f_N\n0,1,2,3\n1,2,3,4\n");
  EXPECT_EQ(layout.columns[0].unit, "") << "what goes in, not inches";
  EXPECT_EQ(layout.columns[1].unit, "in");
  EXPECT_EQ(layout.columns[2].unit, "");
  EXPECT_EQ(layout.columns[3].unit, "N");
}

TEST(TextLayout, ReadsHeadersInOtherEncodings) {
  const std::string units = "\n(s),(mm)\n1,2\n3,4\n";
  EXPECT_EQ(layout_of("\xEF\xBB\xBFtime,\xE4\xBD\x8D\xE7\xA7\xBB" + units).columns[1].name, "位移");
  EXPECT_EQ(layout_of("\xCA\xB1\xBC\xE4,\xCE\xBB\xD2\xC6" + units).columns[1].name, "位移") << "GBK";
  EXPECT_EQ(layout_of("temps,d\xE9placement [\xB5m]\n1,2\n3,4\n").columns[1].name, "déplacement")
      << "Latin-1";
  EXPECT_EQ(layout_of("temps,d\xE9placement [\xB5m]\n1,2\n3,4\n").columns[1].unit, "µm");
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

}  // namespace
}  // namespace kerf::bench

#include "import/text/thousands.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/import.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

/// What an import of columns t [ms], x [um], F [mN] says of them.
std::string refusal_of(const std::string& lines, const std::string& header = "t;x;F") {
  const test::TemporaryFolder folder;
  test::write_text(folder / "t.csv", header + "\n" + lines);
  try {
    (void)import_text(folder / "t.csv", {.map = parse_map("time=1[ms],position=2[um],force=3[mN]")});
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "imported";
}

TEST(Thousands, OfWholeNumbersAreNoFractions) {
  EXPECT_THAT(refusal_of("380;865;346\n390;909;364\n400;955;382\n410;1.002;401\n420;1.049;420\n"),
              HasSubstr("t.csv:5: column 2 holds '1.002' among whole numbers below 1000"));
  EXPECT_THAT(refusal_of("380\t865\t346\n390\t909\t364\n400\t955\t382\n410\t1,002\t401\n420\t1,049\t420\n",
                         "t\tx\tF"),
              HasSubstr("t.csv:5: column 2 holds '1,002' among whole numbers below 1000"));
}

TEST(Thousands, AreNotTakenForThreeDecimals) {
  EXPECT_EQ(refusal_of("0;0.123;1\n1;0.456;2\n2;1.002;3\n3;2;4\n4;3.125;5\n"), "imported")
      << "a zero before the sign";
  EXPECT_EQ(refusal_of("0;1.123;1\n1;1.456;2\n2;2.002;3\n3;2.250;4\n4;3.125;5\n"), "imported")
      << "all have the sign";
  EXPECT_EQ(refusal_of("0;1;1\n1;1.125;2\n2;2;3\n3;2.875;4\n4;3;5\n"), "imported") << "steps of eighths";
  EXPECT_EQ(refusal_of("0;999;1\n1;999.125;2\n2;999.5;3\n3;1000;4\n4;1000.875;5\n"), "imported");
}

TEST(Thousands, InAColumnThatIsNotMappedDoNotMatter) {
  EXPECT_EQ(refusal_of("0;10;1;955\n1;20;2;1.002\n2;30;3;1.049\n", "t;x;F;n"), "imported");
}

TEST(Import, NamesTheCellThatIsNoNumberInEveryLine) {
  EXPECT_THAT(
      refusal_of("12:00:00;1;2\n12:00:01;2;3\n"),
      HasSubstr("t.csv:2: column 1, mapped to time, holds '12:00:00', and no line has a number in every "
                "mapped column; expected numbers with the decimal sign '.': times of day are not read"));
  EXPECT_THAT(refusal_of("0;press;2\n1;press;3\n"),
              HasSubstr("t.csv:2: column 2, mapped to position, holds 'press'"));
}

}  // namespace
}  // namespace kerf::bench

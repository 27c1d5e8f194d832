#include "units/units.h"

#include <numbers>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

TEST(Units, ConvertWhatLabsWriteToSi) {
  EXPECT_EQ(parse_unit("ms"), (Unit{1e-3, "s"}));
  EXPECT_EQ(parse_unit("ns"), (Unit{1e-9, "s"}));
  EXPECT_EQ(parse_unit("um"), (Unit{1e-6, "m"}));
  EXPECT_EQ(parse_unit("deg"), (Unit{degree, "rad"}));
  EXPECT_EQ(parse_unit("mN"), (Unit{1e-3, "N"}));
  EXPECT_EQ(parse_unit("1"), (Unit{1.0, "1"}));
}

TEST(Units, GramForceIsAGramUnderStandardGravity) {
  EXPECT_DOUBLE_EQ(parse_unit("gf").factor, 9.80665e-3);
  EXPECT_DOUBLE_EQ(parse_unit("kgf").factor, 9.80665);
}

// NIST Special Publication 811, appendix B.8.
TEST(Units, OfInchesAndPoundsAreThoseOfNist) {
  EXPECT_DOUBLE_EQ(parse_unit("lbf").factor, 4.4482216152605);
  EXPECT_NEAR(parse_unit("ozf").factor, 2.780139e-1, 1e-7);
  EXPECT_NEAR(parse_unit("psi").factor, 6.894757e3, 1e-3);
  EXPECT_EQ(parse_unit("in").factor, 0.0254);
  EXPECT_DOUBLE_EQ(parse_unit("ft").factor, 0.3048);
  EXPECT_NEAR(parse_unit("lbf*in").factor, 1.129848e-1, 1e-7);
  EXPECT_EQ(parse_unit("lbf*in").si, "N·m");
  EXPECT_NEAR(parse_unit("rpm").factor, 1.047198e-1, 1e-7);
  EXPECT_EQ(parse_unit("rpm").si, "rad/s");
  EXPECT_DOUBLE_EQ(parse_unit("rev/min").factor, parse_unit("rpm").factor);
  EXPECT_EQ(parse_unit("h").factor, 3600.0);
  EXPECT_EQ(parse_unit("degC").si, "°C");
}

TEST(Units, TakeAFactorForRawCounts) {
  const Unit unit = parse_unit("0.0439453125 deg");
  EXPECT_DOUBLE_EQ(unit.factor, 0.0439453125 * degree);
  EXPECT_EQ(unit.si, "rad");
  EXPECT_DOUBLE_EQ(parse_unit("3.9811e-5 N·m").factor, 3.9811e-5);
  EXPECT_DOUBLE_EQ(parse_unit("-2 mm").factor, -2e-3);
  EXPECT_EQ(parse_unit("mNm"), (Unit{1e-3, "N·m"}));
  EXPECT_EQ(parse_unit("4"), (Unit{4.0, "1"}));
}

TEST(Units, MultiplyAndDivide) {
  EXPECT_EQ(parse_unit("N·s/mm"), (Unit{1e3, "N·s/m"}));
  EXPECT_EQ(parse_unit("mN·s/mm³"), (Unit{1e6, "N·s/m³"}));
  EXPECT_EQ(parse_unit("kJ/m^2"), (Unit{1e3, "J/m²"}));
  EXPECT_EQ(parse_unit("N*s/m"), (Unit{1.0, "N·s/m"}));
  EXPECT_EQ(parse_unit("N / deg"), (Unit{1.0 / degree, "N/rad"}));
  EXPECT_EQ(parse_unit("1/mm"), (Unit{1.0 / 1e-3, "1/m"}));
  EXPECT_EQ(parse_unit("2 /s"), (Unit{2.0, "1/s"}));
}

TEST(Units, OfSeveralFactorsAreDividedAndRaisedByEach) {
  EXPECT_EQ(parse_unit("m/rpm").si, "m·s/rad");
  EXPECT_EQ(parse_unit("Nm/rpm").si, "N·m·s/rad");
  EXPECT_EQ(parse_unit("rpm²").si, "rad²/s²");
  EXPECT_EQ(parse_unit("J/Nm²").si, "J/N²·m²");
  EXPECT_EQ(parse_unit("1/rpm").si, "s/rad");
}

TEST(Units, OfCountsAreWhatOneOfThemIs) {
  // ATI's Net F/T writes 1,000,000 counts per N and 1,000,000 per N-m, or per lbf and lbf-in.
  EXPECT_EQ(parse_unit("counts/1000000 N"), parse_unit("1e-6 N"));
  EXPECT_EQ(parse_unit("counts/1e6 N·m").si, "N·m");
  EXPECT_DOUBLE_EQ(parse_unit("counts/4000 lbf").factor, parse_unit("lbf").factor / 4000.0);
  for (const auto* bad : {"counts/", "counts/N", "counts/1000", "counts/0 N"})
    EXPECT_THROW((void)parse_unit(bad), std::invalid_argument) << bad;
}

TEST(Units, AreReadAsInstrumentsSpellThem) {
  for (const auto* second : {"sec", "Sec", "SECS", "Seconds", "second"})
    EXPECT_EQ(parse_unit(second), parse_unit("s"));
  EXPECT_EQ(parse_unit("mins"), parse_unit("min"));
  EXPECT_EQ(parse_unit("inches"), parse_unit("in"));
  EXPECT_EQ(parse_unit("Millimeters"), parse_unit("mm"));
  EXPECT_EQ(parse_unit("Newtons"), parse_unit("N"));
  EXPECT_EQ(parse_unit("KN"), parse_unit("kN"));
  EXPECT_EQ(parse_unit("lbs"), parse_unit("lb"));
  EXPECT_EQ(parse_unit("grams"), parse_unit("g"));
  EXPECT_EQ(parse_unit("N/inch"), parse_unit("N/in"));
  for (const auto* ambiguous : {"MN", "S", "MS", "NM"})
    EXPECT_THROW((void)parse_unit(ambiguous), std::invalid_argument) << ambiguous;
}

TEST(Units, OfSmallForcesHaveEitherMu) {
  EXPECT_EQ(parse_unit("\u00b5N"), parse_unit("1e-6 N"));
  EXPECT_EQ(parse_unit("\u03bcN"), parse_unit("\u00b5N"));
  EXPECT_EQ(parse_unit("\u03bcm"), parse_unit("um"));
  EXPECT_EQ(parse_unit("uN"), parse_unit("\u00b5N"));
  EXPECT_DOUBLE_EQ(parse_unit("nN").factor, 1e-9);
  EXPECT_DOUBLE_EQ(parse_unit("pN").factor, 1e-12);
  EXPECT_DOUBLE_EQ(parse_unit("cN").factor, 1e-2);
  EXPECT_DOUBLE_EQ(parse_unit("daN").factor, 10.0);
  EXPECT_EQ(parse_unit("nm").si, "m") << "not N·m";
}

TEST(Units, OfPoundsAreMassesUnlessTheySayForce) {
  EXPECT_EQ(parse_unit("lb").si, "kg");
  EXPECT_DOUBLE_EQ(parse_unit("lb").factor * 9.80665, parse_unit("lbf").factor);
}

TEST(Units, AreFoundWithoutTheFactorBeforeThem) {
  EXPECT_EQ(without_factor("-1 N"), "N");
  EXPECT_EQ(without_factor("counts/1000 N"), "N");
  EXPECT_EQ(without_factor("mm"), "mm");
}

TEST(Units, RefuseWhatTheyDoNotKnowAndSayWhatTheyDo) {
  const auto message = [](const char* text) -> std::string {
    try {
      (void)parse_unit(text);
      return "accepted";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  EXPECT_THAT(message("furlong"), testing::AllOf(testing::HasSubstr("'furlong'"), testing::HasSubstr("mm")));
  EXPECT_EQ(message("? N"), "write for ? in '? N' how many N one of the file's units is, as in 0.001 N");
  EXPECT_THAT(message("N/"), testing::HasSubstr("operator"));
  EXPECT_THAT(message(""), testing::HasSubstr("empty"));
  EXPECT_THAT(message("nan mm"), testing::HasSubstr("finite"));
  EXPECT_THAT(message("0 mm"), testing::HasSubstr("zero"));
  EXPECT_THAT(message("1e308/mm"), testing::HasSubstr("finite"));
  EXPECT_THAT(message("1e-320/kPa³"), testing::HasSubstr("zero"));
}

TEST(Units, OfWorkAreOfAnEnergyWhereTheForceAndTheWayMakeOne) {
  EXPECT_EQ(work_unit("N", "m"), "J");
  EXPECT_EQ(work_unit("N·m", "rad"), "J");
  EXPECT_EQ(work_unit("N", "rad"), "N·rad") << "a force over an angle, whose lever nobody told";
}

}  // namespace
}  // namespace kerf::bench

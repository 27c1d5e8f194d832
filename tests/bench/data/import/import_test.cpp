#include "import/import.h"

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::DoubleEq;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Imported imported(const std::string& text, ImportOptions options = {},
                  const std::string& map = "time=1[s],position=2[mm],force=3[mN]") {
  const test::TemporaryFolder folder;
  test::write_text(folder / "data.txt", text);
  options.map = parse_map(map);
  return import_text(folder / "data.txt", options);
}

std::string table(int rows, const auto& line) {
  std::string text;
  for (int i = 0; i < rows; ++i) text += line(i) + "\n";
  return text;
}

TEST(Import, GoesToSiAndCountsTimeFromZero) {
  const auto recording = imported("5.0,1,100\n5.5,2,-200\n6.0,4,50\n").recording;
  EXPECT_THAT(recording.time, ElementsAre(0.0, 0.5, 1.0));
  EXPECT_THAT(recording.position, ElementsAre(DoubleEq(1e-3), DoubleEq(2e-3), DoubleEq(4e-3)));
  EXPECT_THAT(recording.force_measured, ElementsAre(DoubleEq(0.1), DoubleEq(-0.2), DoubleEq(0.05)));
  EXPECT_EQ(recording.axes[0].position_unit, "m");
  EXPECT_THAT(recording.tick, ElementsAre(0U, 1U, 2U));
}

TEST(Import, DerivesTheVelocityAndSaysSo) {
  const auto text = table(200, [](int i) {
    const double t = 1e-3 * i;
    return std::to_string(t) + "," + std::to_string(1000.0 * t * t) + ",0";
  });
  const auto recording = imported(text).recording;
  EXPECT_NEAR(recording.velocity[100], 0.2, 1e-6);
  EXPECT_THAT(recording.header.velocity_derived, HasSubstr("zero phase"));
  const auto given =
      imported("0,1,0\n1,2,0\n2,3,0\n", {}, "time=1[s],position=2[mm],velocity=2[mm*1/s]").recording;
  EXPECT_THAT(given.velocity, ElementsAre(DoubleEq(1e-3), DoubleEq(2e-3), DoubleEq(3e-3)));
  EXPECT_EQ(given.header.velocity_derived, "");
}

TEST(Import, RefusesAFileThatBecomesShorterMeanwhile) {
  const test::TemporaryFolder folder;
  const auto file = folder / "data.txt";
  test::write_text(file, table(200'000, [](int i) { return std::to_string(i) + ",1,2"; }));
  ImportOptions options;
  options.map = parse_map("time=1[s],position=2[mm],force=3[mN]");
  options.progress = [&](const std::string& label, std::size_t total, const CountedWork& work) {
    std::filesystem::resize_file(file, 1'000'000);
    show_no_progress(label, total, work);
  };
  try {
    (void)import_text(file, options);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refused) {
    EXPECT_THAT(refused.what(), HasSubstr("data.txt: it became shorter while it was read"));
  }
}

TEST(Import, ReportsLinesThatAreNotDataByTheirNumbers) {
  const Imported result = imported("t,x,f\n0,1,2\n# pause\n1,1,2\n\n2,1\n3,1,2\n}");
  EXPECT_EQ(result.recording.rows(), 3U);
  EXPECT_THAT(result.bad_lines, ElementsAre(3U, 6U, 8U));
  EXPECT_THAT(result.warnings, testing::Contains(HasSubstr("3 lines are not data: 3, 6, 8")));
  EXPECT_THROW((void)imported("0,1,2\nx\n1,1,2\n", {.strict = true}), std::invalid_argument);
}

TEST(Import, RefusesNumbersInGroupsWhoseLargestWouldBeLost) {
  const auto grouped = [](const std::string& field, const std::string& rest) {
    return "0;1;1\n1;2;2\n2;" + field + ";3\n3;" + rest + ";3\n";
  };
  for (const auto* field : {"1,000.5", "-12,345,678", "1'000.5", "1,234"}) {
    EXPECT_THAT([&] { (void)imported(grouped(field, "999.5")); },
                testing::ThrowsMessage<std::invalid_argument>(
                    HasSubstr("data.txt:3: column 2 holds '" + std::string(field) + "', a number in groups")))
        << field;
  }
  for (const auto* field : {"1,00.5", "12:30", "x", "1,,000", "1234,5x", "2026.01.31", ""})
    EXPECT_EQ(imported(grouped(field, "999.5")).bad_lines.size(), 1U) << field;
}

TEST(Import, LeavesOutALineThatLacksAValueBesideOneOfThreeDecimals) {
  EXPECT_THAT(imported("0.001,1,1\n0.002,2,2\n0.003,,3\n0.004,2,3\n").bad_lines, ElementsAre(3U));
  EXPECT_THAT(imported("0,001;1;1\n0,002;2;2\n0,003;--;3\n0,004;2;3\n").bad_lines, ElementsAre(3U));
  EXPECT_THAT(imported("0.001,1,1\n0.002,2,2\n0.003,2,3\n0.004,1").bad_lines, ElementsAre(4U)) << "cut short";
}

TEST(Import, TakesColumnsOfOneNameByTheirNumbers) {
  const std::string text = "M[1],M[2],M[3],ratio [1]\n0,1,2,0.5\n1,2,3,0.5\n2,3,4,0.5\n";
  const Imported result = imported(text, {}, "time=M[1][s],position=M[2][mm],force=M[3][N],ratio=ratio");
  EXPECT_THAT(result.recording.time, ElementsAre(0.0, 1.0, 2.0));
  EXPECT_THAT(result.recording.force_measured, ElementsAre(2.0, 3.0, 4.0));
  EXPECT_EQ(result.recording.channels.at(0).unit, "1") << "a column of its own name, in units of 1";
  EXPECT_THAT([&] { (void)imported(text, {}, "time=M[1],position=M[2][mm]"); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("give one in brackets: time=M[1][s]")));
}

TEST(Import, TakesFahrenheitInCelsius) {
  const Imported result =
      imported("0,1,32\n1,1,212\n", {}, "time=1[s],position=2[mm],heat=3[degF],step=3[degF/s]");
  EXPECT_NEAR(result.recording.channels[0].values[0], 0.0, 1e-13);
  EXPECT_NEAR(result.recording.channels[0].values[1], 100.0, 1e-13);
  EXPECT_EQ(result.recording.channels[0].unit, "°C");
  EXPECT_NEAR(result.recording.channels[1].values[0], 32.0 / 1.8, 1e-13) << "a difference";
}

TEST(Import, TakesNoNumberThatGoesOnAsAWord) {
  const Imported result = imported("0 1 2\n1 2x 3\n2 3 4\n");
  EXPECT_THAT(result.recording.time, ElementsAre(0.0, 2.0));
  EXPECT_THAT(result.bad_lines, ElementsAre(2U));
}

TEST(Import, IgnoresWhatStandsInColumnsThatAreNotMapped) {
  const Imported result = imported("0\t1\t2\t\\\n1\t1\t2\t\n2\t1\t2\tx\t9\n3\t1\t2\n");
  EXPECT_EQ(result.recording.rows(), 4U);
  EXPECT_TRUE(result.bad_lines.empty());
  const Imported between =
      imported("0,ham,1,2\n1,\"egg, spam\",3,4\n", {}, "time=1[s],position=3[mm],force=4[N]");
  EXPECT_TRUE(between.bad_lines.empty());
  EXPECT_THAT(between.recording.force_measured, ElementsAre(2.0, 4.0));
}

TEST(Import, ReadsAColumnAsOftenAsItIsMapped) {
  const auto recording =
      imported("0,1,2\n1,2,3\n", {}, "time=1[s],position=2[mm],raw=2[1],force=3[N]").recording;
  EXPECT_THAT(recording.position, ElementsAre(DoubleEq(1e-3), DoubleEq(2e-3)));
  EXPECT_THAT(recording.channels.at(0).values, ElementsAre(1.0, 2.0));
}

TEST(Import, LeavesOutAndReportsTimesThatRepeatOrGoBack) {
  const Imported result = imported("0,1,2\n1,2,2\n1,3,2\n0.5,4,2\nnan,4,2\n2,5,2\n");
  EXPECT_THAT(result.recording.time, ElementsAre(0.0, 1.0, 2.0));
  EXPECT_THAT(result.recording.position, ElementsAre(DoubleEq(1e-3), DoubleEq(2e-3), DoubleEq(5e-3)));
  EXPECT_THAT(result.misplaced_lines, ElementsAre(3U, 4U, 5U));
  EXPECT_THAT(
      result.warnings,
      testing::Contains("3 lines are left out, whose time repeats, goes back or is not finite: 3, 4, 5"));
  ASSERT_EQ(result.recording.events.size(), 1U);
  EXPECT_EQ(result.recording.events[0].kind, "misplaced_lines");
  EXPECT_THROW((void)imported("0,1,2\n0,1,2\n", {.strict = true}), std::invalid_argument);
}

TEST(Import, LosesOneRowToAStampThatLeapsAhead) {
  const auto text = table(40, [](int i) { return std::to_string(i == 20 ? 99999 : i) + ",1,2"; });
  const Imported result = imported(text);
  EXPECT_EQ(result.recording.rows(), 39U);
  EXPECT_THAT(result.misplaced_lines, ElementsAre(21U));
}

TEST(Import, DoubtsAClockThatMakesItLeaveOutMuchOfTheFile) {
  const auto text = table(40, [](int i) { return std::to_string(i / 2) + ",1,2"; });
  const Imported result = imported(text);
  EXPECT_THAT(result.recording.time, testing::SizeIs(20));
  EXPECT_THAT(result.warnings, testing::Contains(HasSubstr("map no time and give --rate HZ")));
}

TEST(Import, TakesOneStretchOfAClockThatStartsAnew) {  // finding L8
  const std::string text =
      table(60, [](int i) { return std::to_string(0.01 * (i % 20)) + "," + std::to_string(i) + ",0"; });
  EXPECT_THAT([&] { (void)imported(text); },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::AllOf(HasSubstr("data.txt:21: the clock starts anew here, and at 2 places in all"),
                                 HasSubstr("--stretch 1 to 3"))));
  ImportOptions options{.map = {}};
  options.stretch = 2;
  const Imported second = imported(text, options);
  ASSERT_EQ(second.recording.rows(), 20U);
  EXPECT_THAT(second.recording.position[0], DoubleEq(20e-3));
  EXPECT_EQ(second.recording.time[0], 0.0);
  EXPECT_THAT(second.warnings, testing::IsEmpty());
  EXPECT_THAT(second.recording.header.history, HasSubstr("20 rows of data.txt, stretch 2"));
  options.stretch = 4;
  EXPECT_THAT(
      [&] { (void)imported(text, options); },
      testing::ThrowsMessage<std::invalid_argument>(HasSubstr("--stretch 4: its clock starts 3 times")));
  options.stretch = 1;
  EXPECT_EQ(imported("0,1,0\n1,2,0\n2,3,0\n", options).recording.rows(), 3U);
}

TEST(Import, NamesTheLinesOfTheStretchThatItTakes) {
  std::string text = table(40, [](int i) { return std::to_string(0.01 * (i % 20)) + ",1,0"; });
  text.insert(text.size(), "0.18,1,0\nslipped\n0.2,2,0\n");
  ImportOptions options{.map = {}};
  options.stretch = 2;
  const Imported second = imported(text, options);
  EXPECT_THAT(second.misplaced_lines, ElementsAre(41U)) << "a stamp that goes back by one";
  EXPECT_THAT(second.bad_lines, ElementsAre(42U));
}

TEST(Import, TakesASingleRow) {
  const auto recording = imported("0,1,2\n").recording;
  EXPECT_THAT(recording.velocity, ElementsAre(0.0));
}

TEST(Import, NeedsATimeThatIsFinite) {
  EXPECT_THROW((void)imported("nan,1,2\nnan,1,2\n"), std::invalid_argument);
}

TEST(Import, DoesNotCountATimeThatIsMapped) {
  EXPECT_THROW((void)imported("0,1,2\n1,1,2\n", {.rate_hz = 10.0}), std::invalid_argument);
}

TEST(Import, KeepsNaN) {
  EXPECT_TRUE(std::isnan(imported("0,1,nan\n1,1,2\n2,1,3\n").recording.force_measured[0]));
}

TEST(Import, MarksGapsByAJumpOfTheTick) {
  const Imported result = imported("0,1,2\n1,1,2\n2,1,2\n7,1,2\n8,1,2\n");
  EXPECT_THAT(result.recording.tick, ElementsAre(0U, 1U, 2U, 7U, 8U));
  EXPECT_THAT(result.warnings,
              testing::Contains(HasSubstr("1 gaps of more than 2.5 periods, the longest 5 s")));
}

TEST(Import, CountsTimeByARateWhereThereIsNone) {
  const auto recording =
      imported("1 2\n2 3\n3 4\n", {.rate_hz = 10.0}, "position=1[mm],force=2[N]").recording;
  EXPECT_THAT(recording.time, ElementsAre(0.0, DoubleEq(0.1), DoubleEq(0.2)));
  EXPECT_THROW((void)imported("1 2\n2 3\n", {}, "position=1[mm],force=2[N]"), std::invalid_argument);
}

TEST(Import, CountsEpochsExactlyAndKnowsWhenTheyBegan) {
  const auto begins = [](const std::string& first, const std::string& second, const std::string& unit) {
    return imported(first + ",1,2\n" + second + ",2,3\n", {},
                    "time=1[" + unit + "],position=2[mm],force=3[N]");
  };
  const Imported ns = begins("1700000000123456789", "1700000000124456792", "ns");
  EXPECT_EQ(ns.recording.header.start_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(ns.recording.header.start_clock, "UTC");
  EXPECT_DOUBLE_EQ(ns.recording.time[1], 0.001000003);
  EXPECT_EQ(begins("1700000000123456", "1700000000124459", "us").recording.header.start_ns,
            1'700'000'000'123'456'000);
  EXPECT_EQ(begins("1700000000123", "1700000000126", "ms").recording.header.start_ns,
            1'700'000'000'123'000'000);
  const Imported s = begins("1700000000.123456789", "1700000000.124456792", "s");
  EXPECT_EQ(s.recording.header.start_ns, 1'700'000'000'123'456'789);
  EXPECT_NEAR(s.recording.time[1], 0.001000003, 1e-12);
  EXPECT_THAT(ns.warnings, Not(Contains(HasSubstr("no moment"))));
}

TEST(Import, SaysOfLongTimesThatAreNoEpochThatTheirBeginIsNotKnown) {
  for (const auto* unit : {"s", "ms", "us"}) {
    const Imported long_ns = imported("1700000000123456789,1,2\n1700000000124456792,2,3\n", {},
                                      std::string("time=1[") + unit + "],position=2[mm],force=3[N]");
    EXPECT_FALSE(long_ns.recording.header.start_ns) << unit;
    EXPECT_THAT(long_ns.warnings, Contains(HasSubstr("no moment of 2000 to 2050"))) << unit;
  }
  const Imported of_1904 = imported("3786912000.000,1,2\n3786912000.002,2,3\n");
  EXPECT_FALSE(of_1904.recording.header.start_ns);
  EXPECT_NEAR(of_1904.recording.time[1], 0.002, 1e-12);
  EXPECT_THAT(of_1904.warnings, Contains(HasSubstr("no moment of 2000 to 2050")));
}

TEST(Import, KeepsLongNumbersOfOtherChannelsAsTheyAre) {
  const Imported long_way = imported("0,1000000000,2\n1,1000000001.5,-3\n2,1.0000000025e9,1\n");
  EXPECT_THAT(long_way.recording.position,
              ElementsAre(DoubleEq(1e6), DoubleEq(1000000.0015), DoubleEq(1000000.0025)));
}

TEST(Import, RefusesARateWithoutEnd) {
  EXPECT_THAT([] { (void)imported("1,2\n2,3\n", {.rate_hz = INFINITY}, "position=1[mm],force=2[N]"); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("--rate is infinite; expected")));
}

TEST(Import, ResamplesALineExactlyAndLeavesGapsOpen) {
  const auto text = table(400, [](int i) {
    const double t = 3e-3 * i + (i >= 200 ? 1.0 : 0.0) + 4e-4 * ((i * 7) % 3);
    return std::to_string(t) + "," + std::to_string(10.0 * t) + ",1";
  });
  const auto recording = imported(text, {.resample_hz = 1000.0}).recording;
  bool jumped = false;
  for (std::size_t i = 1; i < recording.rows(); ++i) {
    const double t = recording.time[i];
    ASSERT_EQ(t, static_cast<double>(recording.tick[i]) / 1000.0);
    ASSERT_NEAR(recording.position[i], 10e-3 * t, 1e-8);
    ASSERT_FALSE(t > 0.6 && t < 1.6) << "a row in the gap";
    jumped = jumped || recording.tick[i] - recording.tick[i - 1] > 900;
  }
  EXPECT_TRUE(jumped);
  EXPECT_EQ(recording.flags[5], schema::flag_resampled);
}

TEST(Import, ResamplingDownDoesNotAlias) {
  // 40 Hz would fold to 10 Hz at a rate of 50 Hz; the filter before it takes it out.
  const auto text = table(2000, [](int i) {
    const double t = 1e-3 * i;
    return std::to_string(t) + "," + std::to_string(std::sin(2.0 * std::numbers::pi * 40.0 * t)) + ",1";
  });
  const auto recording = imported(text, {.resample_hz = 50.0}).recording;
  for (std::size_t i = 20; i + 20 < recording.rows(); ++i) ASSERT_NEAR(recording.position[i], 0.0, 0.07e-3);
}

TEST(Import, RefusesToResampleOverNaN) {
  EXPECT_THROW((void)imported("0,1,nan\n1,1,2\n2,1,2\n3,1,2\n", {.resample_hz = 2.0}), std::invalid_argument);
}

TEST(Import, RefusesToResampleToMoreThanMemoryHolds) {
  EXPECT_THROW((void)imported("0,1,2\n1,1,2\n2,1,2\n", {.resample_hz = 1e13}), std::invalid_argument);
}

TEST(Import, DoubtsARateThatNoLabHas) {
  EXPECT_THAT(imported("0,1,2\n100,1,2\n200,1,2\n").warnings,
              testing::Contains(HasSubstr("is the unit of time right?")));
}

}  // namespace
}  // namespace kerf::bench

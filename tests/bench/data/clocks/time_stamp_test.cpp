#include "clocks/time_stamp.h"

#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "import/import.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TimeStamp stamp_of(std::string_view text) {
  TimeStamp stamp;
  EXPECT_TRUE(is_time_stamp(text, stamp)) << text;
  return stamp;
}

TEST(TimeStamp, IsNanosecondsSinceTheEpoch) {  // numbers of GNU date, `date -u -d TEXT +%s%N`
  EXPECT_EQ(stamp_of("2026-01-31T12:00:00.123456789Z").ns, 1769860800123456789);
  EXPECT_EQ(stamp_of("2026-01-31 12:00:00,5+02:00").ns, 1769853600500000000);
  EXPECT_EQ(stamp_of("2026-01-31T12:00:00-0930").ns, 1769895000000000000);
  EXPECT_EQ(stamp_of("2026-01-31T12:00:00+02").ns, 1769853600000000000);
  EXPECT_EQ(stamp_of("2024-02-29T23:59:59.1234567000Z").ns, 1709251199123456700);
  EXPECT_EQ(stamp_of("1969-12-31T23:59:59.999999999Z").ns, -1);
  EXPECT_EQ(stamp_of("31.01.2026 12:00:00,5+02:00").ns, 1769853600500000000);
  EXPECT_TRUE(stamp_of("2026-01-31T12:00:00Z").has_zone);
  EXPECT_FALSE(stamp_of("2026-01-31T12:00:00").has_zone);
}

TEST(TimeStamp, IsNothingElse) {
  for (const auto* text : {"",
                           "2026-01-31",
                           "12:00:00",
                           "2026-02-29T12:00:00Z",
                           "2026-13-01T00:00:00",
                           "2026-01-31T24:00:00",
                           "2016-12-31T23:59:60Z",
                           "2026-01-31T12:00",
                           "2026-01-31T12:00:00.",
                           "2026-01-31T12:00:00.1234567891",
                           "2026-01-31T12:00:00+2",
                           "2026-01-31T12:00:00+0275",
                           "2026-01-31T12:00:00+02:",
                           "2026-01-31T12:00:00 Z",
                           "31.01.26 12:00:00",
                           "01/31/2026 12:00:00",
                           "30.02.2026 12:00:00",
                           "31-01-2026 12:00:00",
                           "1949-12-31T12:00:00",
                           "2150-01-01T00:00:00",
                           "2026-01-31T12:00:00Zx",
                           "1.5"}) {
    TimeStamp stamp;
    EXPECT_FALSE(is_time_stamp(text, stamp)) << text;
  }
}

TEST(TimeStamp, IsWrittenAsItIsRead) {
  for (const auto* text : {"2026-01-31T12:00:00.123456789Z", "1969-12-31T23:59:59.5", "2026-01-31T12:00:00Z"})
    EXPECT_EQ(time_stamp_text(stamp_of(text)), text);
}

Imported of_text(const std::string& text, ImportOptions options = {},
                 const std::string& map = "time=1,position=2[mm],force=3[N]") {
  const test::TemporaryFolder folder;
  test::write_text(folder / "data.csv", text);
  options.map = parse_map(map);
  return import_text(folder / "data.csv", options);
}

TEST(Stamps, BecomeSecondsFromTheFirstAndKeepItsMoment) {
  const Imported one = of_text(
      "Time [ms],x,F\n2026-10-25T02:59:59.999999999+02:00,1,2\n2026-10-25T02:00:00.000000001+01:00,2,3\n"
      "2026-10-25T01:00:00.5Z,3,4\n");
  EXPECT_THAT(one.recording.time, ElementsAre(0.0, 2e-9, 0.500000001)) << "a clock that is put back an hour";
  EXPECT_EQ(one.recording.header.start_ns, 1792889999999999999);
  EXPECT_EQ(one.recording.header.start_clock, "UTC");
  EXPECT_EQ(one.layout.header_line, 1U);
}

TEST(Stamps, WithoutAZoneAreOfALocalClock) {
  const Imported one = of_text(
      "# at 2026-01-31T11:59:00\n\"2026-01-31 12:00:00,25\";1,5;2\n\"2026-01-31 12:00:00,50\";2,5;3\n"
      "\"2026-01-31 12:00:00,75Z\";2,5;3\n\"2026-01-31 12:00:01,00\";2,5;3\n");
  EXPECT_THAT(one.recording.time, ElementsAre(0.0, 0.25, 0.75));
  EXPECT_THAT(one.bad_lines, ElementsAre(4U))
      << "nobody knows how far a stamp with a zone is from the others";
  EXPECT_EQ(one.recording.header.start_ns, 1769860800250000000);
  EXPECT_EQ(one.recording.header.start_clock, "local");
  EXPECT_THAT(one.warnings, testing::Contains(HasSubstr("the time stamps name no zone")));
}

TEST(Stamps, AreNothingButATime) {
  const std::string text = "2026-01-31T12:00:00Z 1 2\n2026-01-31T12:00:01Z 2 3\n";
  EXPECT_EQ(of_text(text).recording.rows(), 2U) << "separated by blanks";
  EXPECT_THAT([&] { (void)of_text(text, {}, "time=1[ms],position=2[mm]"); },
              testing::ThrowsMessage<std::invalid_argument>(
                  HasSubstr("column 1 holds time stamps, mapped to time[ms]; expected time=1")));
  EXPECT_THAT([&] { (void)of_text(text, {.rate_hz = 1.0}, "at=1,position=2[mm]"); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("mapped to at[s]")));
}

TEST(Stamps, OfAStretchAreItsOwn) {
  std::string text;
  for (int i = 0; i < 60; ++i)
    text += "2026-01-31T12:00:" + std::string(i % 30 < 10 ? "0" : "") + std::to_string(i % 30) + "Z,1,2\n";
  const Imported second = of_text(text, {.stretch = 2});
  EXPECT_EQ(second.recording.rows(), 30U);
  EXPECT_EQ(second.recording.header.start_ns, 1769860800000000000);
}

TEST(Stamps, AreShownByInfo) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "data.csv", "2026-01-31T12:00:00.5Z,1,2\n2026-01-31T12:00:01.5Z,2,3\n");
  const std::string file = (folder / "r.h5").string();
  const auto outcome = test::run_kerf(
      {"import", (folder / "data.csv").string(), "--map", "time=1,position=2[mm],force=3[N]", "-o", file});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("time: column 1, time stamps; time 0 is 2026-01-31T12:00:00.5Z\n"));
  EXPECT_THAT(test::run_kerf({"info", file}).output, HasSubstr("start       2026-01-31T12:00:00.5Z\n"));
  const auto json = nlohmann::json::parse(test::run_kerf({"info", file, "--json"}).output);
  EXPECT_EQ(json.at("start").at("ns").get<std::int64_t>(), 1769860800500000000);
  EXPECT_EQ(json.at("start").at("clock"), "UTC");
  EXPECT_EQ(test::run_kerf({"validate", file}).exit_status, 0);
}

}  // namespace
}  // namespace kerf::bench

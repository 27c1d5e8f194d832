#include "inspect/counted_rows.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/data/inspect/closings.h"
#include "recordings/provenance.h"
#include "segment/segment.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using test::Closings;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double felt_n = 0.05;

/// Ten cycles, of which the fourth is not felt and the last is a tool put down.
schema::Recording with_two_bad_cycles() {
  Closings closings;
  closings.put_down = true;
  closings.last_hold_s = 12.0;
  closings.peaks[3] = 0.01;
  schema::Recording recording = closings.made();
  recording.header = schema::new_header("kerf test");
  recording.cycles = find_cycles(recording, {});
  return recording;
}

AxisSeries series_of(const schema::Recording& recording) {
  return fit_series(recording, 0, {.position = 0.0, .direction = 1.0});
}

std::vector<std::uint32_t> numbers_of(const CountedRows& counted) {
  std::vector<std::uint32_t> numbers;
  for (const LeftOutCycle& cycle : counted.left_out) numbers.push_back(cycle.number);
  return numbers;
}

/// The cycles in which some row counts, as they are numbered now.
std::vector<std::uint32_t> cycles_that_count(const AxisSeries& series) {
  std::vector<std::uint32_t> cycles;
  for (std::size_t row = 0; row < series.force.size(); ++row) {
    if (series.counts[row] != 0 && series.cycle[row] > 0) cycles.push_back(series.cycle[row]);
  }
  std::ranges::sort(cycles);
  cycles.erase(std::unique(cycles.begin(), cycles.end()), cycles.end());
  return cycles;
}

TEST(CycleChoice, IsAWordOrAList) {
  EXPECT_EQ(parse_cycle_choice("good").by, CycleChoice::By::good);
  EXPECT_EQ(parse_cycle_choice("all").by, CycleChoice::By::all);
  EXPECT_THAT(parse_cycle_choice("2-4,7").listed, ElementsAre(2, 3, 4, 7));
  EXPECT_EQ(in_words(parse_cycle_choice("7,2-4")), "2,3,4,7");
  EXPECT_THAT([] { (void)parse_cycle_choice("bad"); },
              testing::ThrowsMessage<std::invalid_argument>(
                  HasSubstr("'bad' is neither good nor all nor a list of cycles like 2-8,10")));
}

TEST(CountedRows, AreThoseOfCyclesWithoutAFlag) {
  const schema::Recording recording = with_two_bad_cycles();
  AxisSeries series = series_of(recording);
  const std::vector<std::uint32_t> before = series.cycle;
  const CountedRows counted = mark_counted(series, recording, 0, {}, felt_n);
  EXPECT_EQ(counted.cycles, 10U);
  EXPECT_THAT(numbers_of(counted), ElementsAre(4, 10));
  EXPECT_THAT(counted.left_out[1].reason, HasSubstr("the tool was put down"));
  EXPECT_THAT(cycles_that_count(series), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8)) << "numbered anew";
  for (std::size_t row = 0; row < before.size(); ++row) {
    const bool left_out = before[row] == 4 || before[row] == 10;
    ASSERT_TRUE(!left_out || (series.counts[row] == 0 && series.cycle[row] == 0)) << row;
    ASSERT_TRUE(before[row] != 5 || series.cycle[row] == 4) << row;
  }
  EXPECT_EQ(counted.rows, static_cast<std::size_t>(std::ranges::count(series.counts, 1)));
  EXPECT_THAT(cycles_left_out(counted),
              HasSubstr("2 of 10 cycles are left out (--cycles all takes them): cycle 4: its peak"));
}

TEST(CountedRows, AreOfAllCyclesOrOfThoseThatAreListed) {
  const schema::Recording recording = with_two_bad_cycles();
  AxisSeries series = series_of(recording);
  const CountedRows all =
      mark_counted(series, recording, 0, {.cycles = {.by = CycleChoice::By::all}}, felt_n);
  EXPECT_THAT(numbers_of(all), IsEmpty());
  EXPECT_EQ(cycles_left_out(all), "");
  EXPECT_EQ(all.rows, all.contact);
  EXPECT_EQ(*std::ranges::max_element(series.cycle), 10U);
  series = series_of(recording);
  const CountedRows two = mark_counted(series, recording, 0, {.cycles = parse_cycle_choice("2,5")}, felt_n);
  EXPECT_THAT(numbers_of(two), ElementsAre(1, 3, 4, 6, 7, 8, 9, 10));
  EXPECT_THAT(cycles_that_count(series), ElementsAre(1, 2));
  EXPECT_THAT(
      [&] { mark_counted(series, recording, 0, {.cycles = parse_cycle_choice("11")}, felt_n); },
      testing::ThrowsMessage<std::invalid_argument>(HasSubstr("there is no cycle 11; the recording has 10")));
}

TEST(CountedRows, GoByWhatIsStored) {
  schema::Recording recording = with_two_bad_cycles();
  recording.cycle_flags = {.flags = {{.cycle = 2, .fault = "by_hand", .reason = "it slipped"},
                                     {.cycle = 4, .fault = "under_force", .reason = "its peak is not felt"},
                                     {.cycle = 4, .fault = "accepted", .reason = "a light one was wanted"}}};
  AxisSeries series = series_of(recording);
  const CountedRows counted = mark_counted(series, recording, 0, {}, felt_n);
  EXPECT_THAT(numbers_of(counted), ElementsAre(2));
  EXPECT_EQ(counted.left_out[0].reason, "it slipped");
}

TEST(CountedRows, AreOfAllCyclesWhereNoneIsGood) {
  schema::Recording recording = with_two_bad_cycles();
  recording.cycle_flags.emplace();
  for (std::uint32_t cycle = 1; cycle <= 10; ++cycle)
    recording.cycle_flags->flags.push_back({.cycle = cycle, .fault = "by_hand", .reason = "another tool"});
  AxisSeries series = series_of(recording);
  const CountedRows counted = mark_counted(series, recording, 0, {}, felt_n);
  EXPECT_TRUE(counted.none_is_good);
  EXPECT_EQ(counted.rows, counted.contact);
  EXPECT_EQ(*std::ranges::max_element(series.cycle), 10U);
  EXPECT_THAT(cycles_left_out(counted), HasSubstr("none of the cycles is without a flag"));
}

TEST(CountedRows, AreNotWhatLiesOutsideOfCyclesOfWhichNoneIsGood) {
  schema::Recording recording = with_two_bad_cycles();
  recording.cycle_flags.emplace();
  for (std::uint32_t cycle = 1; cycle <= 10; ++cycle)
    recording.cycle_flags->flags.push_back({.cycle = cycle, .fault = "by_hand", .reason = "another tool"});
  recording.cycles->phases.erase(recording.cycles->phases.begin(), recording.cycles->phases.begin() + 1);
  AxisSeries series = series_of(recording);
  const RowChoice all{.rows = Counted::all, .cycles = {}};
  ASSERT_GT(std::ranges::count(series.cycle, 0U), 50) << "rows of no cycle";
  const CountedRows counted = mark_counted(series, recording, 0, all, felt_n);
  EXPECT_TRUE(counted.none_is_good);
  EXPECT_EQ(counted.rows, series.force.size());
}

TEST(CountedRows, OfAnotherAxisKnowNoCycles) {
  schema::Recording recording = with_two_bad_cycles();
  recording.cycles->axis = 1;
  AxisSeries series = series_of(recording);
  EXPECT_EQ(mark_counted(series, recording, 0, {}, felt_n).cycles, 0U);
  const RowChoice two{.cycles = parse_cycle_choice("2-3")};
  EXPECT_THAT([&] { mark_counted(series, recording, 0, two, felt_n); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("no cycles are kept along axis")));
  recording.cycles.reset();
  EXPECT_THAT([&] { mark_counted(series, recording, 0, two, felt_n); },
              testing::ThrowsMessage<std::invalid_argument>(HasSubstr("'kerf segment' finds them")));
}

/// Flags in a file, by the program.
class StoredFlags : public testing::Test {
 protected:
  StoredFlags() {
    schema::Recording recording = with_two_bad_cycles();
    recording.cycles.reset();
    schema::write_recording(file_, recording);
    const auto outcome = test::run_kerf({"segment", file_, "--json"});
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    segmented_ = nlohmann::json::parse(outcome.output);
  }

  nlohmann::json fit(const std::string& cycles) {
    std::vector<std::string> command{"fit",     file_,        "--models",
                                     "kelvin",  "--no-folds", "--json",
                                     "--force", "-o",         (folder_ / "fits").string()};
    if (!cycles.empty()) command.insert(command.end(), {"--cycles", cycles});
    const auto outcome = test::run_kerf(command);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    errors_ = outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }

  test::TemporaryFolder folder_;
  std::string file_ = (folder_ / "r.h5").string();
  nlohmann::json segmented_;
  std::string errors_;
};

TEST_F(StoredFlags, AreFoundWithTheCyclesAndLeaveTheRecordingTheSame) {
  ASSERT_EQ(segmented_.at("flagged").size(), 2U);
  EXPECT_EQ(segmented_.at("flagged")[0].at("cycle"), 4);
  const schema::Recording recording = schema::read_recording(file_);
  ASSERT_TRUE(recording.cycle_flags);
  EXPECT_EQ(recording.cycle_flags->felt, felt_n);
  EXPECT_EQ(recording.cycle_flags->flags.front().fault, "under_force");
  schema::Recording bare = with_two_bad_cycles();
  bare.cycles.reset();
  EXPECT_EQ(content_sha256_of(std::filesystem::path(file_)), content_sha256_of(schema::RowsInMemory(bare)))
      << "what was sampled is what it was";
  EXPECT_EQ(test::run_kerf({"validate", file_}).exit_status, 0);
}

TEST_F(StoredFlags, DecideWhatAFitGoesBy) {
  const nlohmann::json good = fit("");
  EXPECT_EQ(good.at("settings").at("cycles"), "good");
  ASSERT_EQ(good.at("recordings")[0].at("cycles_left_out").size(), 2U);
  EXPECT_THAT(errors_, HasSubstr("2 of 10 cycles are left out (--cycles all takes them)"));
  const nlohmann::json all = fit("all");
  EXPECT_THAT(all.at("recordings")[0].at("cycles_left_out"), IsEmpty());
  EXPECT_GT(all.at("fits")[0].at("samples"), good.at("fits")[0].at("samples"));
  EXPECT_GT(all.at("fits")[0].at("rmse").get<double>(), 1.3 * good.at("fits")[0].at("rmse").get<double>())
      << "a law of felt cycles is wrong by a whole closing in the fourth";
  EXPECT_EQ(all.at("recordings")[0].at("content_sha256"), good.at("recordings")[0].at("content_sha256"));
}

TEST_F(StoredFlags, TakeWhatAPersonSays) {
  const auto said =
      test::run_kerf({"inspect", file_, "--flag", "2=it slipped", "--accept", "4=a light one", "--json"});
  ASSERT_EQ(said.exit_status, 0) << said.errors;
  const auto cycles = nlohmann::json::parse(said.output).at("cycles").at("list");
  EXPECT_EQ(cycles[1].at("flags")[0].at("kind"), "by_hand");
  EXPECT_EQ(cycles[3].at("accepted"), "a light one");
  EXPECT_EQ(cycles[3].at("good"), true);
  nlohmann::json left_out = fit("").at("recordings")[0].at("cycles_left_out");
  ASSERT_EQ(left_out.size(), 2U);
  EXPECT_EQ(left_out[0].at("number"), 2);
  EXPECT_EQ(left_out[1].at("number"), 10);
  ASSERT_EQ(test::run_kerf({"inspect", file_, "--clear", "2", "--clear", "4"}).exit_status, 0);
  left_out = fit("").at("recordings")[0].at("cycles_left_out");
  EXPECT_EQ(left_out[0].at("number"), 4) << "as it was found";
  const auto renewed = test::run_kerf({"inspect", file_, "--flag", "1=the wrong tissue"});
  const auto again = test::run_kerf({"segment", file_});
  EXPECT_THAT(again.errors, HasSubstr("what was said by hand of its cycles, 1 remarks, is gone with them"));
}

TEST_F(StoredFlags, AreRefusedForNoCycleAndForNoReason) {
  const auto refusal = [&](const std::string& option, const std::string& text) {
    const auto outcome = test::run_kerf({"inspect", file_, option, text});
    EXPECT_EQ(outcome.exit_status, 2) << text;
    return outcome.errors;
  };
  EXPECT_THAT(refusal("--flag", "11=late"), HasSubstr("there is no cycle 11; the recording has 10"));
  EXPECT_THAT(refusal("--flag", "3"), HasSubstr("gives no reason; expected one like 3=WHY"));
  EXPECT_THAT(refusal("--accept", "third=fine"), HasSubstr("names no cycle"));
}

}  // namespace
}  // namespace kerf::bench

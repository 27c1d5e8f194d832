#include "segment/cycle_edit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/validate.h>

#include "recordings/summary.h"

namespace kerf::bench {
namespace {

using schema::Phase;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double felt = 0.05;

/// Eight cosine strokes of 500 rows and 0.5 rad, against 2 N/rad with 1 N more while closing, cycles found.
schema::Recording eight_cycles() {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  for (int row = 0; row < 8000; ++row) {
    const double turn = std::numbers::pi * row / 500.0;
    recording.time.push_back(1e-3 * row);
    recording.tick.push_back(static_cast<std::uint64_t>(row));
    recording.position.push_back(0.25 * (1.0 - std::cos(turn)));
    recording.velocity.push_back(250.0 * std::numbers::pi / 500.0 * std::sin(turn));
    recording.force_measured.push_back(2.0 * recording.position.back() + (row / 500 % 2 == 0 ? 1.0 : 0.1));
  }
  segment_recording(recording, schema::RowsInMemory(recording), {}, "test");
  return recording;
}

schema::PhaseSpan& phase_of(std::vector<schema::PhaseSpan>& phases, std::uint32_t cycle, Phase phase) {
  return *std::ranges::find_if(phases,
                               [&](const auto& it) { return it.cycle == cycle && it.phase == phase; });
}

/// The edit that moves the begin of a phase, and the end of the one before it.
CycleEdit moved(const schema::Recording& recording, std::uint32_t cycle, Phase phase, std::int64_t by) {
  CycleEdit edit{.found_by = {}, .phases = recording.cycles->phases, .said = {}};
  schema::PhaseSpan& span = phase_of(edit.phases, cycle, phase);
  const std::uint64_t before = span.begin;
  span.begin += static_cast<std::uint64_t>(by);
  for (schema::PhaseSpan& other : edit.phases) {
    if (other.end == before) other.end = span.begin;
  }
  return edit;
}

/// With a number in the place of those that are none, which differ from themselves.
std::vector<double> comparable(std::vector<double> branch) {
  std::ranges::replace_if(
      branch, [](double force) { return std::isnan(force); }, -1e9);
  return branch;
}

std::vector<std::string> texts_of(const std::vector<schema::CycleChange>& changes) {
  std::vector<std::string> texts;
  for (const schema::CycleChange& change : changes) texts.push_back(change.text);
  return texts;
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CycleEdit, ThatChangesNothingLeavesEveryNumberAsItWasFound) {
  const schema::Recording recording = eight_cycles();
  const schema::RowsInMemory rows(recording);
  CycleEdit edit = moved(recording, 3, Phase::closing, 0);
  const EditedCycles stored = edited_cycles(rows, edit, felt);
  edit.found_by = SegmentOptions{};
  const EditedCycles found = edited_cycles(rows, edit, felt);
  for (const EditedCycles* edited : {&stored, &found}) {
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_EQ(comparable(edited->cycles.closing[i]), comparable(recording.cycles->closing[i]));
    EXPECT_EQ(comparable(edited->cycles.opening_mean), comparable(recording.cycles->opening_mean));
    EXPECT_EQ(edited->flagged.size(), 8U);
  }
  EXPECT_THAT(texts_of(changes_by(rows, moved(recording, 3, Phase::closing, 0), stored)), ElementsAre());
}

TEST(CycleEdit, AveragesTheRowsThatAPhaseHasNow) {
  const schema::Recording recording = eight_cycles();
  const schema::RowsInMemory rows(recording);
  const EditedCycles edited = edited_cycles(rows, moved(recording, 3, Phase::closing, 60), felt);
  const auto& before = recording.cycles->closing;
  const auto& after = edited.cycles.closing;
  EXPECT_NE(after[2][5], before[2][5]) << "its first rows are gone";
  EXPECT_EQ(after[2][80], before[2][80]);
  EXPECT_EQ(comparable(after[1]), comparable(before[1])) << "other cycles stay";
  EXPECT_EQ(edited.cycles.grid, recording.cycles->grid);
  EXPECT_EQ(edited.cycles.contact_position, recording.cycles->contact_position);
}

TEST(CycleEdit, KeepsWhoChangedWhatAndWhen) {
  const schema::Recording recording = eight_cycles();
  const schema::RowsInMemory rows(recording);
  CycleEdit edit = moved(recording, 3, Phase::closing, 40);
  edit.said = {{.cycle = 5, .fault = "by_hand", .reason = "the tissue slipped"}};
  const EditedCycles edited = edited_cycles(rows, edit, felt);
  const schema::Recording about = with_edit(rows, edit, edited, felt, "Anna Ω");
  const std::vector<ToldEdit> edits = edits_of(about);
  ASSERT_EQ(edits.size(), 1U);
  EXPECT_EQ(edits[0].author, "Anna Ω");
  EXPECT_EQ(edits[0].time.size(), std::string("2026-01-31T12:00:00Z").size());
  const std::uint64_t row = phase_of(edit.phases, 3, Phase::closing).begin;
  EXPECT_EQ(
      edits[0].what,
      fmt::format(
          "cycle 3: closing begins at {:.6g} s (row {}) instead of {:.6g} s (row {}); cycle 5 left out: "
          "the tissue slipped",
          1e-3 * static_cast<double>(row), row, 1e-3 * static_cast<double>(row - 40), row - 40));
  ASSERT_EQ(about.cycle_edits.size(), 2U);
  const schema::CycleChange& boundary = about.cycle_edits[0];
  EXPECT_EQ(boundary.edit, 1U);
  EXPECT_EQ(boundary.cycle, 3U);
  EXPECT_EQ(boundary.phase, static_cast<int>(Phase::closing));
  EXPECT_EQ(boundary.kind, "begin");
  EXPECT_EQ(boundary.row_before, static_cast<std::int64_t>(row - 40));
  EXPECT_EQ(boundary.row_after, static_cast<std::int64_t>(row));
  EXPECT_EQ(about.cycle_edits[1].kind, "left_out");
  EXPECT_EQ(about.cycle_edits[1].row_after, -1);
  EXPECT_EQ(about.cycle_edits[1].author, "Anna Ω");
  EXPECT_EQ(about.cycle_edits[1].time, boundary.time);
  EXPECT_THAT(about.header.history, HasSubstr("cycles edited by Anna Ω: 2 changes, in /cycle_edits\n"));
  EXPECT_EQ(about.time, rows.about().time) << "what was sampled stays";
  const auto flags = about.cycle_flags->flags;
  EXPECT_TRUE(std::ranges::any_of(
      flags, [](const auto& flag) { return flag.cycle == 5 && flag.fault == "by_hand"; }));
}

TEST(CycleEdit, IsToldByTheSummaryUntilCyclesAreFoundAnew) {
  schema::Recording recording = eight_cycles();
  const CycleEdit edit = moved(recording, 2, Phase::opening, 10);
  recording = with_edit(schema::RowsInMemory(recording), edit,
                        edited_cycles(schema::RowsInMemory(recording), edit, felt), felt, "Bo");
  const auto summary = recording_summary(recording);
  EXPECT_EQ(summary["cycles"]["edits"].size(), 1U);
  EXPECT_EQ(summary["cycles"]["edits"][0]["author"], "Bo");
  segment_recording(recording, schema::RowsInMemory(recording), {}, "test");
  EXPECT_TRUE(edits_of(recording).empty());
  EXPECT_FALSE(recording_summary(recording)["cycles"].contains("edits"));
  EXPECT_THAT(recording.header.history, HasSubstr("cycles edited by Bo")) << "the history keeps what was";
}

TEST(CycleEdit, LeavesOutAndTakesBack) {
  schema::Recording recording = eight_cycles();
  CycleEdit drop{
      .found_by = {}, .phases = {}, .said = {{.cycle = 4, .fault = "by_hand", .reason = "slipped"}}};
  {
    const schema::RowsInMemory rows(recording);
    const EditedCycles dropped = edited_cycles(rows, drop, felt);
    EXPECT_FALSE(dropped.flagged[3].is_good());
    recording = with_edit(rows, drop, dropped, felt, "Bo");
  }
  const schema::RowsInMemory rows(recording);
  const CycleEdit restore{.found_by = {}, .phases = {}, .said = {}};
  const EditedCycles restored = edited_cycles(rows, restore, felt);
  EXPECT_TRUE(restored.flagged[3].is_good());
  EXPECT_THAT(texts_of(changes_by(rows, restore, restored)),
              ElementsAre("cycle 4 no longer left out by hand"));
}

TEST(CycleEdit, IsRefusedInALineThatNamesTheCycle) {
  const schema::Recording recording = eight_cycles();
  const schema::RowsInMemory rows(recording);
  const auto refused = [&](const CycleEdit& edit) {
    return refusal([&] { (void)edited_cycles(rows, edit, felt); });
  };
  CycleEdit beyond = moved(recording, 8, Phase::opening, 0);
  beyond.phases.back().end = 8001;
  EXPECT_THAT(refused(beyond), HasSubstr("cycle 8: opening is of the rows"));
  CycleEdit overlapping = moved(recording, 3, Phase::closing, 0);
  phase_of(overlapping.phases, 3, Phase::closing).begin -= 5;
  EXPECT_THAT(refused(overlapping), HasSubstr("cycle 3: closing"));
  CycleEdit empty = moved(recording, 3, Phase::closing, 0);
  schema::PhaseSpan& closing = phase_of(empty.phases, 3, Phase::closing);
  closing.begin = closing.end;
  EXPECT_THAT(refused(empty), HasSubstr("expected one row and more"));
  CycleEdit open = moved(recording, 3, Phase::closing, 0);
  std::erase_if(open.phases, [](const auto& it) { return it.cycle == 3 && it.phase == Phase::closing; });
  EXPECT_THAT(refused(open), HasSubstr("cycle 3 is not made of a wait, a closing"));
  CycleEdit gap = moved(recording, 3, Phase::closing, 0);
  std::erase_if(gap.phases, [](const auto& it) { return it.cycle == 3; });
  EXPECT_THAT(refused(gap), HasSubstr("expected cycles counted from 1"));
  CycleEdit turned = moved(recording, 3, Phase::closing, 0);
  phase_of(turned.phases, 3, Phase::closing).phase = Phase::opening;
  EXPECT_THAT(refused(turned), HasSubstr("cycle 3 is not made of"));
  EXPECT_THAT(
      refused({.found_by = {}, .phases = {}, .said = {{.cycle = 9, .fault = "by_hand", .reason = "x"}}}),
      HasSubstr("there is no cycle 9; the recording has 8"));
  EXPECT_THAT(
      refused({.found_by = {}, .phases = {}, .said = {{.cycle = 1, .fault = "outlier", .reason = "x"}}}),
      HasSubstr("expected by_hand or accepted"));
  EXPECT_THAT(
      refused({.found_by = {}, .phases = {}, .said = {{.cycle = 1, .fault = "by_hand", .reason = ""}}}),
      HasSubstr("cycle 1 has no reason"));
  for (const char* author : {"", "a:b", "a\nb"})
    EXPECT_NE(refusal([&] { check_author(author); }), "") << author;
}

TEST(CycleEdit, IsToldOfAFileOfAnEarlierVersionByItsHistory) {
  const schema::Recording earlier =
      schema::read_recording(KERF_SOURCE_DIR "/tests/bench/data/segment/golden/edits-in-history.h5");
  ASSERT_TRUE(earlier.cycle_edits.empty());
  const std::vector<ToldEdit> edits = edits_of(earlier);
  ASSERT_EQ(edits.size(), 2U);
  EXPECT_EQ(edits[0].author, "Anna Ω");
  EXPECT_EQ(edits[0].what, "cycle 3 left out: it slipped");
  EXPECT_EQ(edits[1].author, "Bo");
  EXPECT_THAT(edits[1].what, HasSubstr("cycle 2: closing begins at"));
  EXPECT_THAT(edits[1].what, HasSubstr("; cycle 3 no longer left out by hand"));
  EXPECT_TRUE(
      schema::validate(KERF_SOURCE_DIR "/tests/bench/data/segment/golden/edits-in-history.h5").empty());
}

TEST(CycleEdit, IsToldInItsOrderWhereTheHistoryAndTheFileKeepSome) {
  schema::Recording recording = eight_cycles();
  recording.header.history += "2026-01-01T00:00:00Z kerf 0.1.0: cycles edited by Anna: cycle 2 left out: x\n";
  for (const char* const author : {"Bo", "Cy"}) {
    const CycleEdit edit = moved(recording, 2, Phase::opening, 10);
    const schema::RowsInMemory rows(recording);
    recording = with_edit(rows, edit, edited_cycles(rows, edit, felt), felt, author);
  }
  const std::vector<ToldEdit> edits = edits_of(recording);
  ASSERT_EQ(edits.size(), 3U);
  EXPECT_EQ(edits[0].what, "cycle 2 left out: x");
  EXPECT_EQ(edits[1].author, "Bo");
  EXPECT_THAT(edits[2].what, HasSubstr("cycle 2: opening begins at"));
  EXPECT_EQ(recording.cycle_edits.back().edit, 2U);
  recording.cycle_edits.clear();  // by a version that does not know them
  EXPECT_THAT(edits_of(recording)[2].what, HasSubstr("in /cycle_edits"));
  recording.header.history += "2026-01-01T00:00:00Z kerf 0.1.0: segment: 8 cycles\n";
  EXPECT_TRUE(edits_of(recording).empty());
}

TEST(CycleEdit, MakesOtherCyclesOfWhichFitsCanTell) {
  schema::Recording recording = eight_cycles();
  const std::string before = cycles_sha256_of(recording);
  EXPECT_EQ(before.size(), 64U);
  schema::Recording same = recording;
  same.header.history += "2026-01-31T12:00:00Z kerf 0.1.0: a step\n";
  EXPECT_EQ(cycles_sha256_of(same), before);
  schema::Recording dropped = recording;
  dropped.cycle_flags = {.created = {},
                         .software = {},
                         .felt = felt,
                         .flags = {{.cycle = 4, .fault = "by_hand", .reason = "slipped"}}};
  EXPECT_NE(cycles_sha256_of(dropped), before);
  dropped.cycle_flags->flags.push_back({.cycle = 4, .fault = "accepted", .reason = "it did not"});
  EXPECT_EQ(cycles_sha256_of(dropped), before);
  recording.cycles->phases.front().end += 1;
  EXPECT_NE(cycles_sha256_of(recording), before);
  recording.cycles.reset();
  EXPECT_EQ(cycles_sha256_of(recording), "");
}

}  // namespace
}  // namespace kerf::bench

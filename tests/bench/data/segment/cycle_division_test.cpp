#include "segment/cycle_division.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segment/cycle_edit.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using schema::Phase;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double felt_force = 0.05;

/// Five cosine strokes of 1000 rows; the third one turns back by a tenth half-way of its closing, which the
/// prominence of a third passes over.
schema::Recording with_a_hesitation() {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  double position = 0.0;
  for (int row = 0; row < 5000; ++row) {
    const double turn = 2.0 * std::numbers::pi * row / 1000.0;
    const bool hesitates = row >= 2200 && row < 2300;
    position = 0.25 * (1.0 - std::cos(turn)) -
               (hesitates ? 0.1 * std::sin((row - 2200) * std::numbers::pi / 100.0) : 0.0);
    recording.time.push_back(1e-3 * row);
    recording.tick.push_back(static_cast<std::uint64_t>(row));
    recording.position.push_back(position);
    recording.velocity.push_back(0.0);
    recording.force_measured.push_back(2.0 * position + (row % 1000 < 500 ? 1.0 : 0.1));
  }
  segment_recording(recording, schema::RowsInMemory(recording), {}, "test");
  return recording;
}

std::vector<std::uint32_t> cycles_of(const std::vector<schema::PhaseSpan>& phases, Phase phase) {
  std::vector<std::uint32_t> cycles;
  for (const schema::PhaseSpan& span : phases) {
    if (span.phase == phase) cycles.push_back(span.cycle);
  }
  return cycles;
}

class CycleDivision : public testing::Test {
 protected:
  [[nodiscard]] CycleEdit after(const CycleStep& step, std::vector<schema::CycleFlag> said = {}) const {
    return with_step(rows_, {.found_by = {}, .phases = {}, .said = std::move(said)}, step);
  }
  [[nodiscard]] std::string refusal(const CycleStep& step) const {
    try {
      (void)after(step);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::vector<schema::CycleChange> changes(const CycleEdit& edit) const {
    return changes_by(rows_, edit, edited_cycles(rows_, edit, felt_force));
  }

  schema::Recording recording_ = with_a_hesitation();
  schema::RowsInMemory rows_{recording_};
};

TEST_F(CycleDivision, GivesEitherPartThePhasesOfItsOwnMotion) {
  ASSERT_EQ(recording_.cycles->closing.size(), 5U);
  const CycleEdit edit = after({.kind = CycleStep::Kind::split, .cycle = 3, .row = 2250});
  EXPECT_THAT(cycles_of(edit.phases, Phase::closing), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(cycles_of(edit.phases, Phase::opening), ElementsAre(1, 2, 3, 4, 5, 6))
      << "the hesitation is the opening of the first part";
  const auto first_of = [&](std::uint32_t cycle) {
    return std::ranges::find(edit.phases, cycle, &schema::PhaseSpan::cycle);
  };
  EXPECT_EQ(first_of(4)->begin, 2250U);
  EXPECT_EQ(std::prev(first_of(4))->end, 2250U) << "no row is lost";
  EXPECT_EQ(edit.phases.back().end, recording_.cycles->phases.back().end);
  const EditedCycles edited = edited_cycles(rows_, edit, felt_force);
  EXPECT_EQ(edited.cycles.closing.size(), 6U);
  EXPECT_EQ(edited.flagged.size(), 6U);
  const auto told = changes(edit);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, "split");
  EXPECT_EQ(told[0].cycle, 3U);
  EXPECT_EQ(told[0].row_after, 2250);
  EXPECT_EQ(told[0].text, "cycle 3 split at 2.25 s (row 2250) into 3 and 4");
}

TEST_F(CycleDivision, MakesOneOfTwoThatWereSplit) {
  const CycleEdit split = after({.kind = CycleStep::Kind::split, .cycle = 3, .row = 2250});
  const CycleEdit merged = with_step(rows_, split, {.kind = CycleStep::Kind::merge, .cycle = 3, .row = 0});
  const auto& found = recording_.cycles->phases;
  ASSERT_EQ(merged.phases.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(merged.phases[i].cycle, found[i].cycle);
    EXPECT_EQ(merged.phases[i].phase, found[i].phase);
    EXPECT_NEAR(static_cast<double>(merged.phases[i].begin), static_cast<double>(found[i].begin), 20.0);
  }
}

TEST_F(CycleDivision, TellsWhereTwoThatAreMergedHadMet) {
  const std::uint64_t met =
      std::ranges::find(recording_.cycles->phases, 3U, &schema::PhaseSpan::cycle)->begin;
  const auto told = changes(after({.kind = CycleStep::Kind::merge, .cycle = 2, .row = 0}));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, "merged");
  EXPECT_EQ(told[0].row_before, static_cast<std::int64_t>(met));
  EXPECT_THAT(told[0].text, HasSubstr("cycles 2 and 3, which met at"));
  EXPECT_THAT(told[0].text, HasSubstr(", merged into 2"));
}

TEST_F(CycleDivision, TakesWhatWasSaidAlong) {
  const std::vector<schema::CycleFlag> said{{.cycle = 3, .fault = "by_hand", .reason = "slipped"},
                                            {.cycle = 4, .fault = "by_hand", .reason = "late"}};
  const auto numbers = [](const CycleEdit& edit) {
    std::vector<std::pair<std::uint32_t, std::string>> all;
    for (const schema::CycleFlag& flag : edit.said) all.emplace_back(flag.cycle, flag.reason);
    return all;
  };
  using Said = std::pair<std::uint32_t, std::string>;
  EXPECT_THAT(numbers(after({.kind = CycleStep::Kind::split, .cycle = 3, .row = 2250}, said)),
              ElementsAre(Said(3, "slipped"), Said(4, "slipped"), Said(5, "late")));
  EXPECT_THAT(numbers(after({.kind = CycleStep::Kind::merge, .cycle = 3, .row = 0}, said)),
              ElementsAre(Said(3, "slipped")));
  EXPECT_THAT(numbers(after({.kind = CycleStep::Kind::merge, .cycle = 2, .row = 0}, said)),
              ElementsAre(Said(2, "slipped"), Said(3, "late")));
}

TEST_F(CycleDivision, IsRefusedInALineThatNamesTheCycle) {
  const auto split = [](std::uint32_t cycle, std::uint64_t row) {
    return CycleStep{.kind = CycleStep::Kind::split, .cycle = cycle, .row = row};
  };
  EXPECT_THAT(refusal(split(9, 10)), HasSubstr("there is no cycle 9"));
  EXPECT_THAT(refusal(split(3, 10)), HasSubstr("cycle 3 has the rows"));
  EXPECT_THAT(refusal(split(3, 2800)), HasSubstr("cycle 4: the rows 2800 to"))
      << "an opening alone is no cycle";
  EXPECT_THAT(refusal(split(3, 2020)), HasSubstr("hold no closing"));
  EXPECT_THAT(refusal({.kind = CycleStep::Kind::merge, .cycle = 5, .row = 0}),
              HasSubstr("there is no cycle 6"));
}

TEST_F(CycleDivision, TellsABoundaryThatMovedBesideACycleThatWasSplit) {
  CycleEdit edit = after({.kind = CycleStep::Kind::split, .cycle = 3, .row = 2250});
  for (std::size_t i = 1; i < edit.phases.size(); ++i) {
    if (edit.phases[i].cycle != 5 || edit.phases[i].phase != Phase::closing) continue;
    edit.phases[i].begin += 10;
    edit.phases[i - 1].end += 10;
  }
  const auto told = changes(edit);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[1].kind, "begin");
  EXPECT_EQ(told[1].cycle, 5U) << "as cycles are counted now";
  EXPECT_EQ(told[1].row_after - told[1].row_before, 10);
}

TEST(SegmentVerb, SplitsAndMergesTheCyclesThatAreStored) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "cut.h5").string();
  schema::write_recording(file, with_a_hesitation());
  const auto done = test::run_kerf({"segment", file, "--split", "2.25", "--merge", "1", "--by", "Cy"});
  ASSERT_EQ(done.exit_status, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("cycles 1 and 2, which met at"));
  EXPECT_THAT(done.output, HasSubstr("cycle 3 split at 2.25 s (row 2250) into 2 and 3"));
  const schema::Recording kept = schema::read_recording(file);
  EXPECT_EQ(kept.cycles->closing.size(), 5U);
  ASSERT_EQ(kept.cycle_edits.size(), 2U);
  EXPECT_EQ(kept.cycle_edits[0].author, "Cy");
  EXPECT_EQ(test::run_kerf({"validate", file}).exit_status, 0);
  const auto beyond = test::run_kerf({"segment", file, "--split", "99"});
  EXPECT_EQ(beyond.exit_status, 2);
  EXPECT_THAT(beyond.errors, HasSubstr("--split: no cycle lies at 99 s"));
  EXPECT_EQ(test::run_kerf({"segment", file, "--merge", "5"}).exit_status, 2);
  EXPECT_EQ(schema::read_recording(file).cycle_edits.size(), 2U) << "what is refused changes nothing";
}

}  // namespace
}  // namespace kerf::bench

#include "report/results/summary.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

FoundResult of_kind(ResultKind kind, const char* text, Belongs belongs = Belongs::here) {
  return {.kind = kind, .file = "r.json", .json = nlohmann::ordered_json::parse(text), .belongs = belongs};
}

constexpr auto passing = R"({"law": "kelvin", "verdict": "pass", "passive": true})";
constexpr auto all_good = R"({"cycles": {"list": [{"good": true}]}, "warnings": []})";

std::vector<FoundResult> everything() {
  return {of_kind(ResultKind::inspection, all_good),
          of_kind(ResultKind::fits, R"({"choice": {"model": "kelvin", "within_jnd": true}})"),
          of_kind(ResultKind::choice, R"({"choice": {"law": "kelvin", "serves": true}})"),
          of_kind(ResultKind::chart, R"({"points": [{"within_jnd": true}, {"within_jnd": false}]})"),
          of_kind(ResultKind::stability, R"({"law": "kelvin", "passive": true})"),
          of_kind(ResultKind::replay,
                  R"({"laws": [{"name": "kelvin", "axes": [{"axis": "z", "rms_jnd": 0.5}]}]})"),
          of_kind(ResultKind::check, passing)};
}

TEST(Summary, IsGreenOnlyIfEveryVerbHasLookedAndAllHolds) {
  std::vector<FoundResult> results = everything();
  EXPECT_THAT(summary_paragraph(results), AllOf(HasSubstr("<p class=\"answer\">"), HasSubstr("chart: 1 of 2"),
                                                Not(HasSubstr("Not known"))));
  results.pop_back();
  EXPECT_THAT(summary_paragraph(results),
              AllOf(HasSubstr("answer partly"), HasSubstr("Not known</strong>: what kerf check would say.")));
}

TEST(Summary, IsRedBesideOneThingThatIsBad) {
  std::vector<FoundResult> results = everything();
  results.back() = of_kind(ResultKind::check, R"({"law": "kelvin", "verdict": "fail", "passive": true})");
  EXPECT_THAT(
      summary_paragraph(results),
      AllOf(HasSubstr("answer bad"), HasSubstr("Does not hold</strong>: closed loop: kelvin fails.")));
}

TEST(Summary, TakesWhatIsOfAnotherRecordingForNothingThatIsKnownOfThisOne) {
  for (const Belongs belongs : {Belongs::elsewhere, Belongs::unknown}) {
    const SummaryLine line = summary_of(of_kind(ResultKind::check, passing, belongs));
    EXPECT_FALSE(line.is_known) << line.text;
    EXPECT_NE(line.answer, Answer::good) << line.text;
  }
}

TEST(Summary, TakesWhatNobodyJudgedForUnknown) {
  EXPECT_FALSE(summary_of(of_kind(ResultKind::fits, R"({"choice": {"model": "kelvin", "within_jnd": null}})"))
                   .is_known);
  EXPECT_FALSE(summary_of(of_kind(ResultKind::choice,
                                  R"({"choice": {"law": "kelvin", "serves": true, "in_doubt": true}})"))
                   .is_known);
  EXPECT_FALSE(summary_of(of_kind(ResultKind::chart, R"({"points": [{"error_jnd": 0.1}]})")).is_known);
  EXPECT_FALSE(summary_of(of_kind(ResultKind::stability, R"({"study": "wall"})")).is_known);
  EXPECT_FALSE(summary_of(of_kind(ResultKind::replay, R"({"laws": []})")).is_known);
}

TEST(Summary, TakesADeviceForWhatItIsThoughItIsOfNoRecording) {
  const auto of_axis = [](const char* good, const char* fits) {
    return summary_of(of_kind(ResultKind::device,
                              fmt::format(R"({{"device": "falcon:0", "good": {},
                                   "axes": [{{"name": "x", "fits": {}, "verdict": "to 2 %"}}]}})",
                                          good, fits)
                                  .c_str(),
                              Belongs::unknown));
  };
  EXPECT_EQ(of_axis("true", "true").answer, Answer::good);
  EXPECT_EQ(of_axis("true", "true").text, "device falcon:0: x: the model fits: to 2 %");
  EXPECT_EQ(of_axis("false", "false").answer, Answer::partly);
  EXPECT_TRUE(of_axis("false", "false").is_known);
  EXPECT_FALSE(of_axis("false", "null").is_known);
}

TEST(Summary, TakesWhatIsOfAnEarlierStateOfTheRecordingForNothingThatIsKnown) {
  for (const ResultState state :
       {ResultState::before_cycles, ResultState::other_cycles, ResultState::other_samples}) {
    FoundResult result = of_kind(ResultKind::fits, R"({"choice": {"model": "kelvin", "within_jnd": true}})");
    result.state = state;
    const SummaryLine line = summary_of(result);
    EXPECT_FALSE(line.is_known);
    EXPECT_EQ(line.answer, Answer::partly);
    EXPECT_THAT(line.text, HasSubstr(": run kerf fit again)"));
  }
}

TEST(Summary, CountsTheCyclesThatTheRecordingHasNow) {
  const FoundResult inspected = of_kind(ResultKind::inspection, all_good);
  EXPECT_TRUE(summary_of(inspected, CycleCount{.good = 1, .all = 1}).is_known);
  const SummaryLine line = summary_of(inspected, CycleCount{.good = 4, .all = 5});
  EXPECT_FALSE(line.is_known);
  EXPECT_THAT(line.text, HasSubstr("1 of 5 cycles flagged now, 0 of 1 when it was inspected"));
}

TEST(Summary, DoesNotKnowOfALawThatWasNeverMetOrFelt) {
  const SummaryLine met = summary_of(of_kind(ResultKind::stability, R"({"law": "kelvin", "passive": null})"));
  EXPECT_FALSE(met.is_known);
  EXPECT_EQ(met.text, "stability: kelvin was never met");
  const SummaryLine felt =
      summary_of(of_kind(ResultKind::check, R"({"law": "kelvin", "verdict": "not known", "passive": true})"));
  EXPECT_FALSE(felt.is_known);
  EXPECT_EQ(felt.text, "closed loop: kelvin was never felt");
}

TEST(Summary, CountsFlagsAndWarningsAlsoWithoutAnyCycle) {
  EXPECT_EQ(
      summary_of(of_kind(ResultKind::inspection, R"({"cycles": null, "warnings": ["clipped"]})")).answer,
      Answer::partly);
  const SummaryLine line = summary_of(of_kind(
      ResultKind::inspection, R"({"cycles": {"list": [{"good": true}, {"good": false}]}, "warnings": []})"));
  EXPECT_EQ(line.answer, Answer::partly);
  EXPECT_EQ(line.text, "the recording: 1 of 2 cycles flagged, 0 warnings");
}

}  // namespace
}  // namespace kerf::bench

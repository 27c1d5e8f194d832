#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/studies/studied.h"
#include "results/study_results.h"
#include "results/study_tables.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using test::five_specimens;
using testing::Contains;
using testing::HasSubstr;

StudyResults study_of(std::vector<DrawerRecording> recordings) {
  StudyResults results;
  results.name = "test";
  results.plan.laws = {"kelvin"};
  results.plan.compare = {"peak"};
  results.recordings = std::move(recordings);
  for (const DrawerRecording& one : results.recordings) results.plan.files.push_back(one.file);
  doubt_recordings(results.recordings);
  form_groups(results);
  conclude(results);
  return results;
}

std::vector<std::string> sentences_of(const StudyResults& results) {
  std::vector<std::string> sentences;
  for (const Conclusion& one : results.conclusions) sentences.push_back(one.sentence);
  return sentences;
}

StudyResults two_tissues() {
  auto recordings = five_specimens("liver", 1.0);
  for (DrawerRecording& one : five_specimens("skin", 2.0)) recordings.push_back(std::move(one));
  return study_of(std::move(recordings));
}

TEST(Conclusions, NameTheLawThatServesAndOfHowManySpecimens) {
  EXPECT_THAT(sentences_of(two_tissues()),
              Contains(HasSubstr(
                  "liver, slow: kelvin serves, with 3 parameters, in each of 5 recordings of 5 specimens")));
}

TEST(StudyResults, TakeOfLawsThatServeAlikeTheSameInWhicheverOrderTheyAreGiven) {
  for (const std::vector<std::string>& laws :
       {std::vector<std::string>{"kelvin", "maxwell"}, std::vector<std::string>{"maxwell", "kelvin"}}) {
    StudyResults results;
    results.plan.laws = laws;
    results.recordings = five_specimens("liver", 1.0);
    for (DrawerRecording& one : results.recordings) {
      one.result.laws.push_back(one.result.laws.front());
      one.result.laws.back().model = "maxwell";
      results.plan.files.push_back(one.file);
    }
    form_groups(results);
    conclude(results);
    EXPECT_EQ(results.groups.at(0).serving, "kelvin");
    EXPECT_EQ(results.law, "kelvin");
  }
}

TEST(StudyResults, CallTheWorkOfAClosingAnEnergyOnlyWhereItIsOne) {
  const auto unit_of_work = [](const StudyResults& results) {
    const auto& quantities = results.groups.at(0).quantities;
    return std::ranges::find(quantities, "work", &StudiedQuantity::name)->unit;
  };
  auto recordings = five_specimens("liver", 1.0);
  EXPECT_EQ(unit_of_work(study_of(recordings)), "J");
  for (DrawerRecording& one : recordings) one.result.position_unit = "rad";
  EXPECT_EQ(unit_of_work(study_of(recordings)), "N·rad");
}

// Five against five specimens that do not overlap: 2 of the 252 ways to deal them out are as far apart, and
// by Welch's t no further ones. Their ratio is 2, since every specimen of one is twice one of the other.
TEST(Conclusions, SayThatTissuesDifferWithTheirRatio) {
  const StudyResults results = two_tissues();
  ASSERT_EQ(results.comparisons.size(), 1U);
  const population::Comparison& found = results.comparisons[0].found;
  EXPECT_EQ(found.verdict, population::Verdict::differ);
  EXPECT_NEAR(found.test->p, 2.0 / 252.0, 1e-12);
  EXPECT_NEAR(std::exp(*found.difference), 0.5, 1e-12);
  EXPECT_THAT(sentences_of(results),
              Contains(HasSubstr("liver, slow and skin, slow: differ (n = 5 and 5; ratio 0.5")));
}

// Geometric mean and Student's interval of five equal errors: that of a t test of logarithms.
// A force at a depth that each recording has of its own is another force in each.
TEST(Conclusions, CompareNoParametersThatAreOfAnotherQuantityInEachRecording) {
  const auto with_depths = [](double of_liver, double of_skin) {
    auto recordings = five_specimens("liver", 1.0);
    for (DrawerRecording& one : five_specimens("skin", 2.0)) recordings.push_back(std::move(one));
    for (DrawerRecording& one : recordings) {
      one.result.laws[0].taken_from_it["reference_depth"] = one.file.tissue == "liver" ? of_liver : of_skin;
    }
    return study_of(std::move(recordings));
  };
  const auto stiffness = [](const StudyResults& results) {
    return std::ranges::count(results.groups.at(0).quantities, "kelvin.parallel_stiffness",
                              &StudiedQuantity::name);
  };
  EXPECT_EQ(stiffness(with_depths(0.01, 0.01)), 1);
  EXPECT_THAT(sentences_of(with_depths(0.01, 0.01)), testing::Not(Contains(HasSubstr("reference_depth"))));
  EXPECT_EQ(stiffness(with_depths(0.01, 0.006)), 0);
  EXPECT_THAT(sentences_of(with_depths(0.01, 0.006)),
              Contains(HasSubstr("law_options = [\"reference_depth=0.006\"] in study.toml makes them so")));
}

TEST(Conclusions, TakeMeansOverSpecimens) {
  const StudyResults results = two_tissues();
  const auto& quantities = results.groups[0].quantities;
  const auto stiffness = std::ranges::find(quantities, "kelvin.parallel_stiffness", &StudiedQuantity::name);
  ASSERT_NE(stiffness, quantities.end());
  EXPECT_TRUE(stiffness->is_logarithm);
  double sum = 0.0;
  for (int i = 0; i < 5; ++i) sum += std::log(100.0 * (1.0 + 0.03 * i));
  EXPECT_NEAR(*stiffness->estimate.mean, sum / 5.0, 1e-9);
  EXPECT_EQ(stiffness->estimate.specimens, 5U);
}

TEST(Conclusions, OfOneRecordingAlonePretendNothing) {
  const StudyResults results =
      study_of({test::studied({.name = "a", .tissue = "liver"}),
                test::studied({.name = "b", .tissue = "skin", .held_out_jnd = 3.0})});
  const auto sentences = sentences_of(results);
  EXPECT_THAT(sentences, Contains(HasSubstr("1 of 1 comparisons cannot be told")));
  EXPECT_THAT(sentences,
              Contains(HasSubstr("cannot be told where there is one alone: liver, slow; skin, slow")));
  EXPECT_THAT(sentences, Contains(HasSubstr("skin, slow: no law serves in any of 1 recording")));
  EXPECT_FALSE(results.groups[0].quantities[0].estimate.interval.has_value());
}

TEST(Conclusions, LeaveADoubtedRecordingOutAndSayWhy) {
  auto recordings = five_specimens("liver", 1.0);
  recordings[2].result.travel *= 1000.0;
  const StudyResults results = study_of(std::move(recordings));
  EXPECT_EQ(results.groups[0].counted.size(), 4U);
  EXPECT_EQ(results.groups[0].left_out, 1U);
  EXPECT_THAT(sentences_of(results),
              Contains(testing::AllOf(HasSubstr("liver2.txt"), HasSubstr("mm taken for m"),
                                      HasSubstr("it is left out"))));
}

TEST(Conclusions, NameCyclesThatWereLeftOutAndAClippedSensor) {
  auto recordings = five_specimens("liver", 1.0);
  recordings[0].result.cycles[1].is_good = false;
  recordings[0].result.cycles[1].reason = "the tool was put down";
  recordings[1].result.clipped_at = 7.355;
  recordings[1].result.clipped_rows = 99;
  const auto sentences = sentences_of(study_of(std::move(recordings)));
  EXPECT_THAT(sentences, Contains("liver0: 1 of 2 cycles are left out; cycle 2: the tool was put down."));
  EXPECT_THAT(sentences, Contains("liver1: the sensor is clipped at 7.355 N in 99 rows."));
}

TEST(StudyTables, HaveADictionaryOfEveryColumn) {
  const test::TemporaryFolder folder;
  write_study_tables(two_tissues(), folder.path());
  const std::string dictionary = test::read_text(folder / "data_dictionary.csv");
  for (const std::string table :
       {"recordings", "cycles", "parameters", "groups", "held_out", "comparisons"}) {
    const std::string text = test::read_text(folder / (table + ".csv"));
    std::istringstream header(text.substr(0, text.find('\n')));
    for (std::string column; std::getline(header, column, ',');)
      EXPECT_THAT(dictionary, HasSubstr("\n" + table + "," + column + ",")) << table;
  }
  EXPECT_THAT(test::read_text(folder / "parameters.csv"),
              HasSubstr("liver0,kelvin,parallel_stiffness,100,1,N/m\n"));
}

TEST(StudiedRecordingJson, IsReadAsItWasWritten) {
  const StudiedRecording one = test::studied({.name = "a"}).result;
  EXPECT_EQ(as_json(studied_recording(as_json(one))), as_json(one));
  EXPECT_TRUE(std::isnan(studied_recording(as_json(one)).clipped_at));
}

}  // namespace
}  // namespace kerf::bench

#include "answers/estimates/estimates.h"

#include <cmath>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "answer_pages/analysis_json.h"
#include "answer_pages/analysis_page.h"
#include "answers/analysis.h"
#include "answers/answers_table.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A subject's number for a sample.
void add_number(Study& study, const std::string& subject, std::size_t sample, double number,
                double intensity = std::numeric_limits<double>::quiet_NaN()) {
  study.judgements.push_back(
      {.subject = subject, .pair = {sample, sample}, .estimate = number, .intensity = intensity});
}

Study numbers_of(Design design) {
  return {.name = "made up", .design = design, .samples = {"soft", "middle", "stiff"}, .judgements = {}};
}

/// Of five subjects with numbers of their own size.
Study five_magnitudes() {
  Study study = numbers_of(Design::magnitude);
  const std::vector<std::array<double, 3>> numbers{
      {10, 14, 22}, {1, 1.6, 1.9}, {50, 60, 110}, {5, 8, 9}, {100, 130, 260}};
  const std::array<double, 3> forces{1.0, 1.7, 3.0};
  for (std::size_t subject = 0; subject < numbers.size(); ++subject) {
    for (std::size_t sample = 0; sample < 3; ++sample)
      add_number(study, "S" + std::to_string(subject), sample, numbers[subject][sample], forces[sample]);
  }
  return study;
}

// R 4.2.2: m <- log(matrix(c(10,14,22, 1,1.6,1.9, 50,60,110, 5,8,9, 100,130,260), ncol = 3, byrow = TRUE));
// t.test(m[,2] - m[,1]) and so on, exp() of means and intervals; p.adjust(p, "holm");
// e <- apply(m, 1, function(y) coef(lm(y ~ log(c(1, 1.7, 3))))[2]); t.test(e, mu = 1);
// g <- exp(colMeans(m - rowMeans(m)))
TEST(Estimates, OfMagnitudesAgreeWithR) {
  const Analysis analysis = analyse(five_magnitudes());
  ASSERT_TRUE(analysis.estimates);
  const EstimatedTissue& tissue = analysis.estimates->tissues.front();
  EXPECT_EQ(tissue.subjects, 5U);
  EXPECT_NEAR(tissue.samples[0].value, 0.69381577874057, 1e-12);
  EXPECT_NEAR(tissue.samples[2].value, 1.472357033977318, 1e-12);
  EXPECT_NEAR(tissue.samples[2].interval.lower, 1.249865845291936, 1e-11);
  EXPECT_NEAR(tissue.samples[2].interval.upper, 1.734454336574127, 1e-11);
  EXPECT_NEAR(tissue.pairs[0].apart, 1.410907427897096, 1e-12);
  EXPECT_NEAR(tissue.pairs[0].interval.lower, 1.204929860555089, 1e-11);
  EXPECT_NEAR(tissue.pairs[0].interval.upper, 1.65209597277151, 1e-11);
  EXPECT_NEAR(tissue.pairs[0].p, 0.003751938885833092, 1e-13);
  EXPECT_NEAR(tissue.pairs[0].p_adjusted, 0.007503877771666183, 1e-13);
  EXPECT_NEAR(tissue.pairs[2].p_adjusted, 0.02352415663621016, 1e-13);
  EXPECT_NEAR(analysis.p_value, 0.0009254903784880243, 1e-13);
  ASSERT_TRUE(analysis.estimates->law && analysis.estimates->law->mean);
  EXPECT_NEAR(analysis.estimates->law->mean->mean, 0.6852717745058237, 1e-12);
  EXPECT_NEAR(analysis.estimates->law->mean->interval.lower, 0.5179547742669304, 1e-11);
  EXPECT_NEAR(analysis.estimates->law->p_of_one, 0.006416158382256801, 1e-13);
  EXPECT_THAT(analysis.shows, Contains(HasSubstr("Stevens' power law")));
}

TEST(Estimates, OfMagnitudesDoNotHangOnTheSizeOfAnybodysNumbers) {
  Study larger = five_magnitudes();
  for (Judgement& each : larger.judgements) {
    if (each.subject == "S1") each.estimate *= 1000.0;
  }
  const Analysis one = analyse(five_magnitudes());
  const Analysis other = analyse(larger);
  EXPECT_NEAR(one.p_value, other.p_value, 1e-12);
  EXPECT_NEAR(one.estimates->tissues[0].samples[1].value, other.estimates->tissues[0].samples[1].value,
              1e-12);
}

TEST(Estimates, OfMagnitudesWithAModulusAreTimesTheStandard) {
  Study study = five_magnitudes();
  study.numbers.modulus = 10.0;
  const Analysis analysis = analyse(study);
  // exp of the mean of ln(number / 10): the fifth root of 10 x 1 x 50 x 5 x 100 / 10^5.
  EXPECT_NEAR(analysis.estimates->tissues[0].samples[0].value, std::pow(2.5, 0.2), 1e-12);
}

TEST(Estimates, OfLevelsTestTheExponentAgainstOne) {
  Study study = numbers_of(Design::magnitude);
  for (const auto& [subject, exponent] : {std::pair{"A", 0.5}, {"B", 0.6}, {"C", 0.7}}) {
    for (const double level : {-0.5, 0.0, 1.0, 3.0})
      study.judgements.push_back({.subject = subject,
                                  .level = level,
                                  .estimate = 7.0 * std::pow(1.0 + level, exponent),
                                  .intensity = 1.0 + level});
  }
  const Analysis analysis = analyse(study);
  ASSERT_TRUE(analysis.estimates->law && analysis.estimates->law->mean);
  EXPECT_TRUE(analysis.estimates->law->of_levels);
  EXPECT_NEAR(analysis.estimates->law->exponents[2].second, 0.7, 1e-12);
  EXPECT_NEAR(analysis.estimates->law->mean->mean, 0.6, 1e-12);
  // t = (0.6 - 1) / (0.1 / sqrt 3) of 2 degrees of freedom; R: 2 * pt(-0.4 * sqrt(3) / 0.1, 2)
  EXPECT_NEAR(analysis.p_value, 0.02020410288672876, 1e-12);
  EXPECT_THAT(analysis.main_test, HasSubstr("exponents against 1"));
}

/// The eight subjects of repeated_measures_test.cpp, on a line of 0 to 100.
Study eight_ratings() {
  Study study = numbers_of(Design::rating);
  const std::vector<std::array<double, 3>> numbers{{61, 72, 79}, {30, 41, 41}, {55, 50, 68}, {22, 39, 30},
                                                   {70, 70, 85}, {44, 60, 59}, {10, 25, 25}, {80, 75, 91}};
  for (std::size_t subject = 0; subject < numbers.size(); ++subject) {
    for (std::size_t sample = 0; sample < 3; ++sample) {
      // Twice, about their mean.
      add_number(study, "S" + std::to_string(subject), sample, numbers[subject][sample] - 4.0);
      add_number(study, "S" + std::to_string(subject), sample, numbers[subject][sample] + 4.0);
    }
  }
  return study;
}

TEST(Estimates, OfRatingsTestSubjectsMeansByFriedman) {
  const Analysis analysis = analyse(eight_ratings());
  const EstimatedTissue& tissue = analysis.estimates->tissues.front();
  ASSERT_TRUE(tissue.friedman);
  EXPECT_NEAR(tissue.friedman->statistic, 7.6551724137931, 1e-12);  // R: see repeated_measures_test.cpp
  EXPECT_NEAR(analysis.p_value, 0.0217620814456727, 1e-14);
  EXPECT_NEAR(tissue.pairs[1].apart, 13.25, 1e-12);
  EXPECT_NEAR(tissue.pairs[1].interval.lower, 10.6157285309792, 1e-11);
  EXPECT_EQ(tissue.pairs[1].p, 2.0 / 256.0);  // all eight differences above 0
  EXPECT_EQ(tissue.samples[0].answers, 16U);
}

TEST(Estimates, OfRatingsLeaveOutWhoMissedASample) {
  Study study = eight_ratings();
  add_number(study, "late", 0, 50.0);
  const Analysis analysis = analyse(study);
  EXPECT_EQ(analysis.estimates->tissues[0].left_out, 1U);
  EXPECT_NEAR(analysis.p_value, 0.0217620814456727, 1e-14);
  EXPECT_THAT(analysis.warnings, Contains(HasSubstr("did not answer about every sample")));
}

TEST(Estimates, OfOneSubjectAreNoTestOfPeople) {
  Study study = numbers_of(Design::rating);
  for (const std::size_t sample : {0U, 1U, 2U})
    add_number(study, "S0", sample, 10.0 * static_cast<double>(sample));
  const Analysis analysis = analyse(study);
  EXPECT_TRUE(std::isnan(analysis.p_value));
  EXPECT_THAT(analysis.main_test, HasSubstr("no test of people"));
}

TEST(Estimates, RefuseWhatIsNoAnswer) {
  Study study = numbers_of(Design::magnitude);
  add_number(study, "S0", 0, 0.0);
  EXPECT_THAT([&] { (void)analyse(study); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("expected a number above 0")));
  study = numbers_of(Design::rating);
  study.numbers.points = 7;
  add_number(study, "S0", 0, 8.0);
  EXPECT_THAT([&] { (void)analyse(study); }, ThrowsMessage<std::invalid_argument>(HasSubstr("from 1 to 7")));
}

TEST(Estimates, ComeBackFromTheirTable) {
  for (Study study : {five_magnitudes(), eight_ratings()}) {
    if (study.design == Design::magnitude) study.numbers.modulus = 10.0;
    const Analysis before = analyse(study);
    const Analysis after = analyse(parse_answers(answers_csv(study), "answers.csv"));
    EXPECT_EQ(after.p_value, before.p_value);
    EXPECT_EQ(after.estimates->tissues[0].samples[1].value, before.estimates->tissues[0].samples[1].value);
    EXPECT_EQ(after.estimates->law.has_value(), before.estimates->law.has_value());
  }
  const std::string head = "# design = \"rating\"\n# points = 7\nsubject,second,estimate\n";
  EXPECT_THAT([&] { (void)parse_answers(head + "S1,soft,9\n", "a.csv"); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("a.csv:4: 'estimate' is '9', expected a number from 1 to 7")));
  EXPECT_THAT([&] { (void)parse_answers("# design = \"magnitude\"\nsubject,estimate\nS1,9\n", "a.csv"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no column 'second'")));
}

TEST(Estimates, StandInJsonAndOnThePage) {
  const Analysis analysis = analyse(five_magnitudes());
  const nlohmann::ordered_json json = analysis_as_json(analysis);
  EXPECT_EQ(json["estimates"]["of"], "magnitudes");
  EXPECT_EQ(json["estimates"]["tissues"][0]["pairs"].size(), 3U);
  EXPECT_EQ(json["estimates"]["power_law"]["by_subject"].size(), 5U);
  EXPECT_EQ(json["corrections"]["families"][0]["tests"], 3);
  EXPECT_THAT(analysis_page(analysis, {}), HasSubstr("<h2>Magnitudes</h2>"));
  EXPECT_THAT(analysis_page(analyse(eight_ratings()), {}), HasSubstr("Friedman"));
  EXPECT_THAT(summary_lines(analysis), Contains(HasSubstr("Stevens' power law: exponent")));
}

}  // namespace
}  // namespace kerf::bench

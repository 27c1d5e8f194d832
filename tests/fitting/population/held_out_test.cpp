#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <kerf/population/held_out.h>

namespace kerf::population {
namespace {

std::vector<HeldOutError> errors(std::initializer_list<double> values, bool has_specimens) {
  std::vector<HeldOutError> all;
  for (const double value : values) {
    HeldOutError one{.recording = std::to_string(all.size()), .specimen = {}, .error = value};
    if (has_specimens) one.specimen = std::to_string(all.size() / 2);
    all.push_back(one);
  }
  return all;
}

Comparison which(const LawPair& pair) { return better(std::vector{pair}).front(); }

TEST(HeldOut, SummarisesBySpecimen) {
  const GroupEstimate group = summarise(errors({0.1, 0.12, 0.2, 0.22, 0.15, 0.17}, true));
  EXPECT_EQ(group.specimens, 3U);
  EXPECT_NEAR(*group.mean, 0.16, 1e-9);
  EXPECT_NEAR(std::pow(group.between_recordings->value, 2), 2e-4, 1e-9);
}

TEST(HeldOut, LeavesOutWhereALawFailed) {
  const GroupEstimate group = summarise(errors({0.1, 0.12, INFINITY, 0.2}, true));
  EXPECT_EQ(group.left_out, 1U);
  EXPECT_EQ(group.recordings, 3U);
}

TEST(Better, PairsByRecording) {
  // Recordings differ far more than laws do.
  const LawPair pair{errors({1.0, 5.0, 2.0, 9.0, 4.0, 7.0, 3.0}, false),
                     errors({1.1, 5.2, 2.1, 9.3, 4.1, 7.2, 3.2}, false)};
  const Comparison one = which(pair);
  EXPECT_NEAR(one.test->p, 2.0 / 128.0, 1e-12);
  EXPECT_EQ(one.verdict, Verdict::differ);
  EXPECT_LT(one.interval->upper, 0.0) << "the first has the smaller errors";
}

TEST(Better, ExchangesLawsInWholeSpecimens) {
  const Comparison one = which({errors({1, 5, 2, 9, 4, 7}, true), errors({2, 6, 3, 10, 5, 8}, true)});
  EXPECT_EQ(one.first_units, 3U);
  EXPECT_NEAR(one.test->least_p, 0.25, 1e-12);
  EXPECT_EQ(one.verdict, Verdict::cannot_be_told);
}

TEST(Better, CountsWhatHasNoPartner) {
  LawPair pair{errors({1, 5, 2, 9}, false), errors({2, 6, NAN, 10}, false)};
  pair.first.push_back({.recording = "alone", .specimen = {}, .error = 1.0});
  const Comparison one = which(pair);
  EXPECT_EQ(one.first_units, 3U);
  EXPECT_EQ(one.left_out, 3U);
  EXPECT_FALSE(which({}).test);
}

TEST(Better, RefusesTwoErrorsOfOneRecording) {
  LawPair pair{errors({1, 5}, false), errors({2, 6}, false)};
  pair.second.push_back(pair.second.front());
  EXPECT_THROW((void)which(pair), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::population

#include "prepare/bias.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A force of 0.3 N - 0.12 N/min that meets 5 N between 4 and 6 s, at 100 Hz for 10 s.
struct Drifting {
  schema::Recording recording;
  std::vector<bool> free;
  std::vector<double> contact;

  explicit Drifting(double noise = 0.0, unsigned seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    recording.axes = {{}};
    for (int i = 0; i <= 1000; ++i) {
      const double t = 0.01 * i;
      contact.push_back(t > 4.0 && t < 6.0 ? 5.0 : 0.0);
      free.push_back(contact.back() == 0.0);
      recording.time.push_back(t);
      recording.force_measured.push_back(0.3 - 0.002 * t + contact.back() + noise * normal(random));
    }
  }
};

TEST(Bias, AndDriftAreTakenOffExactly) {
  Drifting made;
  const Bias bias = remove_bias(made.recording, made.free, true);
  ASSERT_EQ(bias.axes.size(), 1U);
  EXPECT_NEAR(bias.axes[0].offset, 0.3, 1e-12);
  EXPECT_NEAR(bias.axes[0].drift_per_minute, -0.12, 1e-11);
  for (std::size_t i = 0; i < made.contact.size(); ++i) {
    EXPECT_NEAR(made.recording.force_measured[i], made.contact[i], 1e-12) << "row " << i;
  }
}

TEST(Bias, WithoutDriftIsTheMeanOfTheFreeRows) {
  Drifting made;
  const Bias bias = remove_bias(made.recording, made.free, false);
  EXPECT_NEAR(bias.axes[0].offset, 0.3 - 0.002 * 5.0, 1e-12) << "the free rows lie about the middle";
  EXPECT_EQ(bias.axes[0].drift_per_minute, 0.0);
}

TEST(Bias, LiesWithinItsStandardErrorsAsOftenAsItShould) {
  int offsets = 0;
  int drifts = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    Drifting made(0.05, seed);
    const AxisBias bias = remove_bias(made.recording, made.free, true).axes[0];
    offsets += std::abs(bias.offset - 0.3) < 1.96 * bias.offset_error ? 1 : 0;
    drifts += std::abs(bias.drift_per_minute + 0.12) < 1.96 * bias.drift_per_minute_error ? 1 : 0;
  }
  EXPECT_NEAR(offsets / 400.0, 0.95, 0.03);
  EXPECT_NEAR(drifts / 400.0, 0.95, 0.03);
}

TEST(Bias, OfCorrelatedNoiseIsLessCertain) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> noise{0.0};
  for (int i = 0; i < 200'000; ++i) noise.push_back(0.8 * noise.back() + normal(random));
  EXPECT_NEAR(rows_that_count_as_one(noise), 1.8 / 0.2, 0.3);
}

TEST(Bias, DriftNeedsFreeRowsAtBothEnds) {
  Drifting made;
  for (std::size_t i = 700; i < made.free.size(); ++i) made.free[i] = false;
  EXPECT_THAT([&] { (void)remove_bias(made.recording, made.free, true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("0 in the last")));
  EXPECT_NO_THROW((void)remove_bias(made.recording, made.free, false));
}

TEST(Bias, DriftOfWhatBeganInContactIsRefusedToo) {
  Drifting made;
  for (std::size_t i = 0; i < 400; ++i) made.free[i] = false;
  EXPECT_THAT([&] { (void)remove_bias(made.recording, made.free, true); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("0 rows in the first quarter of the time were found to be free")));
}

TEST(Bias, NeedsFreeRowsAndAMeasuredForce) {
  Drifting made;
  EXPECT_THAT([&] { (void)remove_bias(made.recording, std::vector<bool>(1001, false), false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("0 rows are free")));
  made.recording.force_commanded.swap(made.recording.force_measured);
  EXPECT_THAT([&] { (void)remove_bias(made.recording, made.free, false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no measured force")));
}

}  // namespace
}  // namespace kerf::bench

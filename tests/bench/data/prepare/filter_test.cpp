#include "prepare/filter.h"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double rate_hz = 1000.0;
const std::vector<std::string> all{"butterworth2:20", "butterworth4:20",  "critically-damped:20",
                                   "first-order:20",  "moving-mean:0.02", "savitzky-golay:0.02"};

double decibel(double gain) { return 20.0 * std::log10(gain); }

/// Gain and phase that a sine of whole periods has after the filter, away from the ends.
std::complex<double> measured(const SampledFilter& filter, double frequency_hz) {
  std::vector<double> sine;
  for (int i = 0; i < 6000; ++i) {
    sine.push_back(std::sin(2.0 * std::numbers::pi * frequency_hz * i / rate_hz));
  }
  const auto out = filter.run(sine);
  std::complex<double> sum = 0.0;
  for (int i = 3000; i < 5000; ++i) {
    const double angle = 2.0 * std::numbers::pi * frequency_hz * i / rate_hz;
    sum += out[static_cast<std::size_t>(i)] * std::complex<double>(std::sin(angle), std::cos(angle));
  }
  return sum / 1000.0;
}

TEST(Filter, HasThreeDecibelsAtTheCornerCausalAndSixForwardAndBackward) {
  for (const char* text : {"butterworth2:20", "butterworth4:20", "critically-damped:20", "first-order:20"}) {
    const std::vector<double> corner{20.0};
    const auto causal = SampledFilter(parse_filter(text, true), rate_hz).response(corner)[0];
    const auto zero_phase = SampledFilter(parse_filter(text, false), rate_hz).response(corner)[0];
    EXPECT_NEAR(decibel(causal.gain), -10.0 * std::log10(2.0), text[0] == 'c' ? 0.02 : 1e-9) << text;
    EXPECT_NEAR(decibel(zero_phase.gain), 2.0 * decibel(causal.gain), 1e-9) << text;
    EXPECT_EQ(zero_phase.phase_deg, 0.0) << text;
  }
  const std::vector<double> corner{20.0};
  EXPECT_NEAR(SampledFilter(parse_filter("first-order:20", true), rate_hz).response(corner)[0].phase_deg,
              -45.0, 1e-6);
  EXPECT_NEAR(SampledFilter(parse_filter("butterworth2:20", true), rate_hz).response(corner)[0].phase_deg,
              -90.0, 1e-6);
  EXPECT_NEAR(SampledFilter(parse_filter("butterworth4:20", true), rate_hz).response(corner)[0].phase_deg,
              -180.0, 1e-6);
}

TEST(Filter, DoesToASineWhatItSays) {
  for (const std::string& text : all) {
    for (const bool causal : {true, false}) {
      const SampledFilter filter(parse_filter(text, causal), rate_hz);
      for (const double frequency_hz : {2.0, 10.0, 40.0}) {
        const Response told = filter.response(std::vector<double>{frequency_hz})[0];
        const std::complex<double> found = measured(filter, frequency_hz);
        EXPECT_NEAR(std::abs(found), told.gain, 1e-6) << text << " " << frequency_hz << " Hz";
        const double apart = std::arg(found) - told.phase_deg * std::numbers::pi / 180.0;
        EXPECT_NEAR(std::remainder(apart, 2.0 * std::numbers::pi), 0.0, 1e-6)
            << text << " " << frequency_hz << " Hz";
        if (!causal) {
          EXPECT_EQ(told.delay_ms, 0.0);
        }
      }
    }
  }
}

TEST(Filter, DelaysAMeanByHalfItsWindow) {
  const SampledFilter filter(parse_filter("moving-mean:21ms", true), rate_hz);
  const auto responses = filter.response(std::vector<double>{1.0, 10.0, 40.0});
  for (const Response& response : responses) EXPECT_NEAR(response.delay_ms, 10.0, 1e-6);
}

TEST(Filter, KeepsAStraightLine) {
  for (const std::string& text : all) {
    std::vector<double> line;
    for (int i = 0; i < 500; ++i) line.push_back(2.0 + 0.01 * i);
    const auto out = SampledFilter(parse_filter(text, false), rate_hz).run(line);
    for (std::size_t i = 0; i < line.size(); ++i) {
      EXPECT_NEAR(out[i], line[i], text == "first-order:20" ? 0.01 : 1e-4) << text << " " << i;
    }
  }
}

TEST(Filter, LeavesTheSeamOfAGapAlone) {
  schema::Recording recording;
  recording.axes = {{}};
  for (int i = 0; i < 400; ++i) {
    recording.time.push_back(1e-3 * i + (i < 200 ? 0.0 : 5.0));
    recording.force_measured.push_back(i < 200 ? 1.0 : 3.0);
  }
  const FilterReport report = apply_filter(recording, parse_filter("butterworth2:10", false), false);
  EXPECT_EQ(report.stretches, 2U);
  EXPECT_NEAR(recording.force_measured[199], 1.0, 1e-12);
  EXPECT_NEAR(recording.force_measured[200], 3.0, 1e-12);
}

TEST(Filter, ReadsUnitsAndRefusesWhatItIsNot) {
  EXPECT_NEAR(parse_filter("first-order:10rad/s", true).corner_hz, 10.0 / (2.0 * std::numbers::pi), 1e-12);
  EXPECT_NEAR(parse_filter("savitzky-golay:20ms", false).window_s, 0.02, 1e-15);
  for (const char* text : {"", "butterworth3:20", "butterworth2", "butterworth2:", "butterworth2:-1",
                           "butterworth2:20s", "moving-mean:20Hz", "butterworth2:inf", "butterworth2:20x"}) {
    EXPECT_THAT([&] { (void)parse_filter(text, false); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("is no filter")))
        << text;
  }
  EXPECT_THROW(SampledFilter(parse_filter("butterworth2:500", false), rate_hz), std::invalid_argument);
  EXPECT_THROW(SampledFilter(parse_filter("moving-mean:1ms", false), rate_hz), std::invalid_argument);
  schema::Recording recording;
  recording.axes = {{}};
  recording.time = {0.0, 0.01, 0.02};
  recording.force_measured = {1.0, std::numeric_limits<double>::quiet_NaN(), 1.0};
  EXPECT_THAT([&] { (void)apply_filter(recording, parse_filter("butterworth2:10", false), false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("--drop-gaps")));
}

}  // namespace
}  // namespace kerf::bench

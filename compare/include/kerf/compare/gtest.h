#pragma once

#include <gtest/gtest.h>

#include <kerf/compare/expect.h>

namespace kerf::compare {

/// What EXPECT_FORCES_WITHIN_JND asserts.
[[nodiscard]] inline testing::AssertionResult forces_within_jnd(std::span<const double> expected,
                                                                std::span<const double> got, double jnds,
                                                                double rate_hz = 1000.0,
                                                                std::string_view unit = "N") {
  const TestResult result = within_jnd(expected, got, jnds, rate_hz, unit);
  return result ? testing::AssertionSuccess() : testing::AssertionFailure() << result.why;
}

}  // namespace kerf::compare

/// EXPECT_FORCES_WITHIN_JND(expected, got, jnds [, rate_hz [, unit]]): forces [N] at 1 kHz unless said
/// otherwise, tick by tick within so many JNDs, and no vibration between them that a hand could feel.
#define EXPECT_FORCES_WITHIN_JND(...) EXPECT_TRUE(::kerf::compare::forces_within_jnd(__VA_ARGS__))
#define ASSERT_FORCES_WITHIN_JND(...) ASSERT_TRUE(::kerf::compare::forces_within_jnd(__VA_ARGS__))

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/compare/compare.h>

namespace kerf::compare {

/// Forces of one channel, as a test has them.
struct ForcesOfTest {
  std::span<const double> value;
  double rate_hz = 1000.0;
  std::string_view unit = "N";  ///< or "N·m"
};

/// Why forces are not those expected: each reason in a line, then what changed. Empty if they are. For tests
/// of any framework, or of none: `REQUIRE(why_forces_differ(...) == "")`.
[[nodiscard]] std::string why_forces_differ(const Series& expected, const Series& got,
                                            const Tolerance& tolerance);

/// The same of one channel, within so many JNDs, without vibration that a hand could feel.
[[nodiscard]] std::string why_forces_differ(const ForcesOfTest& expected, std::span<const double> got,
                                            double jnds);

/// What a test of forces comes to: `if (const auto as_it_was = within_jnd(...); !as_it_was)
/// fail(as_it_was.why);`
struct TestResult {
  std::string why;  ///< they are not as expected; empty if they are
  explicit operator bool() const noexcept { return why.empty(); }
};
[[nodiscard]] inline TestResult within_jnd(std::span<const double> expected, std::span<const double> got,
                                           double jnds, double rate_hz = 1000.0,
                                           std::string_view unit = "N") {
  return {why_forces_differ({.value = expected, .rate_hz = rate_hz, .unit = unit}, got, jnds)};
}

}  // namespace kerf::compare

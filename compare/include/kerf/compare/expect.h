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

}  // namespace kerf::compare

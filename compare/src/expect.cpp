#include "kerf/compare/expect.h"

#include "kerf/compare/diagnose.h"

namespace kerf::compare {

std::string why_forces_differ(const Series& expected, const Series& got, const Tolerance& tolerance) {
  require_sound(expected, "expected");
  require_sound(got, "got");
  const Comparison comparison = compare_with_gaps(expected, got, tolerance);
  if (comparison.passed) return "";
  std::string text;
  for (const std::string& message : comparison.messages) text += message + '\n';
  if (comparison.channels.empty()) return text;
  for (const std::string& line : sentences_of(diagnose(expected, got), expected)) text += line + '\n';
  return text;
}

std::string why_forces_differ(const ForcesOfTest& expected, std::span<const double> got, double jnds) {
  const auto series = [&](std::span<const double> values) {
    return Series{.period_s = 1.0 / expected.rate_hz,
                  .channels = {{.name = "force",
                                .unit = std::string(expected.unit),
                                .value = std::vector<double>(values.begin(), values.end())}}};
  };
  return why_forces_differ(series(expected.value), series(got), {.jnd = jnds});
}

}  // namespace kerf::compare

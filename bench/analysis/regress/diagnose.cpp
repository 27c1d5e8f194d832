#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/core.h>

#include "regress/compare.h"

namespace kerf::bench {
namespace {

constexpr double alike = 1e-3;  ///< what is left of a difference, relative to the force, once it is explained

double square(double x) { return x * x; }

struct Scale {
  double factor;
  const char* meaning;
};
constexpr double degrees_per_radian = 180.0 / std::numbers::pi;
constexpr std::array scales{
    Scale{degrees_per_radian, "180/pi: degrees where radians are meant"},
    Scale{1.0 / degrees_per_radian, "pi/180: radians where degrees are meant"},
    Scale{1000.0, "a thousand: one of m and mm, s and ms, or N and mN"},
    Scale{0.001, "a thousandth: one of mm and m, ms and s, or mN and N"},
    Scale{9.80665e-3, "one of gf and N"},
    Scale{1.0 / 9.80665e-3, "one of N and gf"},
};

/// The stored forces from a row on, beside those of now from another row on.
struct Pairs {
  const std::vector<double>& expected;
  const std::vector<double>& got;
  std::size_t columns;
  std::size_t expected_from = 0;  ///< row
  std::size_t got_from = 0;

  [[nodiscard]] std::size_t count() const {
    const std::size_t left = expected.size() - std::min(expected.size(), columns * expected_from);
    return std::min(left, got.size() - std::min(got.size(), columns * got_from));
  }
  [[nodiscard]] double expected_at(std::size_t i) const { return expected[columns * expected_from + i]; }
  [[nodiscard]] double got_at(std::size_t i) const { return got[columns * got_from + i]; }

  /// Root mean square of got - factor expected, relative to that of factor expected.
  [[nodiscard]] double residual(double factor) const {
    double left = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; i < count(); ++i) {
      left += square(got_at(i) - factor * expected_at(i));
      all += square(factor * expected_at(i));
    }
    return all > 0.0 ? std::sqrt(left / all) : std::numeric_limits<double>::infinity();
  }
};

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

std::string scale_in_words(double factor) {
  if (std::abs(factor + 1.0) < alike) return "the force has the other sign";
  std::string text = fmt::format("the force is {:.4g} times the stored one in every tick", factor);
  for (const Scale& scale : scales) {
    if (std::abs(std::abs(factor) / scale.factor - 1.0) < alike) text += fmt::format(", {}", scale.meaning);
  }
  return text;
}

void find_scale(const Pairs& pairs, std::vector<std::string>& found) {
  double cross = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < pairs.count(); ++i) {
    cross += pairs.got_at(i) * pairs.expected_at(i);
    all += square(pairs.expected_at(i));
  }
  if (!(all > 0.0)) return;
  const double factor = cross / all;
  if (std::abs(factor - 1.0) < alike || !(pairs.residual(factor) < alike)) return;
  found.push_back(scale_in_words(factor));
}

/// Whether the force is that of some ticks before or after.
void find_shift(Pairs pairs, std::vector<std::string>& found) {
  constexpr std::size_t max_ticks = 5;
  const double straight = pairs.residual(1.0);
  for (std::size_t ticks = 1; ticks <= max_ticks; ++ticks) {
    for (const bool late : {true, false}) {
      pairs.expected_from = late ? 0 : ticks;
      pairs.got_from = late ? ticks : 0;
      if (!(pairs.residual(1.0) < alike * straight)) continue;
      found.push_back(fmt::format("the force is that of {} tick{} {}", ticks, ticks > 1 ? "s" : "",
                                  late ? "before" : "after"));
      return;
    }
  }
}

/// From where on samples are missing, or were put in.
void find_gap(Pairs pairs, std::size_t expected_rows, std::size_t got_rows, std::vector<std::string>& found) {
  std::size_t first = 0;
  const std::size_t common = std::min(expected_rows, got_rows) * pairs.columns;
  while (first < common && pairs.expected[first] == pairs.got[first]) ++first;
  const std::size_t row = first / pairs.columns;
  if (first == common) {
    found.emplace_back(got_rows < expected_rows ? "what is there is the same: the end is missing"
                                                : "what is stored is the same: there is more after it");
    return;
  }
  pairs.expected_from = row + (got_rows < expected_rows ? expected_rows - got_rows : 0);
  pairs.got_from = row + (got_rows < expected_rows ? 0 : got_rows - expected_rows);
  const bool resumes = pairs.residual(1.0) < 10.0 * alike;
  found.push_back(fmt::format("the first tick that differs is {}{}", row,
                              !resumes                   ? ""
                              : got_rows < expected_rows ? "; from there on a sample is missing"
                                                         : "; there a sample was put in"));
}

}  // namespace

std::vector<std::string> diagnose(const schema::StoredForces& stored, const RenderedForces& got) {
  std::vector<std::string> found;
  const std::size_t columns = stored.channels.size();
  if (columns == 0 || got.channels.size() != columns) return found;
  const Pairs pairs{.expected = stored.force, .got = got.force, .columns = columns};
  const double expected_most = largest(stored.force);
  if (expected_most > 0.0 && largest(got.force) == 0.0) {
    found.push_back(
        fmt::format("the law is silent: no force in any tick, where up to {:.3g} is stored", expected_most));
    return found;
  }
  if (stored.rows() != got.rows()) {
    find_gap(pairs, stored.rows(), got.rows(), found);
    return found;
  }
  find_scale(pairs, found);
  if (found.empty()) find_shift(pairs, found);
  return found;
}

}  // namespace kerf::bench

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/core.h>

#include "diagnosis/pair.h"

namespace kerf::compare {
namespace {

constexpr double same_factor = 1e-3;

struct KnownFactor {
  double factor;
  const char* meaning;
};
constexpr double degrees_per_radian = 180.0 / std::numbers::pi;
constexpr std::array known_factors{
    KnownFactor{degrees_per_radian, "180/pi: degrees where radians are meant"},
    KnownFactor{1.0 / degrees_per_radian, "pi/180: radians where degrees are meant"},
    KnownFactor{1000.0, "a thousand: one of m and mm, s and ms, N and mN, or N·m and N·mm"},
    KnownFactor{0.001, "a thousandth: one of mm and m, ms and s, mN and N, or N·mm and N·m"},
    KnownFactor{1e6, "a million: one of m and um, or MPa and Pa"},
    KnownFactor{1e-6, "a millionth: one of um and m, or Pa and MPa"},
    KnownFactor{100.0, "a hundred: one of m and cm"},
    KnownFactor{0.01, "a hundredth: one of cm and m"},
    KnownFactor{9.80665e-3, "one of gf and N"},
    KnownFactor{1.0 / 9.80665e-3, "one of N and gf"},
    KnownFactor{9.80665, "one of kgf and N"},
    KnownFactor{1.0 / 9.80665, "one of N and kgf"},
    KnownFactor{4.4482216152605, "one of lbf and N"},
    KnownFactor{1.0 / 4.4482216152605, "one of N and lbf"},
};

void find_factor(const ForcePair& pair, Findings& found) {
  double cross = 0.0;
  double all = 0.0;
  for (std::size_t row = 0; row < pair.rows(); ++row) {
    cross += pair.got[row] * pair.expected[row];
    all += pair.expected[row] * pair.expected[row];
  }
  if (!(all > 0.0)) return;
  const double factor = cross / all;
  if (std::abs(factor) < 1e-9) return;  // silence
  const double remainder = pair.remainder([&](std::size_t row) { return factor * pair.expected[row]; });
  if (std::abs(factor + 1.0) < same_factor) {
    add_finding(found, pair,
                {.change = Change::sign,
                 .remainder = remainder,
                 .sentence = "the force has the other sign",
                 .numbers = {{"factor", factor}}});
    return;
  }
  // A difference of a small part of the force hides in how the factor was rounded.
  add_finding(found, pair,
              {.change = Change::gain,
               .remainder = remainder,
               .sentence = fmt::format("the force is {:.6g} times the expected one", factor),
               .numbers = {{"factor", factor}}});
  for (const KnownFactor& one : known_factors) {
    if (std::abs(std::abs(factor) / one.factor - 1.0) > same_factor) continue;
    add_finding(found, pair,
                {.change = Change::unit,
                 .remainder = remainder,
                 .sentence = fmt::format("the force is in another unit: {:.6g} is {}", factor, one.meaning),
                 .numbers = {{"factor", factor}}});
  }
}

void find_line(const ForcePair& pair, Findings& found) {
  const auto count = static_cast<double>(pair.rows());
  double sum = 0.0;
  double moment = 0.0;
  for (std::size_t row = 0; row < pair.rows(); ++row) {
    sum += pair.difference[row];
    moment += (static_cast<double>(row) - 0.5 * (count - 1.0)) * pair.difference[row];
  }
  const double mean = sum / count;
  const double flat = pair.remainder([&](std::size_t row) { return pair.expected[row] + mean; });
  add_finding(found, pair,
              {.change = Change::offset,
               .remainder = flat,
               .sentence = fmt::format("{:+.4g} {} in every tick", mean, pair.unit),
               .numbers = {{"offset", mean}}});
  if (pair.rows() < 10 || flat <= named_remainder) return;
  const double slope = moment * 12.0 / (count * (count * count - 1.0));
  const auto line = [&](std::size_t row) {
    return mean + slope * (static_cast<double>(row) - 0.5 * (count - 1.0));
  };
  const double per_s = slope / pair.period_s;
  add_finding(found, pair,
              {.change = Change::drift,
               .remainder = pair.remainder([&](std::size_t row) { return pair.expected[row] + line(row); }),
               .sentence = fmt::format("the force drifts by {:+.4g} {}/s, {:+.3g} {} over the run", per_s,
                                       pair.unit, slope * count, pair.unit),
               .numbers = {{"per_s", per_s}, {"at_start", line(0)}}});
}

/// Where the expected force goes further than any that came.
void find_saturation(const ForcePair& pair, Findings& found) {
  const auto [least, most] = std::ranges::minmax(pair.got);
  const double low =
      std::ranges::min(pair.expected) < least ? least : -std::numeric_limits<double>::infinity();
  const double high = std::ranges::max(pair.expected) > most ? most : std::numeric_limits<double>::infinity();
  if (!(high > low) || (std::isinf(low) && std::isinf(high)) || least == most) return;
  const auto cut = [&](std::size_t row) { return std::clamp(pair.expected[row], low, high); };
  double left = 0.0;
  double all = 0.0;
  for (std::size_t row = 0; row < pair.rows(); ++row) {
    left += std::pow(pair.got[row] - cut(row), 2);
    all += pair.got[row] * pair.got[row];
  }
  // A force that has become small altogether is not one that was cut there.
  const double remainder = std::max(pair.remainder(cut), std::sqrt(left / all));
  std::string what = "the force is cut";
  Finding finding{.change = Change::saturation, .remainder = remainder};
  if (std::isfinite(low)) {
    what += fmt::format(" at {:.4g} {}", low, pair.unit);
    finding.numbers.emplace_back("low", low);
  }
  if (std::isfinite(high)) {
    what += fmt::format("{} at {:.4g} {}", std::isfinite(low) ? " and" : "", high, pair.unit);
    finding.numbers.emplace_back("high", high);
  }
  finding.sentence = what;
  add_finding(found, pair, std::move(finding));
}

}  // namespace

void find_scales(const ForcePair& pair, Findings& found) {
  find_factor(pair, found);
  find_line(pair, found);
  find_saturation(pair, found);
}

}  // namespace kerf::compare

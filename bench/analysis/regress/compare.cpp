#include "regress/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/ranges.h>

#include <kerf/fitting/jnd.h>

namespace kerf::bench {
namespace {

double allowed_by(const Tolerance& tolerance, const schema::ForceChannel& channel, double expected) {
  if (tolerance.exact) return 0.0;
  const double absolute = (channel.unit == "N·m" ? tolerance.torque_n_m : tolerance.force_n).value_or(0.0);
  return std::max({absolute, tolerance.relative.value_or(0.0) * std::abs(expected),
                   tolerance.jnd ? *tolerance.jnd * fitting::jnd_of(channel.unit).at(expected) : 0.0});
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::string names_of(const std::vector<schema::ForceChannel>& channels) {
  std::string text;
  for (const schema::ForceChannel& one : channels)
    text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", one.name, one.unit);
  return text;
}

bool same_channels(const std::vector<schema::ForceChannel>& a, const std::vector<schema::ForceChannel>& b) {
  return std::ranges::equal(
      a, b, [](const auto& x, const auto& y) { return x.name == y.name && x.unit == y.unit; });
}

/// How far outside its tolerance a difference is; those within it come after all outside.
struct Badness {
  bool outside = false;
  double excess = 0.0;
  friend auto operator<=>(const Badness&, const Badness&) = default;
};

std::string in_words(const ForceDifference& worst, const schema::ForceChannel& channel, bool exact) {
  return fmt::format("{}: expected {:.9g} {}, got {:.9g} {}, {:.3g} {} apart ({:.3g} JND), {}", channel.name,
                     worst.expected, channel.unit, worst.got, channel.unit, std::abs(worst.difference()),
                     channel.unit, worst.jnds,
                     exact ? std::string("and they have to be the same bit for bit")
                           : fmt::format("where {:.3g} {} is allowed", worst.allowed, channel.unit));
}

/// Both counts by their names: a table of one beside a sentence of the other would not agree.
std::string counts_in_words(const ForceComparison& comparison, bool exact) {
  if (exact)
    return fmt::format("the force differs in {} of {} ticks", comparison.differing, comparison.expected_rows);
  return fmt::format("the force is outside the tolerance in {} of {} ticks, and differs at all in {}",
                     comparison.outside, comparison.expected_rows, comparison.differing);
}

class Comparing {
 public:
  Comparing(const schema::StoredForces& stored, const RenderedForces& got, const Tolerance& tolerance)
      : stored_(stored), got_(got), tolerance_(tolerance) {
    result_.expected_rows = stored.rows();
    result_.got_rows = got.rows();
  }

  ForceComparison run() {
    if (!same_channels(stored_.channels, got_.channels)) {
      fail(fmt::format("the forces are {} where {} are stored", names_of(got_.channels),
                       names_of(stored_.channels)));
      return result_;
    }
    for (const schema::ForceChannel& channel : stored_.channels)
      result_.channels.push_back({.channel = channel});
    compare_rows();
    for (std::size_t tick = 0; tick < std::min(result_.expected_rows, result_.got_rows); ++tick)
      compare_tick(tick);
    compare_faults();
    if (result_.outside > 0) {
      const ForceDifference& worst = *result_.worst;
      fail(fmt::format("{}; worst at tick {}, {}", counts_in_words(result_, tolerance_.exact), worst.tick,
                       in_words(worst, stored_.channels[worst.channel], tolerance_.exact)));
    }
    return result_;
  }

 private:
  void fail(std::string message) {
    result_.passed = false;
    result_.messages.push_back(std::move(message));
  }

  void compare_rows() {
    const std::size_t expected = result_.expected_rows;
    const std::size_t got = result_.got_rows;
    if (got == expected) return;
    const std::size_t apart = got < expected ? expected - got : got - expected;
    fail(fmt::format("{} samples where {} are stored: {} {}", got, expected, apart,
                     got < expected ? "lost" : "added"));
  }

  void compare_faults() {
    if (got_.faults == stored_.faults) return;
    fail(fmt::format("the law faulted in {} ticks where {} are stored{}", got_.faults, stored_.faults,
                     got_.first_fault ? fmt::format(", first in tick {}", *got_.first_fault) : ""));
  }

  void compare_tick(std::size_t tick) {
    bool differs = false;
    bool outside = false;
    for (std::size_t channel = 0; channel < stored_.channels.size(); ++channel) {
      const std::size_t at = tick * stored_.channels.size() + channel;
      ForceDifference one{
          .tick = tick, .channel = channel, .expected = stored_.force[at], .got = got_.force[at]};
      ChannelComparison& about = result_.channels[channel];
      about.largest_expected = std::max(about.largest_expected, std::abs(one.expected));
      if (same_bits(one.expected, one.got)) continue;
      differs = true;
      one.allowed = allowed_by(tolerance_, about.channel, one.expected);
      const double apart = std::abs(one.difference());
      one.jnds = apart / fitting::jnd_of(about.channel.unit).at(one.expected);
      about.largest_difference = std::max(about.largest_difference, apart);
      about.largest_jnds = std::max(about.largest_jnds, one.jnds);
      // A number that is not finite is within no tolerance.
      const bool is_outside = tolerance_.exact || !(apart <= one.allowed);
      if (is_outside) ++about.outside;
      outside = outside || is_outside;
      const Badness badness{is_outside,
                            std::isfinite(one.jnds) ? one.jnds : std::numeric_limits<double>::infinity()};
      if (result_.worst && !(worst_ < badness)) continue;
      worst_ = badness;
      result_.worst = one;
    }
    if (differs) ++result_.differing;
    if (outside) ++result_.outside;
  }

  const schema::StoredForces& stored_;
  const RenderedForces& got_;
  const Tolerance& tolerance_;
  ForceComparison result_;
  Badness worst_;
};

}  // namespace

ForceComparison compare_forces(const schema::StoredForces& stored, const RenderedForces& got,
                               const Tolerance& tolerance) {
  return Comparing(stored, got, tolerance).run();
}

}  // namespace kerf::bench

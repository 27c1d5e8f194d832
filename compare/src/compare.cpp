#include "kerf/compare/compare.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/core.h>

#include "kerf/compare/diagnose.h"
#include "kerf/compare/jnd.h"

namespace kerf::compare {
namespace {

constexpr std::size_t ticks_between_intervals = 10;

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_channels(const std::vector<Channel>& a, const std::vector<Channel>& b) {
  return std::ranges::equal(
      a, b, [](const Channel& x, const Channel& y) { return x.name == y.name && x.unit == y.unit; });
}

/// How far outside its tolerance a difference is; those within it come after all outside.
struct Badness {
  bool outside = false;
  double excess = 0.0;
  friend auto operator<=>(const Badness&, const Badness&) = default;
};

std::string worst_in_words(const ForceDifference& worst, const ChannelName& channel, bool exact) {
  if (!std::isfinite(worst.difference()))
    return fmt::format("{}: expected {:.9g} {}, got {:.9g} {}, and what is not finite is within no tolerance",
                       channel.name, worst.expected, channel.unit, worst.got, channel.unit);
  return fmt::format("{}: expected {:.9g} {}, got {:.9g} {}, {:.3g} {} apart ({:.3g} JND), {}", channel.name,
                     worst.expected, channel.unit, worst.got, channel.unit, std::abs(worst.difference()),
                     channel.unit, worst.jnds,
                     exact ? std::string("and they have to be the same bit for bit")
                           : fmt::format("where {:.3g} {} is allowed", worst.allowed, channel.unit));
}

void add_to(std::vector<Interval>& intervals, std::size_t tick) {
  if (!intervals.empty() && tick <= intervals.back().end + ticks_between_intervals) {
    intervals.back().end = tick + 1;
  } else if (intervals.size() < most_intervals) {
    intervals.push_back({tick, tick + 1});
  }
}

/// A limit of a difference, and what rounding makes of one that is as large: a few last digits of both
/// numbers, and no more than a millionth of the limit.
double with_rounding(double limit, double expected, double got) {
  const double last_digits =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(expected), std::abs(got));
  return limit + std::min(last_digits, 1e-6 * limit);
}

/// A limit of the whole run that is not kept, in words.
std::string beyond(const ChannelName& channel, const char* what, double value, double limit,
                   const char* per = "") {
  return fmt::format("{}: {} {:.3g} {}{}, where {:.3g} {}{} is allowed", channel.name, what, value,
                     channel.unit, per, limit, channel.unit, per);
}

class Comparing {
 public:
  /// `rows`: what the rows are in the whole run, if they are not all of it.
  Comparing(const Series& expected, const Series& got, const Tolerance& tolerance, const MatchedRows* rows)
      : expected_(expected), got_(got), tolerance_(tolerance), whole_(rows) {
    result_.expected_rows = expected.rows();
    result_.got_rows = got.rows();
    rows_ = std::min(result_.expected_rows, result_.got_rows);
  }

  Comparison run() {
    if (!same_channels(expected_.channels, got_.channels)) {
      fail(fmt::format("the forces are {} where {} are stored", names_of(got_.channels),
                       names_of(expected_.channels)));
      return result_;
    }
    compare_row_counts();
    differs_.assign(rows_, 0);
    outside_.assign(rows_, 0);
    for (std::size_t channel = 0; channel < expected_.channels.size(); ++channel) compare_channel(channel);
    result_.differing = static_cast<std::size_t>(std::ranges::count(differs_, 1));
    result_.outside = static_cast<std::size_t>(std::ranges::count(outside_, 1));
    if (result_.outside > 0) say_outside();
    for (std::size_t channel = 0; channel < result_.channels.size(); ++channel) judge_run(channel);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::size_t whole_tick(std::size_t tick) const {
    return whole_ == nullptr ? tick : whole_->expected[tick];
  }

  void fail(std::string message) {
    result_.passed = false;
    result_.messages.push_back(std::move(message));
  }

  void compare_row_counts() {
    const std::size_t expected = result_.expected_rows;
    const std::size_t got = result_.got_rows;
    if (got == expected) return;
    const std::size_t apart = got < expected ? expected - got : got - expected;
    fail(fmt::format("{} samples where {} are stored: {} {}", got, expected, apart,
                     got < expected ? "lost" : "added"));
  }

  void compare_channel(std::size_t channel) {
    const Channel& expected = expected_.channels[channel];
    const Channel& got = got_.channels[channel];
    const Tolerance& tolerance = tolerance_.of(expected.name);
    const Jnd jnd = jnd_of(expected.unit);
    ChannelComparison about{.channel = {.name = expected.name, .unit = expected.unit}};
    double squares = 0.0;
    for (std::size_t tick = 0; tick < rows_; ++tick) {
      ForceDifference one{.tick = tick,
                          .got_tick = tick,
                          .channel = channel,
                          .expected = expected.value[tick],
                          .got = got.value[tick]};
      about.largest_expected = std::max(about.largest_expected, std::abs(one.expected));
      about.largest_got = std::max(about.largest_got, std::abs(one.got));
      const bool same = same_bits(one.expected, one.got);
      if (same && std::isfinite(one.expected)) continue;
      if (!same) differs_[tick] = 1;
      one.allowed = tolerance.allowed(expected.unit, one.expected);
      const double apart = std::abs(one.difference());
      if (std::isfinite(apart)) squares += apart * apart;
      if (!std::isfinite(apart)) ++about.not_finite;
      one.jnds = apart / jnd.at(one.expected);
      if (std::isfinite(apart)) {
        if (apart > about.largest_difference) about.largest_at = tick;
        about.largest_difference = std::max(about.largest_difference, apart);
        about.largest_jnds = std::max(about.largest_jnds, one.jnds);
      }
      // A number that is not finite is within no tolerance, and not right because it was stored.
      const bool is_outside =
          (tolerance.exact && !same) || !(apart <= with_rounding(one.allowed, one.expected, one.got));
      if (is_outside) take_outside(about, tick);
      const Badness badness{is_outside,
                            std::isfinite(one.jnds) ? one.jnds : std::numeric_limits<double>::infinity()};
      // Of those that are equally bad the earliest, whatever its channel.
      if (result_.worst && (badness < worst_ || (badness == worst_ && result_.worst->tick <= tick))) continue;
      worst_ = badness;
      result_.worst = one;
    }
    if (rows_ > about.not_finite)
      about.rms_difference = std::sqrt(squares / static_cast<double>(rows_ - about.not_finite));
    result_.channels.push_back(std::move(about));
  }

  void take_outside(ChannelComparison& about, std::size_t tick) {
    ++about.outside;
    outside_[tick] = 1;
    if (!about.first_outside) about.first_outside = tick;
    if (!result_.first_outside || tick < *result_.first_outside) result_.first_outside = tick;
    add_to(about.intervals, tick);
  }

  void say_outside() {
    const ForceDifference& worst = *result_.worst;
    const ChannelName& channel = result_.channels[worst.channel].channel;
    const bool exact = tolerance_.of(channel.name).exact;
    const std::string counts =
        exact ? fmt::format("the force differs in {} of {} ticks", result_.differing, result_.expected_rows)
              : fmt::format("the force is outside the tolerance in {} of {} ticks, and differs at all in {}",
                            result_.outside, result_.expected_rows, result_.differing);
    fail(fmt::format("{}; worst at tick {}, {}{}", counts, whole_tick(worst.tick),
                     worst_in_words(worst, channel, exact), farther(result_.channels[worst.channel])));
    if (!std::isfinite(worst.expected))
      fail(fmt::format("what is expected of {} is no finite number from tick {} on: it was never right",
                       channel.name, whole_tick(worst.tick)));
  }

  /// Where the difference is larger, but of a force of which a hand feels less.
  [[nodiscard]] std::string farther(const ChannelComparison& about) const {
    if (!(about.largest_difference > std::abs(result_.worst->difference()))) return "";
    return fmt::format("; the largest difference, {:.3g} {}, is at tick {}", about.largest_difference,
                       about.channel.unit, whole_tick(about.largest_at));
  }

  /// What a limit of each tick does not see.
  void judge_run(std::size_t channel) {
    ChannelComparison& about = result_.channels[channel];
    const Tolerance& tolerance = tolerance_.of(about.channel.name);
    if (tolerance.exact || about.largest_difference == 0.0 || about.not_finite > 0) return;
    const std::string& unit = about.channel.unit;
    const auto peak = tolerance.peak.of(unit);
    if (const double apart = about.largest_got - about.largest_expected;
        peak && std::abs(apart) > with_rounding(*peak, about.largest_expected, about.largest_got))
      fail(beyond(about.channel, "the largest force is off by", apart, *peak));
    const auto slew = tolerance.slew.of(unit);
    const auto drift = tolerance.drift.of(unit);
    const auto vibration = tolerance.vibration_limit();
    if (!slew && !drift && !vibration) return;
    std::vector<double> difference(rows_);
    for (std::size_t tick = 0; tick < rows_; ++tick)
      difference[tick] = got_.channels[channel].value[tick] - expected_.channels[channel].value[tick];
    const double period_s = expected_.period();
    if (slew) judge_slew(about, difference, period_s, *slew);
    if (drift) judge_drift(about, difference, *drift);
    if (vibration) judge_vibration(about, difference, 1.0 / period_s, *vibration);
  }

  void judge_slew(ChannelComparison& about, const std::vector<double>& difference, double period_s,
                  double limit) {
    double most = 0.0;
    std::size_t at = 0;
    for (std::size_t tick = 1; tick < difference.size(); ++tick) {
      const double change = std::abs(difference[tick] - difference[tick - 1]) / period_s;
      if (change > most) at = tick;
      most = std::max(most, change);
    }
    about.slew = most;
    if (most > limit)
      fail(beyond(about.channel, "the difference changes by", most, limit, "/s") +
           fmt::format(", at tick {}", whole_tick(at)));
  }

  void judge_drift(ChannelComparison& about, const std::vector<double>& difference, double limit) {
    const auto count = static_cast<double>(difference.size());
    if (count < 2.0) return;
    double moment = 0.0;
    for (std::size_t tick = 0; tick < difference.size(); ++tick)
      moment += (static_cast<double>(tick) - 0.5 * (count - 1.0)) * difference[tick];
    about.drift = moment * 12.0 / (count * (count + 1.0));
    if (std::abs(*about.drift) > limit)
      fail(beyond(about.channel, "the difference drifts over the run by", *about.drift, limit));
  }

  void judge_vibration(ChannelComparison& about, const std::vector<double>& difference, double rate_hz,
                       double limit) {
    about.bands = band_levels(difference, rate_hz, about.channel.unit);
    const auto worst = std::ranges::max_element(about.bands, {}, &BandLevel::thresholds);
    if (worst == about.bands.end() || !(worst->thresholds() > limit)) return;
    fail(fmt::format(
        "{}: the difference vibrates: {:.3g} {} RMS between {:.0f} and {:.0f} Hz around {:.3g} s, "
        "{:.3g} times what a hand can feel, where {:.3g} times is allowed",
        about.channel.name, worst->worst_rms, about.channel.unit, worst->from_hz, worst->to_hz,
        worst->worst_time_s, worst->thresholds(), limit));
  }

  const Series& expected_;
  const Series& got_;
  const Tolerance& tolerance_;
  const MatchedRows* whole_;
  std::size_t rows_ = 0;
  Comparison result_;
  Badness worst_;
  std::vector<char> differs_;  ///< of each tick
  std::vector<char> outside_;
};

/// From rows that have a partner to rows of the whole run.
void count_in_whole_run(Comparison& part, const MatchedRows& rows) {
  const auto whole = [&](std::size_t& tick) { tick = rows.expected[tick]; };
  if (part.worst) {
    part.worst->got_tick = rows.got[part.worst->tick];
    whole(part.worst->tick);
  }
  if (part.first_outside) whole(*part.first_outside);
  for (ChannelComparison& one : part.channels) {
    whole(one.largest_at);
    if (one.first_outside) whole(*one.first_outside);
    for (Interval& interval : one.intervals)
      interval = {rows.expected[interval.begin], rows.expected[interval.end - 1] + 1};
  }
}

/// Where rows are missing that forces which are not alike could not tell of.
std::string places_by_time(const MatchedRows& rows) {
  std::size_t first = 0;
  while (first < rows.expected.size() && rows.expected[first] == first && rows.got[first] == first) ++first;
  return fmt::format(", by the times {}at tick {}",
                     rows.edits > 1 ? fmt::format("at {} places, first ", rows.edits) : "", first);
}

}  // namespace

Comparison compare(const Series& expected, const Series& got, const Tolerance& tolerance) {
  return Comparing(expected, got, tolerance, nullptr).run();
}

Comparison compare_with_gaps(const Series& expected, const Series& got, const Tolerance& tolerance) {
  Comparison straight = compare(expected, got, tolerance);
  if (straight.channels.empty() || expected.rows() == got.rows()) return straight;
  const auto rows = matched_rows(expected, got);
  if (!rows) return straight;
  const Series both = rows_of(expected, rows->expected);
  Comparison matched = Comparing(both, rows_of(got, rows->got), tolerance, &*rows).run();
  count_in_whole_run(matched, *rows);
  for (std::string& message : matched.messages) message = "besides, of the ticks that both have: " + message;
  matched.messages.insert(matched.messages.begin(),
                          straight.messages.front() + (rows->by_time ? places_by_time(*rows) : ""));
  matched.passed = false;
  matched.expected_rows = straight.expected_rows;
  matched.got_rows = straight.got_rows;
  return matched;
}

}  // namespace kerf::compare

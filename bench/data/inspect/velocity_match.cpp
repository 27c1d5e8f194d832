#include "inspect/velocity_match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "recordings/row_figures.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_places = 1U << 16U;
constexpr std::size_t fewest_ways = 20;
constexpr double farthest_lag_s = 1.0;
constexpr double usual_lag_s = 0.1;
constexpr double goes_along = 0.8;      // a correlation from which on a velocity follows
constexpr double goes_along_now = 0.9;  // and from which on no lag is looked for

/// Means over as many rows each: of the position, of the integral of the velocity, and of the time.
struct Place {
  double position = 0.0;
  double integral = 0.0;
  double time_s = 0.0;
  std::uint32_t stretch = 0;  ///< of rows that follow each other without a gap or a jump
};

class PlacesAlong {
 public:
  explicit PlacesAlong(const RecordedMotion& motion)
      : motion_(motion),
        rows_each_(std::max<std::size_t>(1, (motion.position.size() + most_places - 1) / most_places)) {
    for (std::uint64_t row = 0; row < motion.position.size(); ++row) {
      if (!stands_out(row)) add(row);
    }
  }

  [[nodiscard]] const std::vector<Place>& all() const { return places_; }
  [[nodiscard]] std::size_t rows_each() const { return rows_each_; }

 private:
  [[nodiscard]] bool stands_out(std::uint64_t row) const {
    if (row == 0 || row + 1 == motion_.position.size()) return false;
    const double before = motion_.position[row] - motion_.position[row - 1];
    const double after = motion_.position[row] - motion_.position[row + 1];
    const double least = std::max(8.0 * motion_.position_noise, 4.0 * std::abs(before - after));
    return before * after > 0.0 && std::min(std::abs(before), std::abs(after)) > least;
  }

  /// Steps of half of the range are turns of an angle, or rubbish.
  [[nodiscard]] bool follows(const Place& now) const {
    const double step_s = now.time_s - last_.time_s;
    return step_s > 0.0 && step_s <= gap_in_periods * motion_.period_s &&
           std::abs(now.position - last_.position) <= 0.5 * motion_.position_range;
  }

  void add(std::uint64_t row) {
    Place now{.position = motion_.position[row], .time_s = motion_.time_s[row], .stretch = last_.stretch};
    const double velocity = motion_.velocity[row];
    const bool is_finite =
        std::isfinite(now.position) && std::isfinite(now.time_s) && std::isfinite(velocity);
    if (!is_finite || !is_going_on_ || !follows(now)) {
      now.stretch = last_.stretch + 1;
      rows_ = 0;
      sum_ = {};
    } else {
      now.integral = last_.integral + 0.5 * (last_velocity_ + velocity) * (now.time_s - last_.time_s);
    }
    is_going_on_ = is_finite;
    last_ = now;
    last_velocity_ = velocity;
    if (is_finite) gather(now);
  }

  void gather(const Place& now) {
    const double share = 1.0 / static_cast<double>(rows_each_);
    sum_.position += share * now.position;
    sum_.integral += share * now.integral;
    sum_.time_s += share * now.time_s;
    sum_.stretch = now.stretch;
    if (++rows_ < rows_each_) return;
    places_.push_back(sum_);
    rows_ = 0;
    sum_ = {};
  }

  const RecordedMotion& motion_;
  std::size_t rows_each_;
  std::vector<Place> places_;
  Place last_;
  Place sum_;
  double last_velocity_ = 0.0;
  std::size_t rows_ = 0;  ///< in the sum
  bool is_going_on_ = false;
};

/// Sums over ways x and integrals v of the velocity.
struct WaySums {
  double n = 0.0;
  double x = 0.0, v = 0.0, t = 0.0;
  double xx = 0.0, vv = 0.0, xv = 0.0;

  /// About the means, so that an offset of the velocity is none of its gain; a motion in one direction at one
  /// speed has no more than its gain.
  [[nodiscard]] VelocityMatch match() const {
    const bool is_one_ramp = xx - x * x / n < 0.25 * xx;
    const double about = is_one_ramp ? 0.0 : 1.0 / n;
    const double of_x = xx - about * x * x;
    const double of_v = vv - about * v * v;
    const double of_both = xv - about * x * v;
    VelocityMatch match{.gain = of_both / of_x};
    if (of_v > 0.0) match.correlation = of_both / std::sqrt(of_x * of_v);
    match.correlation_now = match.correlation;
    if (!is_one_ramp) match.offset = (v - match.gain * x) / t;
    const double usual = std::abs(match.gain) * std::sqrt(xx / n);
    if (usual > 0.0) match.share_of_offset = std::abs(match.offset) * (t / n) / usual;
    return match;
  }
};

/// Ways of so many places, each against the integral of the velocity `lag` places later.
class Ways {
 public:
  Ways(const std::vector<Place>& places, std::size_t length, double least)
      : places_(places), length_(length), stride_(std::max<std::size_t>(1, length / 4)), least_(least) {}

  [[nodiscard]] std::optional<VelocityMatch> at(std::ptrdiff_t lag) const {
    WaySums sums;
    const auto before = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, -lag));
    const auto after = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, lag));
    for (std::size_t i = before; i + length_ + after < places_.size(); i += stride_) {
      const Place& from = places_[i];
      const Place& to = places_[i + length_];
      const double way = to.position - from.position;
      if (from.stretch != to.stretch || !(std::abs(way) > least_)) continue;
      const Place& begin = places_[i + after - before];
      const Place& end = places_[i + length_ + after - before];
      if (begin.stretch != from.stretch || end.stretch != from.stretch) continue;
      const double integral = end.integral - begin.integral;
      sums.n += 1.0;
      sums.x += way;
      sums.v += integral;
      sums.t += end.time_s - begin.time_s;
      sums.xx += way * way;
      sums.vv += integral * integral;
      sums.xv += way * integral;
    }
    const auto apart = static_cast<std::size_t>(sums.n) * stride_ / length_;
    if (apart < fewest_ways) return std::nullopt;
    VelocityMatch match = sums.match();
    match.ways = apart;
    return match;
  }

  [[nodiscard]] std::size_t length() const { return length_; }

 private:
  const std::vector<Place>& places_;
  std::size_t length_;
  std::size_t stride_;
  double least_;
};

struct Lagged {
  std::ptrdiff_t lag = 0;
  VelocityMatch match;
};

bool goes_better(const VelocityMatch& a, const VelocityMatch& b) {
  return std::abs(a.correlation) > std::abs(b.correlation);
}

/// The lag nearest to none that goes as well as any: of a motion that repeats there are many.
std::optional<Lagged> best_lag(const Ways& ways, std::ptrdiff_t reach) {
  constexpr double as_well = 0.02;
  constexpr std::ptrdiff_t most_to_a_side = 64;
  std::ptrdiff_t step =
      std::max<std::ptrdiff_t>({1, reach / most_to_a_side, static_cast<std::ptrdiff_t>(ways.length() / 8)});
  std::vector<Lagged> found;
  for (std::ptrdiff_t lag = -reach / step * step; lag <= reach; lag += step) {
    if (const auto match = ways.at(lag)) found.push_back({.lag = lag, .match = *match});
  }
  if (found.empty()) return std::nullopt;
  const auto size = [](const Lagged& one) { return std::abs(one.match.correlation); };
  const double most = size(*std::ranges::max_element(found, {}, size));
  Lagged best{.lag = reach + 1};
  for (const Lagged& one : found) {
    if (size(one) >= most - as_well && std::abs(one.lag) < std::abs(best.lag)) best = one;
  }
  for (step /= 2; step > 0; step /= 2) {
    for (const std::ptrdiff_t lag : {best.lag - step, best.lag + step}) {
      const auto match = ways.at(lag);
      if (match && goes_better(*match, best.match)) best = {.lag = lag, .match = *match};
    }
  }
  return best;
}

/// What is mistaken for what, by the gain that it makes.
struct Mistake {
  double gain;
  std::string_view of_a_way;
  std::string_view of_an_angle;
};
constexpr std::array mistakes{
    Mistake{1e-3, "m/s taken for mm/s?", ""},
    Mistake{1e3, "mm/s taken for m/s?", ""},
    Mistake{1e-2, "m/s taken for cm/s?", ""},
    Mistake{1e2, "cm/s taken for m/s?", ""},
    Mistake{0.1, "cm/s taken for mm/s?", ""},
    Mistake{10.0, "mm/s taken for cm/s?", ""},
    Mistake{1.0 / 25.4, "in/s taken for mm/s?", ""},
    Mistake{25.4, "mm/s taken for in/s?", ""},
    Mistake{60.0, "one a minute taken for one a second?", "one a minute taken for one a second?"},
    Mistake{1.0 / 60.0, "one a second taken for one a minute?", "one a second taken for one a minute?"},
    Mistake{57.2958, "", "deg/s taken for rad/s?"},
    Mistake{1.0 / 57.2958, "", "rad/s taken for deg/s?"}};

std::string_view mistake_of(double gain, const std::string& position_unit) {
  constexpr double within = 0.02;
  for (const Mistake& mistake : mistakes) {
    if (std::abs(std::abs(gain) / mistake.gain - 1.0) < within)
      return position_unit == "rad" ? mistake.of_an_angle : mistake.of_a_way;
  }
  return "";
}

std::string doubt_of_gain(double gain, const std::string& position_unit) {
  // Three digits, without a power of ten as long as there are less than seven.
  const double digit = std::pow(10.0, std::floor(std::log10(std::abs(gain))) - 2.0);
  std::string doubt = fmt::format("is {:.6g} of dx/dt", std::round(gain / digit) * digit);
  const std::string_view mistake = mistake_of(gain, position_unit);
  if (gain < 0.0) doubt += ": turned sign";
  if (!mistake.empty()) doubt += fmt::format("{} {}", gain < 0.0 ? "," : ":", mistake);
  return doubt;
}

}  // namespace

std::optional<VelocityMatch> velocity_match(const RecordedMotion& motion) {
  constexpr double in_noise = 8.0;
  constexpr double range_in_noise = 50.0;
  if (motion.velocity.size() != motion.position.size() || !(motion.period_s > 0.0) ||
      !(motion.position_range > range_in_noise * motion.position_noise))
    return std::nullopt;
  const PlacesAlong along(motion);
  const std::vector<Place>& places = along.all();
  const double rounding = 1e-12 * motion.position_range;
  const double noise = motion.position_noise * std::sqrt(2.0 / static_cast<double>(along.rows_each()));
  const double least = std::max(in_noise * noise, rounding);

  std::vector<Ways> lengths;
  std::optional<VelocityMatch> now;
  for (std::size_t length = 1; length * fewest_ways <= places.size(); length *= 2) {
    lengths.emplace_back(places, length, least);
    const auto match = lengths.back().at(0);
    if (match && (!now || goes_better(*match, *now))) now = match;
  }
  if (!now || std::abs(now->correlation) >= goes_along_now) return now;

  const double step_s = motion.period_s * static_cast<double>(along.rows_each());
  const auto reach = static_cast<std::ptrdiff_t>(
      std::min(std::max(farthest_lag_s / step_s, 3.0), 0.125 * static_cast<double>(places.size())));
  Lagged best{.lag = 0, .match = *now};
  for (const Ways& ways : lengths) {
    const auto found = best_lag(ways, reach);
    if (found && goes_better(found->match, best.match)) best = *found;
  }
  best.match.correlation_now = now->correlation;
  best.match.lag_s = static_cast<double>(best.lag) * step_s;
  return best.match;
}

std::string velocity_doubt(const VelocityMatch& match, const std::string& position_unit, double period_s) {
  constexpr double least_gain = 2.0 / 3.0;
  constexpr double largest_share_of_offset = 0.5;
  if (match.gain == 0.0 && match.correlation == 0.0 && match.offset == 0.0)
    return "is 0 all along, though the position moves";
  const bool comes_at_another_time =
      std::abs(match.lag_s) > std::max(usual_lag_s, 2.0 * period_s) && match.correlation_now < goes_along;
  if (std::abs(match.correlation) < goes_along) {
    return fmt::format("does not follow dx/dt (correlation {:.2f}): another axis' or another signal?",
                       match.correlation_now);
  }
  if (comes_at_another_time) {
    return fmt::format(
        "follows dx/dt {:.3g} s {} (correlation {:.2f}; now {:.2f}): moved in time, or another axis'?",
        std::abs(match.lag_s), match.lag_s > 0.0 ? "late" : "early", match.correlation,
        match.correlation_now);
  }
  if (!(match.gain >= least_gain && match.gain <= 1.0 / least_gain))
    return doubt_of_gain(match.gain, position_unit);
  if (match.share_of_offset > largest_share_of_offset)
    return fmt::format("is {:.3g} {}/s {} than dx/dt", std::abs(match.offset), position_unit,
                       match.offset > 0.0 ? "more" : "less");
  return "";
}

}  // namespace kerf::bench

#include "fits/row_doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "fits/fit_series.h"
#include "fits/sensor_doubts.h"
#include "signal/held_values.h"
#include "signal/quantiles.h"
#include "signal/row_noise.h"

namespace kerf::bench {
namespace {

/// A force that does not change by what a hand feels tells no law from a constant.
std::string nothing_changes(const AxisSeries& series, const fitting::FitOptions& settings) {
  const auto [least, most] = std::ranges::minmax_element(series.force);
  if (*least == *most) return "";  // which no fit takes
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < series.force.size(); ++i) {
    if (!series.counts.empty() && series.counts[i] == 0) continue;
    sum += series.force[i];
    squares += series.force[i] * series.force[i];
    count += 1.0;
  }
  const double mean = sum / count;
  const double deviation = std::sqrt(std::max(0.0, squares / count - mean * mean));
  const double jnd = settings.jnd.at(std::sqrt(squares / count));
  if (!(deviation <= jnd)) return "";
  const std::string& unit = settings.force_unit;
  return fmt::format(
      "a force of {:.3g} {} that never changes is within the JND of {:.3g} {} too: the recording does not "
      "say "
      "how the force depends on the motion",
      mean, unit, jnd, unit);
}

double quantile_of(std::vector<double>& values, double share) {
  constexpr std::size_t fewest = 3;
  return values.size() < fewest ? std::numeric_limits<double>::quiet_NaN()
                                : quantile(std::move(values), share);
}

/// The force over the depth, in fiftieths of it.
class ForceOverDepth {
 public:
  explicit ForceOverDepth(const AxisSeries& series)
      : deepest_(*std::ranges::max_element(series.penetration)) {
    const std::size_t stride = std::max<std::size_t>(1, series.force.size() / looked_at);
    std::array<std::vector<double>, bins> going_in;
    std::array<std::vector<double>, bins> first_way_in;
    std::vector<double> first_in, first_out;
    double reached = 0.0;
    bool has_turned = false;
    double pulling = 0.0;  // rows more than others
    for (std::size_t i = 0; i < series.force.size(); i += stride) {
      const double share = series.penetration[i] / deepest_;
      const double velocity = series.velocity[i];
      if (!(share >= 0.0 && share <= 1.0) || velocity == 0.0) continue;
      const auto bin = std::min(bins - 1, static_cast<std::size_t>(share * bins));
      if (bin == 0) (velocity > 0.0 ? first_in : first_out).push_back(series.force[i]);
      reached = std::max(reached, share);
      has_turned = has_turned || (velocity < 0.0 && reached > 0.5);
      if (!(velocity > 0.0)) continue;
      going_in[bin].push_back(std::abs(series.force[i]));
      if (!has_turned) first_way_in[bin].push_back(std::abs(series.force[i]));
      pulling += series.force[i] < 0.0 ? 1.0 : -1.0;
    }
    std::ranges::transform(going_in, upper_.begin(), [](auto& sizes) { return quantile_of(sizes, 0.75); });
    std::ranges::transform(first_way_in, first_.begin(), [](auto& sizes) {
      return sizes.empty() ? std::numeric_limits<double>::quiet_NaN() : quantile(std::move(sizes), 0.5);
    });
    for (const double upper : upper_) most_ = std::fmax(most_, upper);
    const double in = quantile_of(first_in, 0.5);
    const double out = quantile_of(first_out, 0.5);
    const double lesser = std::abs(in) < std::abs(out) ? in : out;
    const bool pulls = pulling > 0.0;  // mostly
    const bool same = in * out > 0.0 && std::abs(in - out) < alike * std::abs(lesser);
    is_bias_ = same && (in > 0.0 || !pulls) && std::abs(lesser) < most_bias * most_;
    rests_within_ = in < 0.0 && out < 0.0 && !pulls && !is_bias_;
    if (in * out > 0.0) at_first_ = lesser;
  }

  [[nodiscard]] double most() const noexcept { return most_; }
  /// Where the tool was least engaged, whichever way it went; 0 where it went with and against the force.
  [[nodiscard]] double at_first() const noexcept { return at_first_; }
  /// Whether that is nearly the same going in and out, as what a sensor shows that was not zeroed.
  [[nodiscard]] bool may_be_bias() const noexcept { return is_bias_; }
  /// Whether it pulls there both ways and pushes elsewhere, as what is held and moved to both sides.
  [[nodiscard]] bool may_rest_within() const noexcept { return rests_within_; }
  /// The share of the depth that the tool goes without a force; 0 where it hardly was there.
  [[nodiscard]] double onset(double felt) const {
    std::size_t known = 0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
      if (std::isnan(upper_[bin])) continue;
      if (upper_[bin] > felt)
        return 2 * known < bin || was_felt_at_first(bin, felt) ? 0.0 : static_cast<double>(bin) / bins;
      ++known;
    }
    return 0.0;
  }
  /// At a share of the depth, or the next one where the tool was.
  [[nodiscard]] double at(double share) const {
    const auto from = upper_.begin() + static_cast<std::ptrdiff_t>(share * bins);
    const auto found = std::find_if(from, upper_.end(), [](double upper) { return !std::isnan(upper); });
    return found == upper_.end() ? 0.0 : *found;
  }

 private:
  /// Whether the force was felt before `bin` when the tool first went in: tissue that has not come back since
  /// is met later by every further stroke.
  [[nodiscard]] bool was_felt_at_first(std::size_t bin, double felt) const {
    const auto before = std::span(first_).first(bin);
    const auto known = std::ranges::count_if(before, [](double force) { return !std::isnan(force); });
    return known > 0 && 2 * std::ranges::count_if(before, [&](double force) { return force > felt; }) > known;
  }

  static constexpr std::size_t bins = 50;
  static constexpr std::size_t looked_at = 50'000;
  static constexpr double alike = 0.25;
  static constexpr double most_bias = 0.5;  // of the largest force

  double deepest_;
  std::array<double, bins> first_{};  ///< the median of its size when the tool first went in
  std::array<double, bins> upper_{};  ///< the upper quartile of its size, going in; NaN of too few rows
  double most_ = 0.0;
  double at_first_ = 0.0;
  bool is_bias_ = false;
  bool rests_within_ = false;
};

/// A law of contact begins at penetration 0. Of a force that stiffens the beginning is not felt, and nothing
/// is said: where one sets in, a quarter of the rest of the way on it is a tenth of the largest.
std::string begins_elsewhere(const AxisSeries& series, const fitting::FitOptions& settings) {
  constexpr double late = 0.15;
  constexpr double gentle = 0.1;
  const ForceOverDepth force(series);
  const double preloaded = force.may_be_bias() ? 0.05 : 0.2;
  constexpr double least_share = 0.02;
  const auto [smallest, largest] = std::ranges::minmax_element(series.force);
  if (*smallest == *largest || !(force.most() > 0.0)) return "";  // which no fit takes
  const std::string& unit = settings.force_unit;
  const char* const mend = "; --contact POSITION says where it begins, 'kerf prepare --onset' finds it";
  const double first = force.at_first();
  if (std::abs(first) > std::max(settings.jnd.threshold, preloaded * force.most())) {
    std::string why = mend;
    if (force.may_be_bias()) {
      why = fmt::format(
          ", the same going in and out, as of a sensor that was not zeroed ('kerf prepare --bias' takes that "
          "off "
          "where the tool is free){}",
          mend);
    } else if (force.may_rest_within()) {
      why =
          ": is the tissue held, and moved to both sides of where it rests? --contact POSITION says where "
          "that is, and --option bilateral=true lets laws pull";
    } else if (first < 0.0) {
      why = fmt::format(": is its sign turned? --map 'force=COLUMN[-1 {}]' turns it", unit);
    }
    return fmt::format(
        "where the tool was least engaged, and penetration is 0, a force of {:.3g} {} {} already, of {:.3g} "
        "{} going in{}",
        std::abs(first), unit, first < 0.0 ? "pulls" : "pushes", force.most(), unit, why);
  }
  const double onset = force.onset(std::max(settings.jnd.threshold, least_share * force.most()));
  if (!(onset > late && force.at(onset + 0.25 * (1.0 - onset)) > gentle * force.most())) return "";
  return fmt::format(
      "going in, the force begins at {:.0f} % of the depth, where laws of contact have it begin at 0{}",
      100.0 * onset, mend);
}

/// What gives way where the tool goes in and pushes back where it comes out is no tissue.
std::string helps_going_in(const AxisSeries& series, const fitting::FitOptions& settings) {
  constexpr double nearly_all = 0.9;  // of the work
  double with = 0.0;
  double against = 0.0;
  double largest = 0.0;
  for (std::size_t i = 1; i < series.force.size(); ++i) {
    if (!series.counts.empty() && series.counts[i] == 0) continue;
    const double way = series.penetration[i] - series.penetration[i - 1];
    if (!(way > 0.0)) continue;
    (series.force[i] < 0.0 ? with : against) += std::abs(series.force[i]) * way;
    largest = std::max(largest, -series.force[i]);
  }
  if (!(largest > settings.jnd.threshold && with > nearly_all * (with + against))) return "";
  const std::string& unit = settings.force_unit;
  return fmt::format(
      "the deeper the tool goes, the more the force helps it in, up to {:.3g} {}: is its sign turned? "
      "--map 'force=COLUMN[-1 {}]' turns it",
      largest, unit, unit);
}

/// Rows of an encoder that has slipped for a moment.
std::string positions_that_jump(const AxisSeries& series) {
  std::size_t found = 0;
  std::size_t at = 0;
  double highest = 0.0;
  each_jump_and_back(series.penetration, [&](std::size_t row, double height) {
    ++found;
    if (height > highest) at = row;
    highest = std::max(highest, height);
  });
  if (found == 0) return "";
  const auto [least, most] = std::ranges::minmax_element(series.penetration);
  return fmt::format(
      "the position jumps there and back in {}, most of all at {:.6g} s by {:.2g} % of its range: laws make "
      "wrong forces of it; take it out of the file that was imported",
      found == 1 ? "one row" : fmt::format("{} rows", found), series.time_s[at],
      100.0 * highest / (*most - *least));
}

/// Rows that are missing for so long that nobody knows how the tool went.
struct Gap {
  std::size_t before = 0;  ///< its last row
  double seconds = 0.0;
  RowSpan blind;  ///< the rows after it in which the tissue may remember what is missing
};

constexpr double steps_of_gap = 20.0;

/// Whether `row` and the one before are of a hold whose rows are written more and more sparsely: several rows
/// on either side of the step follow each other as slowly, and the tool stands still all the while.
bool is_sparse_hold(const AxisSeries& series, std::size_t row, double range) {
  constexpr std::size_t several = 4;
  constexpr double still = 0.01;  // of the range
  const auto& time_s = series.time_s;
  const double gap_s = time_s[row] - time_s[row - 1];
  const auto holds = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (std::abs(series.penetration[i] - series.penetration[row]) > still * range) return false;
      if (i > begin && steps_of_gap * (time_s[i] - time_s[i - 1]) < gap_s) return false;
    }
    return true;
  };
  return (row + several < time_s.size() && holds(row - 1, row + several + 1)) ||
         (row > several && holds(row - several - 1, row + 1));
}

/// Tissue is taken to have forgotten where the tool is out of it, or nothing is felt.
std::vector<Gap> gaps_of(const AxisSeries& series, double felt) {
  if (series.time_s.empty()) return {};
  constexpr double least_s = 0.05;
  const double period_s = median_period(series.time_s);
  const auto ends = std::ranges::minmax(series.penetration);
  std::vector<Gap> gaps;
  for (std::size_t i = 1; i < series.time_s.size(); ++i) {
    const double gap_s = series.time_s[i] - series.time_s[i - 1];
    if (!(gap_s > std::max(least_s, steps_of_gap * period_s))) continue;
    if (is_sparse_hold(series, i, ends.max - ends.min)) continue;
    const std::size_t begin = std::max(i, gaps.empty() ? 0 : gaps.back().blind.end);
    std::size_t end = begin;
    while (end < series.force.size() && series.penetration[end] > 0.0 && std::abs(series.force[end]) > felt)
      ++end;
    gaps.push_back({.before = i - 1, .seconds = gap_s, .blind = {.begin = begin, .end = end}});
  }
  return gaps;
}

/// Rows that count and in which the tissue may remember what is missing count no more, but where that were
/// half of them or more.
void leave_out_what_remembers_gaps(AxisSeries& series, double felt, CountedRows& counted) {
  const std::vector<Gap> gaps = gaps_of(series, felt);
  if (gaps.empty()) return;
  std::vector<std::uint8_t> counts(series.counts);
  counts.resize(series.force.size(), 1);
  for (const Gap& gap : gaps) {
    const auto begin = counts.begin() + static_cast<std::ptrdiff_t>(gap.blind.begin);
    std::fill(begin, begin + static_cast<std::ptrdiff_t>(gap.blind.end - gap.blind.begin), std::uint8_t{0});
  }
  const auto left = static_cast<std::size_t>(std::ranges::count(counts, 1));
  if (2 * left < counted.rows || left < fewest_counted) return;
  series.counts = std::move(counts);
  counted.rows = left;
}

/// Over a gap a law with a memory sees a straight line.
std::string gaps_in_time(const AxisSeries& series, double felt) {
  const std::vector<Gap> gaps = gaps_of(series, felt);
  if (gaps.empty()) return "";
  const Gap& longest = *std::ranges::max_element(gaps, {}, &Gap::seconds);
  std::size_t blind = 0;
  std::size_t counted = 0;
  for (const Gap& gap : gaps) {
    blind += gap.blind.end - gap.blind.begin;
    for (std::size_t row = gap.blind.begin; row < gap.blind.end; ++row)
      counted += series.counts.empty() || series.counts[row] != 0 ? 1 : 0;
  }
  const std::string missing =
      fmt::format("rows are missing {}, for {:.3g} s from {:.6g} s on",
                  gaps.size() == 1 ? "once" : fmt::format("{} times, the longest", gaps.size()),
                  longest.seconds, series.time_s[longest.before]);
  if (blind == 0) return missing + "; the tool is out of the tissue after that";
  if (counted == 0)
    return fmt::format(
        "{}: nobody knows what tissue remembers of it, and the {} rows until the tool is free again count "
        "neither in fits nor in errors (--rows all takes them)",
        missing, blind);
  return missing +
         ": a law with a memory goes along a straight line there, errs for as long as it remembers, and is "
         "not chosen for it; fit what lies before or after alone";
}

/// A force that was sampled more slowly than it was written.
std::string held_force(const AxisSeries& series) {
  const auto held = rows_held(series.force);
  if (!held || series.time_s.size() < 2) return "";
  const double period_s =
      (series.time_s.back() - series.time_s.front()) / static_cast<double>(series.time_s.size() - 1);
  const double rate_hz = 1.0 / (static_cast<double>(*held) * period_s);
  return fmt::format(
      "the force changes only every {} rows: it was sampled at {:.4g} Hz and held, and laws are fitted to "
      "its "
      "steps as if they were the tissue's; take it at its own rate ('kerf import --resample {:.4g}')",
      *held, rate_hz, rate_hz);
}

/// Whether the motion itself has a corner in a row, as where a dozen rows make a stroke: so has the force
/// then. Steps of a coarse encoder are smaller (5 % of the range in a recording at 333 Hz by 0.25 degrees).
bool turns_sharply(const AxisSeries& series, std::size_t row, double range) {
  constexpr double sharp = 0.08;  // of the range
  const auto& depth = series.penetration;
  return std::abs(depth[row - 1] - 2.0 * depth[row] + depth[row + 1]) > sharp * range;
}

/// Single rows that say nothing of a tissue, and much of every error.
std::string single_rows(const AxisSeries& series, const fitting::FitOptions& settings) {
  constexpr double noteworthy = 0.5;  // of the JND
  const auto counts = [&](std::size_t row) { return series.counts.empty() || series.counts[row] != 0; };
  std::vector<double> sizes;
  each_second_difference(series.force, counts, [&](double size) { sizes.push_back(size); });
  if (sizes.empty()) return "";
  const double noise = noise_of_second_differences(quantile(std::move(sizes), 0.5));
  const auto ends = std::ranges::minmax(series.penetration);
  std::size_t found = 0;
  std::size_t at = 0;
  double highest = 0.0;
  double squares = 0.0;
  each_single_row(series.force, counts, noise, [&](std::size_t row, double height) {
    if (turns_sharply(series, row, ends.max - ends.min)) return;
    ++found;
    squares += height * height;
    if (height > highest) at = row;
    highest = std::max(highest, height);
  });
  double counted = 0.0;
  double all_squares = 0.0;
  for (std::size_t row = 0; row < series.force.size(); ++row) {
    if (!counts(row)) continue;
    counted += 1.0;
    all_squares += series.force[row] * series.force[row];
  }
  if (2.0 * highest * highest > all_squares) return "";  // which no fit takes
  const double error = std::sqrt(squares / counted);
  if (!(error > noteworthy * settings.jnd.at(fitting::rms_of(fitted_view(series))))) return "";
  return fmt::format(
      "{} out from both neighbours, most of all at {:.6g} s by {:.3g} {}: that alone makes an error of "
      "{:.3g} {}; "
      "take it out of the file that was imported, or leave its cycle out (--cycles)",
      found == 1 ? "one row stands" : fmt::format("{} single rows stand", found), series.time_s[at], highest,
      settings.force_unit, error, settings.force_unit);
}

/// By time, since rows that are not finite are no part of a series. Returns how many are left.
std::size_t leave_out_rows(const schema::Recording& recording, const std::vector<RowSpan>& spans,
                           AxisSeries& series) {
  series.counts.resize(series.force.size(), 1);
  auto row = series.time_s.begin();
  for (const RowSpan& span : spans) {
    row = std::lower_bound(row, series.time_s.end(), recording.time.at(span.begin));
    for (; row != series.time_s.end() && *row <= recording.time.at(span.end - 1); ++row)
      series.counts[static_cast<std::size_t>(row - series.time_s.begin())] = 0;
  }
  return static_cast<std::size_t>(std::ranges::count(series.counts, 1));
}

}  // namespace

CountedRows mark_rows(const FitSource& source, const RowChoice& choice, double felt, AxisSeries& series) {
  CountedRows counted = mark_counted(series, *source.recording, source.axis, choice, felt);
  if (!source.not_the_tissue.empty())
    counted.rows = leave_out_rows(*source.recording, source.not_the_tissue, series);
  if (choice.rows == Counted::contact) leave_out_what_remembers_gaps(series, felt, counted);
  if (!source.not_the_tissue.empty() && counted.rows < fewest_counted)
    throw std::invalid_argument(
        fmt::format("in {} rows it is in contact where its blank has been, and {} are needed", counted.rows,
                    fewest_counted));
  return counted;
}

CountedSeries counted_series(const FitSource& source, const RowChoice& choice, const fitting::Jnd& jnd) {
  CountedSeries made{.series = fit_series(*source.recording, source.axis, source.contact), .counted = {}};
  if (made.series.force.empty()) throw std::invalid_argument("the recording has no row that is finite");
  made.counted = mark_rows(source, choice, jnd.threshold, made.series);
  return made;
}

std::string nothing_felt(const AxisSeries& series, const fitting::FitOptions& settings) {
  const double felt = fitting::rms_of(fitted_view(series));
  const double jnd = settings.jnd.at(felt);
  if (felt > jnd) return "";
  const std::string& unit = settings.force_unit;
  return fmt::format(
      "no force at all is within the JND of {:.3g} {} too, at a root mean square force of {:.3g} {}: what is "
      "fitted to it is noise",
      jnd, unit, felt, unit);
}

std::vector<std::string> doubts_of(const AxisSeries& series, const fitting::FitOptions& settings) {
  if (series.force.empty()) return {};
  std::vector<std::string> doubts;
  std::string of_the_force = nothing_felt(series, settings);
  if (of_the_force.empty()) of_the_force = nothing_changes(series, settings);
  if (of_the_force.empty()) of_the_force = helps_going_in(series, settings);
  if (of_the_force.empty()) of_the_force = begins_elsewhere(series, settings);
  for (std::string& doubt :
       std::array{std::move(of_the_force), positions_that_jump(series), drifting_force(series, settings),
                  clipped_force(series, settings), gaps_in_time(series, settings.jnd.threshold),
                  held_force(series), single_rows(series, settings)}) {
    if (!doubt.empty()) doubts.push_back(std::move(doubt));
  }
  if (settings.folds >= 2 && !series.cycle.empty() && *std::ranges::max_element(series.cycle) == 1) {
    doubts.emplace_back(
        "there is only one cycle: errors are held out by blocks of time within it, and say nothing of the "
        "next");
  }
  return doubts;
}

std::optional<double> contact_error_of(const FitSource& source) {
  const schema::Axis& axis = source.recording->axes.at(source.axis);
  if (source.contact.position != axis.contact_position || !std::isfinite(axis.contact_error))
    return std::nullopt;
  return axis.contact_error;
}

std::string contact_without_error(const FitSource& source) {
  if (source.contact.position != source.recording->axes.at(source.axis).contact_position ||
      contact_error_of(source))
    return "";
  return "penetration is counted from where the force was found to begin, by how much that may be off is not "
         "known: intervals take it as exact, and are too narrow; 'kerf prepare --onset' anew says how much";
}

std::string rows_left_out(const AxisSeries& series) {
  if (series.left_out == 0) return "";
  return fmt::format("{} rows are not finite and are left out", series.left_out);
}

}  // namespace kerf::bench

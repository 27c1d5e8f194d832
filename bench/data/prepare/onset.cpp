#include "prepare/onset.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <fmt/core.h>

#include "prepare/free_level.h"
#include "prepare/hinge.h"
#include "signal/quantiles.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

constexpr std::size_t fewest_lead_rows = 20;
// How much faster the level follows in the first look, which does not know it yet: it must not lag behind a
// drift.
constexpr double early_quickness = 5.0;

std::vector<bool> rows_within(std::span<const double> time_s, std::span<const TimeSpan> spans) {
  std::vector<bool> inside(time_s.size(), false);
  for (const TimeSpan& span : spans) {
    bool any = false;
    for (std::size_t row = 0; row < time_s.size(); ++row) {
      if (time_s[row] < span.begin_s || time_s[row] > span.end_s) continue;
      inside[row] = true;
      any = true;
    }
    if (any) continue;
    throw std::invalid_argument(
        fmt::format("--free {:g}:{:g} holds no row; the recording runs from {:g} to {:g} s", span.begin_s,
                    span.end_s, time_s.empty() ? 0.0 : time_s.front(), time_s.empty() ? 0.0 : time_s.back()));
  }
  return inside;
}

std::vector<bool> outside(std::size_t rows, std::span<const RowSpan> spans, std::span<const double> time_s,
                          double margin_s) {
  std::vector<bool> free(rows, true);
  for (const RowSpan& span : spans) {
    const double from_s = time_s[span.begin] - margin_s;
    const double to_s = time_s[span.end - 1] + margin_s;
    for (std::size_t row = span.begin; row > 0 && time_s[row - 1] >= from_s; --row) free[row - 1] = false;
    for (std::size_t row = span.begin; row < rows && time_s[row] <= to_s; ++row) free[row] = false;
  }
  return free;
}

/// Mean of the rows within half a window of each one.
std::vector<double> moving_mean(std::span<const double> time_s, std::span<const double> values,
                                double window_s) {
  const double reach_s = 0.5 * window_s * (1.0 + 1e-6);  // a neighbour on the very edge counts
  std::vector<double> sums{0.0};
  for (const double value : values) sums.push_back(sums.back() + value - values.front());
  std::vector<double> means;
  std::size_t begin = 0;
  std::size_t end = 0;
  for (std::size_t row = 0; row < values.size(); ++row) {
    while (time_s[row] - time_s[begin] > reach_s) ++begin;
    while (end < values.size() && time_s[end] - time_s[row] <= reach_s) ++end;
    means.push_back(values.front() + (sums[end] - sums[begin]) / static_cast<double>(end - begin));
  }
  return means;
}

/// The standard deviation of vectors about zero, for each component: from all of them, or robustly.
double scatter_of(std::vector<double> lengths, std::size_t components, bool robust) {
  if (!robust) {
    double squares = 0.0;
    for (const double length : lengths) squares += length * length;
    return std::sqrt(squares / static_cast<double>(lengths.size() * components));
  }
  // The median length of a normal vector of one, two, three components of unit variance.
  return median(std::move(lengths)) / (components == 1 ? 0.6745 : components == 2 ? 1.1774 : 1.5382);
}

void check(const ContactSignal& signal) {
  const std::size_t rows = signal.time_s.size();
  if (rows <= fewest_lead_rows) {
    throw std::invalid_argument(fmt::format(
        "{} rows are too few to look for contacts; more than {} are needed", rows, fewest_lead_rows));
  }
  for (std::size_t row = 0; row < rows; ++row) {
    bool finite = std::isfinite(signal.time_s[row]);
    for (const auto& component : signal.components) finite = finite && std::isfinite(component[row]);
    if (finite) continue;
    throw std::invalid_argument(
        fmt::format("row {} of {} is not finite; --drop-gaps leaves such rows out", row, signal.name));
  }
}

/// The search under way: the signal, the free level at each row, and the thresholds about it.
class Search {
 public:
  Search(const ContactSignal& signal, const OnsetOptions& options)
      : signal_(signal), options_(options), rows_(signal.time_s.size()), level_(signal.components) {
    known_free_ = rows_within(signal.time_s, options.free);
    for (const auto& component : signal.components) {
      smooth_.push_back(moving_mean(signal.time_s, component, options.smoothing_s));
    }
    if (!options.free.empty()) return;
    for (std::size_t row = 0; row < rows_; ++row) {
      known_free_[row] =
          row < fewest_lead_rows || signal.time_s[row] - signal.time_s.front() <= options.lead_s;
    }
  }

  ContactsFound run() {
    take_level(known_free_);
    take_threshold(known_free_);
    std::vector<RowSpan> spans = declare(true);
    for (int pass = 0; pass < 2; ++pass) {
      // The slow foot of a contact, below the threshold, belongs to no level.
      std::vector<bool> free = outside(rows_, spans, signal_.time_s, options_.shortest_s);
      if (std::ranges::find(free, true) == free.end()) free = known_free_;
      take_level(free);
      take_threshold(options_.free.empty() ? free : known_free_);
      spans = declare(false);
    }
    std::size_t after_last = 0;
    for (const RowSpan& span : spans) {
      found_.contacts.push_back(refined(span, after_last));
      after_last = span.end;
    }
    return found_;
  }

 private:
  using Components = std::vector<std::vector<double>>;

  [[nodiscard]] double deviation(const Components& components, std::size_t row) const {
    double squares = 0.0;
    for (std::size_t c = 0; c < level_.size(); ++c)
      squares += std::pow(components[c][row] - level_[c][row], 2);
    return std::sqrt(squares);
  }
  [[nodiscard]] double deviation(std::size_t row) const { return deviation(smooth_, row); }

  void take_level(const std::vector<bool>& free) {
    for (std::size_t c = 0; c < level_.size(); ++c) {
      level_[c] = free_level(signal_.time_s, signal_.components[c], free, options_.baseline_s);
    }
  }

  /// Rows that are known to be free count with all their scatter, those that were found to be, robustly.
  void take_threshold(const std::vector<bool>& free) {
    std::vector<double> smooth;
    std::vector<double> raw;
    double most = 0.0;
    for (std::size_t row = 0; row < rows_; ++row) {
      most = std::max(most, deviation(row));
      if (!free[row]) continue;
      smooth.push_back(deviation(row));
      raw.push_back(deviation(signal_.components, row));
    }
    const bool robust = options_.free.empty();
    found_.noise = scatter_of(std::move(raw), level_.size(), robust);
    const double smooth_noise = scatter_of(std::move(smooth), level_.size(), robust);
    // A force without any noise was simulated, and its rounding is no contact.
    found_.threshold = std::max({options_.sigmas * smooth_noise, options_.least, 1e-4 * most});
  }

  /// Contacts by the two thresholds. `following`: outside of them the level follows the force.
  std::vector<RowSpan> declare(bool following) {
    // While the level is not well known, a threshold of the unsmoothed noise.
    const double threshold =
        following ? std::max(found_.threshold, options_.sigmas * found_.noise) : found_.threshold;
    const double release = options_.release_share * threshold;
    const auto& time_s = signal_.time_s;
    std::vector<RowSpan> spans;
    bool touching = false;
    for (std::size_t row = 0; row < rows_; ++row) {
      if (following && row > 0 && !known_free_[row]) {
        for (auto& level : level_) level[row] = level[row - 1];
      }
      const double d = deviation(row);
      if (!touching && d > threshold) {
        touching = true;
        spans.push_back({.begin = row, .end = row + 1});
      }
      if (touching && d > release) spans.back().end = row + 1;
      touching = touching && time_s[row] - time_s[spans.back().end - 1] <= options_.shortest_s;
      if (!following || row == 0 || touching || d > release || known_free_[row]) continue;
      const double share =
          -std::expm1(-early_quickness * (time_s[row] - time_s[row - 1]) / options_.baseline_s);
      for (std::size_t c = 0; c < level_.size(); ++c) {
        level_[c][row] += share * (smooth_[c][row] - level_[c][row]);
      }
    }
    std::erase_if(spans, [&](const RowSpan& span) {
      return span.end - span.begin < 3 || time_s[span.end - 1] - time_s[span.begin] < options_.shortest_s;
    });
    for (RowSpan& span : spans) trim(span);
    return spans;
  }

  /// The moving mean reaches beyond a contact's ends by half its window.
  void trim(RowSpan& span) const {
    const double least = std::max(options_.release_share * found_.threshold, 2.0 * found_.noise);
    const auto is_below = [&](std::size_t row) { return deviation(signal_.components, row) < least; };
    const double from_s = signal_.time_s[span.begin] + 0.5 * options_.smoothing_s;
    const double to_s = signal_.time_s[span.end - 1] - 0.5 * options_.smoothing_s;
    while (span.begin + 1 < span.end && is_below(span.begin) && signal_.time_s[span.begin] < from_s)
      ++span.begin;
    while (span.begin + 1 < span.end && is_below(span.end - 1) && signal_.time_s[span.end - 1] > to_s)
      --span.end;
  }

  [[nodiscard]] ContactFound refined(const RowSpan& declared, std::size_t after_last) const;
  [[nodiscard]] std::vector<double> along_contact(const RowSpan& window, std::size_t declared) const;
  [[nodiscard]] std::size_t place_onset(ContactFound& contact, const RowSpan& window,
                                        std::span<const double> force, double share) const;

  const ContactSignal& signal_;
  const OnsetOptions& options_;
  std::size_t rows_;
  Components smooth_;  ///< what thresholds are asked of
  Components level_;
  std::vector<bool> known_free_;
  ContactsFound found_;
};

ContactFound Search::refined(const RowSpan& declared, std::size_t after_last) const {
  ContactFound contact{.rows = declared, .onset_s = signal_.time_s[declared.begin]};
  std::size_t peak = declared.begin;
  for (std::size_t row = declared.begin; row < declared.end; ++row) {
    if (deviation(row) > deviation(peak)) peak = row;
  }
  contact.peak = deviation(peak);
  // The rise: clear of threshold and noise, but not beyond the peak; then free rows twice as long before.
  std::size_t end = declared.begin + 1;
  const double clear = std::max(3.0 * found_.threshold, 15.0 * found_.noise);
  while (end < peak && deviation(end) < clear) ++end;
  end = std::min(std::max(end + 1, declared.begin + 4), declared.end);
  const std::size_t reach = std::max<std::size_t>(20, 2 * (end - declared.begin));
  const std::size_t begin = std::max(after_last, declared.begin - std::min(reach, declared.begin));
  RowSpan window{.begin = begin, .end = end};
  if (!signal_.position.empty()) {
    contact.onset_position = signal_.position[declared.begin];
  }
  // Where the noise happened to cross must not choose the rows: the second time the fitted ramp does.
  const auto placed = [&](ContactFound& which, double share) {
    const std::size_t clear_row = place_onset(which, window, along_contact(window, declared.begin), share);
    window.end = std::min(std::max(clear_row, declared.begin + 4), declared.end);
  };
  placed(contact, 1.0);
  placed(contact, 0.5);
  ContactFound lower;
  placed(lower, 1.0);
  contact.bend = contact.onset_position - lower.onset_position;
  const double variance = lower.onset_position_error * lower.onset_position_error -
                          contact.onset_position_error * contact.onset_position_error;
  contact.bend_error = variance < 0.0 ? 0.0 : std::sqrt(variance);  // NaN where either is
  if (!signal_.position.empty()) contact.travel = signal_.position[peak] - contact.onset_position;
  const auto first = std::lower_bound(signal_.time_s.begin(), signal_.time_s.end(), contact.onset_s);
  contact.rows.begin = std::min(static_cast<std::size_t>(first - signal_.time_s.begin()), declared.begin);
  return contact;
}

/// The deviation from the free level in the direction that it has in this contact.
std::vector<double> Search::along_contact(const RowSpan& window, std::size_t declared) const {
  std::vector<double> direction;
  for (std::size_t c = 0; c < level_.size(); ++c) {
    double sum = 0.0;
    for (std::size_t row = declared; row < window.end; ++row)
      sum += signal_.components[c][row] - level_[c][row];
    direction.push_back(sum);
  }
  const double length =
      std::sqrt(std::inner_product(direction.begin(), direction.end(), direction.begin(), 0.0));
  std::vector<double> force;
  for (std::size_t row = window.begin; row < window.end; ++row) {
    double along = 0.0;
    for (std::size_t c = 0; c < level_.size(); ++c) {
      along += direction[c] / length * (signal_.components[c][row] - level_[c][row]);
    }
    force.push_back(along);
  }
  return force;
}

/// Sets the onset from the rows of the window; returns the row at which the ramp found rises to a share of
/// what is clear of the noise.
std::size_t Search::place_onset(ContactFound& contact, const RowSpan& window, std::span<const double> force,
                                double share) const {
  const std::span<const double> time_s(signal_.time_s.data() + window.begin, force.size());
  std::vector<double> position;
  if (!signal_.position.empty()) {
    const auto begin = signal_.position.begin() + static_cast<std::ptrdiff_t>(window.begin);
    position.assign(begin, begin + static_cast<std::ptrdiff_t>(force.size()));
  }
  double travelled = 0.0;
  for (std::size_t i = 1; i < position.size(); ++i) travelled += std::abs(position[i] - position[i - 1]);
  const double net_travel = position.empty() ? 0.0 : position.back() - position.front();
  const bool one_direction = travelled > 0.0 && std::abs(net_travel) > 0.95 * travelled;
  const double sign = net_travel > 0.0 ? 1.0 : -1.0;
  std::vector<double> u(time_s.begin(), time_s.end());
  for (std::size_t i = 0; one_direction && i < u.size(); ++i) {
    // An encoder may step back by one; the hinge asks for order.
    u[i] = i > 0 ? std::max(sign * position[i], u[i - 1]) : sign * position[i];
  }
  const Hinge hinge = fit_hinge(u, force);
  if (!hinge.found) return window.end;
  contact.refined = true;
  if (one_direction) {
    const auto above = std::upper_bound(u.begin(), u.end(), hinge.corner) - u.begin();
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above, 1, static_cast<std::ptrdiff_t>(u.size()) - 1));
    const double between =
        u[i] > u[i - 1] ? std::clamp((hinge.corner - u[i - 1]) / (u[i] - u[i - 1]), 0.0, 1.0) : 1.0;
    contact.onset_position = sign * hinge.corner;
    contact.onset_position_error = hinge.corner_error;
    contact.onset_s = time_s[i - 1] + between * (time_s[i] - time_s[i - 1]);
    contact.onset_error_s = hinge.corner_error / std::abs(net_travel) * (time_s.back() - time_s.front());
  } else {
    contact.onset_s = hinge.corner;
    contact.onset_error_s = hinge.corner_error;
    if (!position.empty()) {
      contact.onset_position = interpolate(time_s, position, std::span(&hinge.corner, 1)).front();
    }
  }
  const double clear = share *
                       std::min(std::max(3.0 * found_.threshold, 15.0 * found_.noise), 0.7 * contact.peak) /
                       hinge.slope;
  std::size_t end = window.begin;
  while (end < contact.rows.end &&
         (one_direction ? sign * signal_.position[end] : signal_.time_s[end]) < hinge.corner + clear) {
    ++end;
  }
  return end;
}

}  // namespace

ContactsFound find_contacts(const ContactSignal& signal, const OnsetOptions& options) {
  check(signal);
  return Search(signal, options).run();
}

std::optional<ContactPlace> place_of(std::span<const ContactFound> contacts) {
  const double of_hertz = 1.0 / (1.0 - std::exp2(-2.0 / 3.0));
  std::vector<double> positions;
  double travel = 0.0;
  double squares = 0.0;
  double bend = 0.0;
  double bend_squares = 0.0;
  double told = 0.0;  // contacts whose error is known
  for (const ContactFound& contact : contacts) {
    positions.push_back(contact.onset_position);
    travel += contact.travel;
    if (!std::isfinite(contact.onset_position_error) || !std::isfinite(contact.bend_error)) continue;
    told += 1.0;
    squares += std::pow(contact.onset_position_error, 2);
    bend += contact.bend;
    bend_squares += std::pow(contact.bend_error, 2);
  }
  if (travel == 0.0) return std::nullopt;
  ContactPlace place{.position = median(positions), .direction = travel > 0.0 ? 1.0 : -1.0};
  if (told == 0.0) return place;
  const auto n = static_cast<double>(positions.size());
  const double mean = std::accumulate(positions.begin(), positions.end(), 0.0) / n;
  double scatter = 0.0;
  for (const double position : positions) scatter += std::pow(position - mean, 2) / std::max(1.0, n - 1.0);
  const double of_middle = n > 2.0 ? 0.5 * std::numbers::pi : 1.0;
  const double by_chance = of_middle * std::max(squares / told, scatter) / n;
  const double bent = std::max(0.0, std::pow(bend / told, 2) - bend_squares / told / told);
  place.error = std::sqrt(by_chance + of_hertz * of_hertz * bent);
  return place;
}

std::vector<bool> free_rows(std::span<const double> time_s, const ContactsFound& found,
                            std::span<const TimeSpan> free, double margin_s) {
  if (!free.empty()) return rows_within(time_s, free);
  std::vector<RowSpan> spans;
  for (const ContactFound& contact : found.contacts) spans.push_back(contact.rows);
  return outside(time_s.size(), spans, time_s, margin_s);
}

}  // namespace kerf::bench

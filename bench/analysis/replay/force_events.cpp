#include "replay/force_events.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <stdexcept>

#include "replay/force_noise.h"

namespace kerf::bench {
namespace {

struct Sample {
  double time_s;
  double size;
};

/// Contact and release.
class ContactFinder {
 public:
  explicit ContactFinder(double threshold) : threshold_(threshold) {}
  void process(const Sample& now, std::vector<ForceEvent>& events) {
    const bool crossed = touching_ ? now.size < 0.5 * threshold_ : now.size > threshold_;
    if (!crossed) return;
    touching_ = !touching_;
    events.push_back({.kind = touching_ ? ForceEventKind::contact : ForceEventKind::release,
                      .time_s = now.time_s,
                      .size = 0.0});
  }

 private:
  double threshold_;
  bool touching_ = false;
};

/// Drops, by the largest size within the window before each sample, beyond what noise alone makes of a force.
class DropFinder {
 public:
  DropFinder(const ForceEventOptions& options, double noise)
      : options_(options), by_noise_(widest_by_noise * noise) {}
  void process(const Sample& now, std::vector<ForceEvent>& events) {
    while (!peaks_.empty() && peaks_.front().time_s < now.time_s - options_.window_s * (1.0 + 1e-9))
      peaks_.pop_front();
    while (!peaks_.empty() && peaks_.back().size <= now.size) peaks_.pop_back();
    peaks_.push_back(now);
    const double peak = peaks_.front().size;
    const double fall = peak - now.size - by_noise_;
    if (!falling_ && fall > options_.jnd.at(peak)) {
      falling_ = true;
      top_ = peak;
      drop_ = events.size();
      events.push_back({.kind = ForceEventKind::drop, .time_s = now.time_s, .size = peak - now.size});
    } else if (falling_) {
      events[drop_].size = std::max(events[drop_].size, top_ - now.size);
      falling_ = fall >= 0.5 * options_.jnd.at(peak);
    }
  }

 private:
  // Peak to peak: in a million windows of some samples one of white noise is wider by a few percent.
  static constexpr double widest_by_noise = 8.0;

  ForceEventOptions options_;
  double by_noise_;
  std::deque<Sample> peaks_;  // sizes that decrease
  bool falling_ = false;
  double top_ = 0.0;
  std::size_t drop_ = 0;
};

std::vector<double> times_of(std::span<const ForceEvent> events, ForceEventKind kind) {
  std::vector<double> times;
  for (const ForceEvent& event : events) {
    if (event.kind == kind) times.push_back(event.time_s);
  }
  return times;
}

struct Pair {
  std::size_t recorded;
  std::size_t rendered;
  double late_s;
};

EventMatch match(const std::vector<double>& recorded, const std::vector<double>& rendered, double within_s) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    auto j = static_cast<std::size_t>(
        std::lower_bound(rendered.begin(), rendered.end(), recorded[i] - within_s) - rendered.begin());
    for (; j < rendered.size() && rendered[j] <= recorded[i] + within_s; ++j)
      pairs.push_back({.recorded = i, .rendered = j, .late_s = rendered[j] - recorded[i]});
  }
  std::ranges::stable_sort(pairs, {}, [](const Pair& pair) { return std::abs(pair.late_s); });
  std::vector<bool> recorded_taken(recorded.size());
  std::vector<bool> rendered_taken(rendered.size());
  EventMatch result{.recorded = recorded.size(), .rendered = rendered.size(), .late_s = {}};
  for (const Pair& pair : pairs) {
    if (recorded_taken[pair.recorded] || rendered_taken[pair.rendered]) continue;
    recorded_taken[pair.recorded] = rendered_taken[pair.rendered] = true;
    result.late_s.push_back(pair.late_s);
  }
  return result;
}

}  // namespace

std::vector<ForceEvent> find_force_events(std::span<const double> time_s, std::span<const double> force,
                                          const ForceEventOptions& options) {
  if (time_s.size() != force.size()) throw std::invalid_argument("times and forces differ in number");
  ContactFinder contacts(options.contact > 0.0 ? options.contact : 2.0 * options.jnd.threshold);
  DropFinder drops(options, options.noise ? *options.noise : noise_of(force));
  std::vector<ForceEvent> events;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (!std::isfinite(force[i])) continue;
    const Sample now{.time_s = time_s[i], .size = std::abs(force[i])};
    contacts.process(now, events);
    drops.process(now, events);
  }
  return events;
}

double EventMatch::mean_s() const noexcept {
  return late_s.empty()
             ? 0.0
             : std::accumulate(late_s.begin(), late_s.end(), 0.0) / static_cast<double>(late_s.size());
}

double EventMatch::worst_s() const noexcept {
  double worst = 0.0;
  for (const double late : late_s) {
    if (std::abs(late) > std::abs(worst)) worst = late;
  }
  return worst;
}

std::array<EventMatch, 3> match_events(std::span<const ForceEvent> recorded,
                                       std::span<const ForceEvent> rendered, double within_s) {
  std::array<EventMatch, 3> all;
  for (std::size_t kind = 0; kind < all.size(); ++kind) {
    const auto which = static_cast<ForceEventKind>(kind);
    all[kind] = match(times_of(recorded, which), times_of(rendered, which), within_s);
  }
  return all;
}

}  // namespace kerf::bench

#include "stability/zwidth/wall_search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr std::size_t most_disturbed = 20;  // trials of a rung that are made anew

CycleDetector::Options window_of(const WallSearchOptions& options, double period_s) {
  constexpr double highest_of_half = 0.9;
  const auto ticks = static_cast<std::size_t>(std::lround(options.window_s / period_s));
  const auto bin_of = [&](double hz) { return static_cast<std::size_t>(std::ceil(hz * options.window_s)); };
  return {.ticks = ticks,
          .lowest_bin = std::max<std::size_t>(1, bin_of(options.lowest_hz)),
          .highest_bin = static_cast<std::size_t>(highest_of_half * 0.5 * static_cast<double>(ticks)),
          .false_alarms = options.false_alarms};
}

}  // namespace

void check(const WallSearchOptions& options, double period_s) {
  const auto demand = [](bool holds, const char* what, double value, const char* expected) {
    if (!holds) throw std::invalid_argument(fmt::format("{} is {}, expected {}", what, value, expected));
  };
  if (options.damping_n_s_per_m.empty()) throw std::invalid_argument("no damping to look for a wall at");
  for (const double damping : options.damping_n_s_per_m)
    demand(damping >= 0.0 && std::isfinite(damping), "a wall's damping", damping, "0 N·s/m or more");
  demand(options.softest_n_per_m > 0.0, "the softest wall", options.softest_n_per_m, "more than 0 N/m");
  demand(options.stiffest_n_per_m > options.softest_n_per_m && std::isfinite(options.stiffest_n_per_m),
         "the stiffest wall", options.stiffest_n_per_m, "more than the softest");
  demand(options.resolution > 0.0 && options.resolution < 1.0, "the resolution", options.resolution,
         "a share between 0 and 1");
  demand(options.false_alarms > 0.0 && options.false_alarms < 1.0, "the rate of false alarms",
         options.false_alarms, "a share between 0 and 1");
  demand(options.felt_n > 0.0, "the force that is felt", options.felt_n, "more than 0 N");
  demand(options.strike_n > 0.0, "the strike", options.strike_n, "more than 0 N");
  demand(options.repeats > 0, "the number of repeats", static_cast<double>(options.repeats), "1 or more");
  demand(options.shortest_s >= 3.0 * options.window_s, "the shortest trial", options.shortest_s,
         "three windows at least");
  demand(period_s > 0.0, "the period", period_s, "more than 0 s");
  const double designed_s = options.controller.device.period_s;
  demand(options.controller.controller == WallController::none || std::abs(designed_s - period_s) < 1e-9,
         "the period of the controller's device", designed_s, "that of the loop");
}

std::string_view name_of(SearchEnd end) noexcept {
  switch (end) {
    case SearchEnd::found:
      return "found";
    case SearchEnd::holds_throughout:
      return "holds throughout";
    case SearchEnd::holds_nowhere:
      return "holds nowhere";
    case SearchEnd::not_finished:
      break;
  }
  return "not finished";
}

double WallRung::boundary() const noexcept {
  if (held_n_per_m > 0.0 && failed_n_per_m > 0.0) return std::sqrt(held_n_per_m * failed_n_per_m);
  return std::max(held_n_per_m, failed_n_per_m);
}

WallSearch::WallSearch(const drivers::AxisInfo& axis, std::size_t number, double period_s,
                       const WallSearchOptions& options)
    : options_((check(options, period_s), options)),
      axis_(number),
      lever_(axis.lever),
      encoder_step_m_(axis.lever * axis.resolution),
      period_s_(period_s),
      wall_(options.controller),
      before_(window_of(options, period_s)),
      last_(window_of(options, period_s)) {
  constexpr double of_limit = 0.8;
  if (options_.stop_n == 0.0) options_.stop_n = of_limit * axis.force_limit;
  if (!(options_.stop_n > options_.strike_n)) {
    throw std::invalid_argument(fmt::format(
        "axis '{}': a trial stops at {:.3g} {}, which its strike of {:.3g} {} passes; give a weaker one",
        axis.name, options_.stop_n, axis.force_unit, options_.strike_n, axis.force_unit));
  }
  for (const double damping : options_.damping_n_s_per_m) rungs_.push_back({.damping_n_s_per_m = damping});
  begin_rung();
}

std::size_t WallSearch::ticks_of(double seconds) const noexcept {
  return static_cast<std::size_t>(std::lround(seconds / period_s_));
}

std::uint64_t WallSearch::max_ticks() const noexcept {
  const double longest_s = options_.rest_s + std::ldexp(options_.shortest_s, options_.extensions);
  const double range = std::log2(options_.stiffest_n_per_m / options_.softest_n_per_m);
  const double steps =
      2.0 * range + std::log2(std::max(1.0, range / std::log2(1.0 + options_.resolution))) + 6.0;
  const double trials = steps * static_cast<double>(options_.repeats) + static_cast<double>(most_disturbed);
  return static_cast<std::uint64_t>(static_cast<double>(rungs_.size()) * trials * longest_s / period_s_);
}

void WallSearch::begin_rung() noexcept {
  constexpr double of_the_last = 0.25;
  const double last = rung_ > 0 ? rungs_[rung_ - 1].held_n_per_m : 0.0;
  stiffness_ = std::clamp(of_the_last * last, options_.softest_n_per_m, options_.stiffest_n_per_m);
  confirming_ = false;
  repeat_ = 0;
}

double WallSearch::strike() const noexcept {
  const bool softly = confirming_ || repeat_ % 2 == 1;
  const double side = (repeat_ / 2) % 2 == 0 ? 1.0 : -1.0;
  return side * options_.strike_n * (softly ? options_.soft_strike : 1.0);
}

double WallSearch::within_a_step() const noexcept {
  constexpr double golden = 0.6180339887498949;  // its multiples fill the step evenly
  const double turn = golden * static_cast<double>(repeat_);
  return encoder_step_m_ * (turn - std::floor(turn));
}

void WallSearch::begin_trial(double position_m) noexcept {
  resting_ = false;
  is_disturbed_ = false;
  place_m_ = position_m + strike() / stiffness_ + within_a_step();
  tick_ = 0;
  extended_ = 0;
  look_tick_ = ticks_of(options_.shortest_s);
  before_.restart();
  last_.restart();
  wall_.begin({.stiffness_n_per_m = stiffness_, .damping_n_s_per_m = rungs_[rung_].damping_n_s_per_m});
  ++rungs_[rung_].trials;
}

WallSearch::Outcome WallSearch::judge() noexcept {
  found_ = last_.judge();
  if (!found_.is_significant || found_.rms <= options_.felt_n) return Outcome::held;
  const double since = found_.rms / before_.rms_at(found_.bin);
  if (since > options_.grows) return Outcome::failed;
  if (extended_ == options_.extensions) return since < options_.lasts ? Outcome::held : Outcome::failed;
  ++extended_;
  look_tick_ *= 2;
  std::swap(before_, last_);
  last_.restart();
  return Outcome::undecided;
}

Command WallSearch::step(const drivers::Sample& sample, double elapsed_s) noexcept {
  constexpr double late = 1.5;  // periods, from which on a tick was missed
  Command command;
  if (finished()) return command;
  const double position_m = lever_ * sample.position[axis_];
  const double speed_m_s = lever_ * sample.velocity[axis_];
  if (!std::exchange(started_, true)) origin_m_ = position_m;
  if (resting_) {
    if (tick_++ >= ticks_of(options_.rest_s)) {
      begin_trial(position_m);
    } else {
      command.force[axis_] =
          std::clamp(-options_.softest_n_per_m * (position_m - origin_m_), -options_.stop_n, options_.stop_n);
      return command;
    }
  }
  if (elapsed_s > late * period_s_ && tick_ > 0) is_disturbed_ = true;
  const double wall_n = wall_.step({.position_m = position_m - place_m_, .speed_m_s = speed_m_s});
  command.force[axis_] = wall_n;
  const std::size_t window = ticks_of(options_.window_s);
  if (extended_ == 0 && tick_ + 2 * window >= look_tick_) before_.add(wall_n);
  if (tick_ + window >= look_tick_) last_.add(wall_n);
  ++tick_;
  if (std::abs(wall_n) > options_.stop_n) {
    found_ = {};
    command.force[axis_] = 0.0;
    end_trial(false);
  } else if (tick_ == look_tick_) {
    const Outcome outcome = judge();
    if (outcome != Outcome::undecided) end_trial(outcome == Outcome::held);
  }
  return command;
}

void WallSearch::end_trial(bool held) noexcept {
  resting_ = true;
  tick_ = 0;
  WallRung& rung = rungs_[rung_];
  if (is_disturbed_) {
    if (++rung.disturbed < most_disturbed) return;
    return end_rung(SearchEnd::not_finished);
  }
  if (confirming_) {
    rung.hysteresis = held;
    return end_rung(rung.held_n_per_m > 0.0 ? SearchEnd::found : SearchEnd::holds_nowhere);
  }
  if (held && ++repeat_ < options_.repeats) return;
  repeat_ = 0;
  conclude(held);
}

void WallSearch::conclude(bool held) noexcept {
  WallRung& rung = rungs_[rung_];
  if (held) {
    rung.held_n_per_m = stiffness_;
    if (stiffness_ >= options_.stiffest_n_per_m) return end_rung(SearchEnd::holds_throughout);
  } else {
    rung.failed_n_per_m = stiffness_;
    rung.cycle_n = found_.rms;
    rung.cycle_hz = static_cast<double>(found_.bin) / options_.window_s;
  }
  const double good = rung.held_n_per_m;
  const double bad = rung.failed_n_per_m;
  if (bad == 0.0) {
    stiffness_ = std::min(2.0 * good, options_.stiffest_n_per_m);
  } else if (good == 0.0 && bad > options_.softest_n_per_m) {
    stiffness_ = std::max(0.5 * bad, options_.softest_n_per_m);
  } else if (good > 0.0 && bad > good * (1.0 + options_.resolution)) {
    stiffness_ = std::sqrt(good * bad);
  } else {
    stiffness_ = bad;
    confirming_ = true;
  }
}

void WallSearch::end_rung(SearchEnd end) noexcept {
  rungs_[rung_++].end = end;
  if (!finished()) begin_rung();
}

}  // namespace kerf::bench

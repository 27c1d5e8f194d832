#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"
#include "protocol/guide/guided_motion.h"
#include "protocol/plan.h"
#include "sealed/session_store.h"
#include "sealed/trials/adherence.h"

namespace kerf::bench {

/// Where a law is met by the tool.
struct TouchedAt {
  models::Contact contact;
  std::size_t axis = 0;  ///< of the device
  [[nodiscard]] bool by(const drivers::Axes& position) const noexcept {
    return contact.motion(position[axis], 0.0).penetration > 0.0;
  }
};

/// What the tick needs for one trial, made ready ahead of it.
struct TrialRendering {
  std::vector<LawRendering> laws;   ///< every law of the trial once, in the order of the pair
  std::vector<LawRendering> fresh;  ///< the same before their first tick, where they begin anew at switches
  std::vector<double> gains;
  std::vector<TouchedAt> touched;       ///< of each law, where a switch waits until the tool touches none
  std::optional<std::size_t> led_axis;  ///< of the device, along which the guide's target leads in this trial
  std::size_t slots = 0;
  std::array<std::uint8_t, max_slots> law_of{};  ///< which of the laws a slot plays
  std::vector<TraceRow> trace;                   ///< its memory is taken ahead: rows past it are not kept
  /// Of it, that are there: the tick stores it by std::atomic_ref, so that others may read them meanwhile.
  std::size_t rows = 0;
};

/// Renders the samples of a trial so that nothing but the force tells which of them plays.
///
///     F = sum over slots of w_s g F_law(s),   from w to the slot wanted linearly in ramp_s
///
/// Every law of the trial is computed in every tick, whichever is felt, so that a tick costs the same and a
/// law knows the path of the tool when it is switched to. All weights go along the same ramp: a switch begins
/// at any moment, from whatever the weights are then, and takes as long for every slot. A law that fails
/// makes the force zero for all of them alike.
///
/// Where states begin anew (`fresh`), every switch goes through one tick of zero force at least, in which all
/// laws are as before the trial; and it stays there as long as the tool touches one of them (`touched`).
///
/// A guide that is felt adds its force to that of the samples, the same for all of them. It comes within the
/// ramp from the first play() on and goes with let_go() or end(); what it was stands in the rows of the trace
/// (led_channels). Its clock begins with the first tick and knows nothing of trials.
///
/// operator() and record() are the tick's; the rest is for one other thread.
class BlindRendering {
 public:
  BlindRendering(double ramp_s, SwitchKind switching, std::optional<GuidedMotion> guide = {})
      : ramp_s_(ramp_s), switching_(switching), guide_(std::move(guide)) {}

  /// A trial, without force until play(). Only while idle(). It has to live until idle() is true again.
  void begin(TrialRendering& trial) noexcept;
  /// Goes softly to a slot; none: to zero force.
  void play(std::optional<std::size_t> slot) noexcept;
  /// The guide is felt no more in this trial.
  void let_go() noexcept { leads_.store(false, std::memory_order_relaxed); }
  /// Of the guide's clock, at the last tick.
  [[nodiscard]] double guide_time_s() const noexcept {
    return shown_guide_s_.load(std::memory_order_relaxed);
  }
  /// Goes softly to zero force and lets the trial go: idle() says when.
  void end() noexcept;
  [[nodiscard]] bool idle() const noexcept { return trial_.load(std::memory_order_acquire) == nullptr; }

  [[nodiscard]] Command operator()(const drivers::Sample& sample, double period_s) noexcept;
  void record(const schema::Row& row) noexcept;

 private:
  using Weights = std::array<double, max_slots>;
  static constexpr std::uint8_t nothing = 255;

  void move(double period_s) noexcept;
  void begin_anew(TrialRendering& trial, const drivers::Axes& position) noexcept;
  void lead(const TrialRendering& trial, const drivers::Sample& sample, double period_s,
            Command& command) noexcept;

  double ramp_s_;
  SwitchKind switching_;
  std::optional<GuidedMotion> guide_;
  std::atomic<TrialRendering*> trial_{nullptr};  ///< set by begin(), taken back by the tick
  std::atomic<std::uint8_t> wanted_{nothing};
  std::atomic<bool> ends_{false};
  std::atomic<bool> leads_{false};
  std::atomic<double> shown_guide_s_{0.0};
  // The tick's own.
  std::uint8_t towards_ = nothing;
  Weights from_{};
  Weights weights_{};
  double share_ = 1.0;                      ///< of the way from from_ to the slot that is wanted
  bool is_anew_ = true;                     ///< past the middle of that way
  double guide_s_ = 0.0;                    ///< of the tick to come
  double led_share_ = 0.0;                  ///< of the guide's force
  std::array<double, led_channels> led_{};  ///< of the last tick: time, target, force
};

}  // namespace kerf::bench

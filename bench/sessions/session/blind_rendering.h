#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"
#include "protocol/plan.h"
#include "sealed/session_store.h"

namespace kerf::bench {

/// What the tick needs for one trial, made ready ahead of it.
struct TrialRendering {
  std::vector<LawRendering> laws;  ///< every law of the trial once, in the order of the pair
  std::vector<double> gains;
  std::size_t slots = 0;
  std::array<std::uint8_t, max_slots> law_of{};  ///< which of the laws a slot plays
  std::vector<TraceRow> trace;                   ///< its memory is taken ahead: rows past it are not kept
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
/// operator() and record() are the tick's; the rest is for one other thread.
class BlindRendering {
 public:
  BlindRendering(double ramp_s, SwitchKind switching) noexcept : ramp_s_(ramp_s), switching_(switching) {}

  /// A trial, without force until play(). Only while idle(). It has to live until idle() is true again.
  void begin(TrialRendering& trial) noexcept;
  /// Goes softly to a slot; none: to zero force.
  void play(std::optional<std::size_t> slot) noexcept;
  /// Goes softly to zero force and lets the trial go: idle() says when.
  void end() noexcept;
  [[nodiscard]] bool idle() const noexcept { return trial_.load(std::memory_order_acquire) == nullptr; }

  [[nodiscard]] Command operator()(const drivers::Sample& sample, double period_s) noexcept;
  void record(const schema::Row& row) noexcept;

 private:
  using Weights = std::array<double, max_slots>;
  static constexpr std::uint8_t nothing = 255;

  void move(double period_s) noexcept;

  double ramp_s_;
  SwitchKind switching_;
  std::atomic<TrialRendering*> trial_{nullptr};  ///< set by begin(), taken back by the tick
  std::atomic<std::uint8_t> wanted_{nothing};
  std::atomic<bool> ends_{false};
  // The tick's own.
  std::uint8_t towards_ = nothing;
  Weights from_{};
  Weights weights_{};
  double share_ = 1.0;  ///< of the way from from_ to the slot that is wanted
};

}  // namespace kerf::bench

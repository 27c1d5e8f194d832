#pragma once

#include <cstdint>

namespace kerf::models {

/// Holding or cutting, by two thresholds of force:
///
///     elastic until |F| > F1, cutting until |F| < F0,  F0 < F1
///
/// Between the two the state stays as it is, so noise smaller than F1 - F0 never makes it chatter: one
/// crossing, one transition. With equal thresholds any noise does. Source: [Henry2004], section 3.5.
struct TwoThresholds {
  double release_n = 0.0;  ///< F0 [N], the tissue holds again below it
  double rupture_n = 0.0;  ///< F1 [N], it gives way above it; > F0

  struct State {
    bool cutting = false;
    std::uint32_t transitions = 0;
  };

  /// Whether the blade cuts after a force of this size.
  bool step(State& state, double force_n) const noexcept {
    if (state.cutting ? force_n < release_n : force_n > rupture_n) {
      state.cutting = !state.cutting;
      ++state.transitions;
    }
    return state.cutting;
  }
};

}  // namespace kerf::models

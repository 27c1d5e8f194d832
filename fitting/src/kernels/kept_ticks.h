#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace kerf::fitting {

/// A law whose state holds what it derived from the last period, and nothing else that depends on it.
template <typename State>
concept HoldsATick = requires(State state) {
  state.tick.loss;
  state.period_s;
  state.shortest_s;
};
/// The same in places for several arms, of which it has one.
template <typename State>
concept HoldsOneOfSeveralTicks = requires(State state) {
  state.tick[0].loss;
  state.period_s;
  state.shortest_s;
};
/// Two of them by turns.
template <typename State>
concept HoldsTwoTicks = requires(State state) {
  state.tick[state.current].period_s;
};

/// What a law derived from the periods of a recording, for when they come back: time stamps of whole
/// milliseconds go from one to another and back in nearly every sample, and each time the law would have to
/// take its exponentials again. Exactly what the law made, by exactly the same periods.
template <typename State>
class KeptTicks {
 public:
  /// Before a step of so long: false where the law has to find its tick by itself.
  bool recall(State& state, double period_s) noexcept {
    if constexpr (HoldsTwoTicks<State>) {
      auto& other = state.tick[1 - state.current];
      if (state.tick[state.current].period_s == period_s || other.period_s == period_s) return true;
      const Kept& kept = at(period_s);
      if (kept.period_s != period_s) return false;
      other = kept.tick;
    } else {
      if (state.period_s == period_s) return true;
      const Kept& kept = at(period_s);
      const double shortest_s = std::min(state.shortest_s, period_s);
      if (kept.period_s != period_s || kept.shortest_s != shortest_s) return false;
      state.period_s = period_s;
      state.shortest_s = shortest_s;
      tick_of(state) = kept.tick;
    }
    return true;
  }

  /// After a step that found it.
  void keep(State& state, double period_s) noexcept {
    Kept& kept = at(period_s);
    kept.period_s = period_s;
    kept.tick = tick_of(state);
    if constexpr (!HoldsTwoTicks<State>) kept.shortest_s = state.shortest_s;
  }

 private:
  static auto& tick_of(State& state) noexcept {
    if constexpr (HoldsTwoTicks<State>) {
      return state.tick[state.current];
    } else if constexpr (HoldsOneOfSeveralTicks<State>) {
      return state.tick[0];
    } else {
      return state.tick;
    }
  }
  using Tick = std::remove_cvref_t<decltype(tick_of(std::declval<State&>()))>;
  struct Kept {
    double period_s = 0.0;
    double shortest_s = 0.0;
    Tick tick{};
  };
  static constexpr int bits = 5;

  Kept& at(double period_s) noexcept {  // multiplicative hashing: periods differ in their last bits too
    const auto hash = std::bit_cast<std::uint64_t>(period_s) * 0x9E3779B97F4A7C15U;
    return kept_[static_cast<std::size_t>(hash >> (64 - bits))];
  }

  std::array<Kept, std::size_t{1} << bits> kept_{};
};

}  // namespace kerf::fitting

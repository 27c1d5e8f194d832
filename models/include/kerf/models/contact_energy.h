#pragma once

#include <algorithm>
#include <type_traits>

#include <kerf/models/choice.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Displacement of an element that a contact presses on [m]: none before it.
template <typename Signal>
[[nodiscard]] Signal pressed(Signal penetration) noexcept {
  return chosen(penetration > 0.0, penetration, Signal(0.0));
}

/// Force of a contact, which never pulls [N].
template <typename T>
[[nodiscard]] T pushing(const T& force) noexcept {
  return chosen(force < T(0), T(0), force);
}

/// Work of the force that a contact lets through, never below zero, over a travel along which the force of
/// its element is linear [J].
template <typename T, typename Travel>
[[nodiscard]] T felt_work(const T& from, const T& to, const Travel& travel) noexcept {
  const T least = std::min(from, to);
  const T most = std::max(from, to);
  if (most <= T(0)) return T(0);
  const T share = least < T(0) ? T(most / (most - least)) : T(1);
  return travel * share * (std::max(least, T(0)) + most) / T(2);
}

/// The tick of contact_step() in which an element may be strained by a pull. Apart, so that all others stay
/// as short as they are without it.
template <typename Element>
#if defined(__GNUC__)
[[gnu::noinline]]
#endif
auto drawn_step(const Element& element, typename Element::State& state, double x, double period_s) noexcept {
  using T = decltype(element.bilateral_step(state, x, period_s));
  const auto travel = static_cast<T>(x - state.penetration);
  T given = element.stored_energy(state);
  T force(0);
  if (travel == T(0)) {
    force = element.bilateral_step(state, x, period_s);
  } else {
    const T held = element.held_force(state);
    force = element.bilateral_step(state, x, period_s);
    const T at_once = force - element.held_force(state);
    given = std::max(T(0), given + felt_work(T(held + at_once), force, travel));
  }
  state.reachable = given < element.spring_energy(state) ? given : T(-1);
  return force;
}

/// One tick of a viscoelastic element as a contact that never pulls: the force of the element, of either
/// sign, and in `state.reachable` what the contact gives back at most where that is less than its springs
/// hold,
///
///     U[n] = min(V[n], U[n-1] + W[n])
///
/// V [J] is the energy of the springs and W the work that was felt. Withdrawn faster than it recovers, an
/// element is strained by a pull that nobody did: V rises by it, U does not. Where the tool goes in or rests,
/// or the force cannot fall below zero, U keeps up with V and is not reckoned with; nor is it with dual
/// numbers.
///
/// The element has bilateral_step(), spring_energy(), held_force() without the part that its dashpots have at
/// once, and least_force(), which it does not fall below on its way to x; its state has penetration and
/// reachable. @param x of the contact, >= 0
template <typename Element, typename Signal>
auto contact_step(const Element& element, typename Element::State& state, Signal x,
                  Signal period_s) noexcept {
  using T = decltype(element.bilateral_step(state, x, period_s));
  if constexpr (std::is_floating_point_v<T>) {
    const bool drawn = x < state.penetration && element.least_force(state, x, period_s) < T(0);
    if (state.started && (drawn || state.reachable >= T(0))) {
      return drawn_step(element, state, x, period_s);
    }
  }
  return element.bilateral_step(state, x, period_s);
}

/// Whether a viscoelastic element pulls as it pushes: a specimen that is gripped, glued or sewn, not touched.
[[nodiscard]] inline OptionInfo bilateral_option() {
  return {"bilateral", false,
          "the element pulls as it pushes, on either side of its rest; else it is touched"};
}

/// One tick of a viscoelastic element [N]: of a contact, which is none before it and never pulls, or of the
/// element itself.
template <typename Element, typename Signal>
auto element_step(const Element& element, typename Element::State& state, Signal penetration,
                  Signal period_s) noexcept {
  using T = decltype(element.bilateral_step(state, penetration, period_s));
  if (element.bilateral) return element.bilateral_step(state, penetration, period_s);
  return pushing(T(contact_step(element, state, pressed(penetration), period_s)));
}

}  // namespace kerf::models

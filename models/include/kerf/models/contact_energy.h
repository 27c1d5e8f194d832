#pragma once

#include <algorithm>
#include <type_traits>

namespace kerf::models {

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

/// One tick of a viscoelastic element as a contact that never pulls: the force of the element, of either
/// sign, and in `state.out_of_reach` what its springs hold but the contact does not give back,
///
///     U[n] = min(V[n], U[n-1] + W[n]),   out_of_reach = V - U
///
/// V [J] is the energy of the springs and W the work that was felt. Withdrawn faster than it recovers, an
/// element is strained by a pull that nobody did: V rises by it, U does not. While the tool goes in or rests
/// nothing is added to what is out of reach, and it is not reckoned with; nor are dual numbers.
///
/// The element has bilateral_step(), held_force() without the part that its dashpots have at once, and
/// spring_energy(); its state has penetration and out_of_reach. @param x of the contact, >= 0
template <typename Element>
auto contact_step(const Element& element, typename Element::State& state, double x,
                  double period_s) noexcept {
  using T = decltype(element.bilateral_step(state, x, period_s));
  if constexpr (std::is_floating_point_v<T>) {
    if (state.started && (x < state.penetration || state.out_of_reach > T(0))) {
      const auto travel = static_cast<T>(x - state.penetration);
      const T before = element.stored_energy(state);
      const T held = element.held_force(state);
      const T force = element.bilateral_step(state, x, period_s);
      const T at_once = force - element.held_force(state);
      const T given = before + felt_work(T(held + at_once), force, travel);
      state.out_of_reach = std::max(T(0), T(element.spring_energy(state) - std::max(T(0), given)));
      return force;
    }
  }
  return element.bilateral_step(state, x, period_s);
}

}  // namespace kerf::models

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include <kerf/models/choice.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Which branch of a closing-and-opening loop is felt, and how much of it ([Okamura2003], section 2.2 and
/// eqs. 4-5).
///
/// The penetration passes a first-order filter with the corner `velocity_corner` before it is differenced;
/// the sign of that velocity selects the branch. Two factors keep the force continuous in the hand:
///
///     s = min(1, reversal_scale |x - x_switch|) min(1, |v| / ramp_band)
///
/// with x_switch the penetration of the last reversal. Source: [Okamura2003]; the paper gives neither k_s nor
/// the width of the band. Zero switches each of the three off: the given velocity is then taken as it is, and
/// at zero velocity the last branch goes on, which is how a table is judged against a recording.
struct BranchSelector {
  double velocity_corner =
      0.0;  ///< corner of the velocity filter [rad/s], 10 in [Okamura2003]; 0: take motion.velocity
  double ramp_band = 0.0;       ///< |v| below which the force fades to zero [position/s]; 0: no band
  double reversal_scale = 0.0;  ///< k_s [1/position]; 0: the full force at once after a reversal

  template <typename Signal>
  struct StateOf {
    Signal filtered_penetration = 0.0;
    Signal switch_penetration = 0.0;
    Signal penetration = -std::numeric_limits<double>::infinity();
    int direction = 0;  ///< +1 closing, -1 opening, 0 before the first motion
    bool started = false;

    /// What the force goes on from, by name.
    template <typename Visit>
    void each(Visit&& visit) {
      visit("filtered_penetration", filtered_penetration);
      visit("switch_penetration", switch_penetration);
      visit("direction", direction);
      visit("started", started);
    }
  };
  using State = StateOf<double>;
  template <typename Signal>
  struct Branch {
    bool closing = true;
    Signal scale = 1.0;
  };

  /// The options of a law that has a BranchSelector, and how it is made from them.
  static std::vector<OptionInfo> options();
  static BranchSelector make(const OptionReader& reader);

  template <typename Signal>
  Branch<Signal> step(StateOf<Signal>& state, const std::type_identity_t<MotionOf<Signal>>& motion,
                      std::type_identity_t<Signal> period_s) const noexcept {
    using std::abs;
    using std::expm1;
    const Signal x = motion.penetration;
    state.penetration = x;
    if (!state.started) {
      state.filtered_penetration = x;
      state.switch_penetration = x;
      state.started = true;
    }
    Signal velocity = motion.velocity;
    if (velocity_corner > 0.0) {
      const Signal change = -expm1(-velocity_corner * period_s) * (x - state.filtered_penetration);
      state.filtered_penetration = state.filtered_penetration + change;
      velocity = change / period_s;
    }
    const int direction = velocity > 0.0 ? 1 : velocity < 0.0 ? -1 : state.direction;
    if (direction != state.direction) {
      state.switch_penetration = x;
      state.direction = direction;
    }
    Signal scale = 1.0;
    const Signal whole = 1.0;
    if (reversal_scale > 0.0)
      scale = lesser(whole, Signal(reversal_scale * abs(x - state.switch_penetration)));
    if (ramp_band > 0.0) scale = scale * lesser(whole, Signal(abs(velocity) / ramp_band));
    return {.closing = direction >= 0, .scale = scale};
  }
};

/// Most work that a law of two branches gives back from a penetration x, within its grid [J]:
///
///     U(x) = max(0, max over y < x of int_y^x F_open,  max over y > x of -int_x^y F_close)
///
/// A branch that resists gives nothing back. Before the grid nothing is held: a force that goes on there is a
/// bias. Both branches are linear between grid points.
/// @param place of grid point i < `points`, increasing; `force_at(closing, i)` of a branch there,
///        `force(closing, x)` anywhere
template <typename T, typename Place, typename ForceAt, typename Force>
[[nodiscard]] T recoverable_energy(double penetration, std::size_t points, Place&& place, ForceAt&& force_at,
                                   Force&& force) noexcept {
  const double x = std::max(penetration, static_cast<double>(place(0)));
  T most(0);
  struct Walk {
    T force{0};
    double at = 0.0;
    T sum{0};
  };
  const auto go = [&](Walk& walk, double to, T next) {
    const T half_way = static_cast<T>(0.5 * std::abs(to - walk.at));
    // The sum is largest at a grid point or where the force changes its sign.
    if (walk.force > T(0) && next < T(0)) {
      most = std::max(most, T(walk.sum + half_way * walk.force * walk.force / (walk.force - next)));
    }
    walk = {next, to, walk.sum + half_way * (walk.force + next)};
    most = std::max(most, walk.sum);
  };
  Walk opening{.force = force(false, x), .at = x};
  Walk closing{.force = -force(true, x), .at = x};
  for (std::size_t i = points; i-- > 0;) {
    if (place(i) < x) go(opening, place(i), force_at(false, i));
  }
  for (std::size_t i = 0; i < points; ++i) {
    if (place(i) > x) go(closing, place(i), -force_at(true, i));
  }
  return most;
}

}  // namespace kerf::models

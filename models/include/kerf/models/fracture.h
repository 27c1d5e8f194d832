#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/choice.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Cutting by fracture: the energy that deforms the tissue is paid back as a crack.
///
///     deformation:  F = alpha exp(beta d / L0),       dWe = dU
///     fracture:     one tick with F = 0 once U >= Uy, da = U / (Jc w)
///     cutting:      F = Jc w while v > 0,             dWe = dWs
///     free:         F = 0 until the tool meets the surface again
///
/// d is the depth under the surface, U = alpha L0 / beta (exp(beta d / L0) - 1) the elastic energy, Uy the
/// yield energy, Jc the fracture toughness, w the width of the blade, a the length of the crack. The tissue
/// yields where U reaches Uy, within a tick if need be, and all of Uy becomes crack. The crack then begins at
/// the tool: its tip, the new surface, lies where the tissue yielded or, if the crack ran further than that,
/// ahead of it by what it ran further; in the paper the tool stands much deeper than the crack is long. What
/// was left of the tick's travel is cut. While cutting, the tip moves with the tool; on v <= 0 the tip stays
/// and is the surface that is met next.
///
/// A hand trembles, and one tick at v <= 0 then ends the cut: to go on, the tissue has to be deformed to Uy
/// again. With the option `hysteresis` (h > 0, a length) the cut ends only once the tool has drawn back from
/// the tip by more than h. Until then there is no force behind the tip or on the way back, and Jc w again as
/// soon as the tool goes on at the tip.
///
/// The books are kept from the path itself, so that external work = stored + spent on crack at any tick.
///
/// Source: [Sepulveda2008], section 4.3 and fig. 7, after [MahvashHayward2001]; differs from the paper in
/// where the tip stands after the fracture, which the paper does not say; it has no hysteresis.
template <typename T>
struct Fracture {
  static constexpr std::string_view name = "fracture";
  static constexpr std::string_view equation =
      "F = alpha exp(beta d / L0) up to the energy Uy, one tick of fracture, then Jc w";
  static constexpr std::string_view position_unit = "m";
  static constexpr std::string_view force_unit = "N";
  static constexpr LawFacts facts{
      .search = Search::fracture,
      .searched_at_once = 5,
      .held = {"width"},
      .held_note =
          "'width' is held at 0.01 m: forces tell only its product with 'toughness', the force of cutting",
      .variants = {{.effects = {Effect::stiffening, Effect::cutting}}}};

  T amplitude{};            ///< alpha [N], > 0
  T exponent{};             ///< beta [1], > 0
  T yield_energy{};         ///< Uy [J], > 0
  T toughness{};            ///< Jc [J/m²], > 0
  T width{};                ///< w [m], > 0
  double thickness = 0.1;   ///< L0 [m], > 0
  double hysteresis = 0.0;  ///< h [m]

  enum class Mode : std::uint8_t { free, deformation, fracture, cutting };

  struct State {
    Mode mode = Mode::free;
    T surface{0.0};       ///< penetration at which tissue is met [m]
    T stored{0.0};        ///< U [J]
    T work{0.0};          ///< sum of dWe, done by the tool [J]
    T crack_energy{0.0};  ///< sum of dWs, spent on the crack [J]
    T crack_length{0.0};  ///< a [m]

    /// What the force goes on from, by name: the books are kept beside it.
    template <typename Visit>
    void each(Visit&& visit) {
      visit("mode", mode);
      visit("surface", surface);
    }
  };

  static std::vector<ParameterInfo> parameters(const Options&) {
    return {{"amplitude", Quantity::force, 1e-15, 1e6, Scale::logarithmic, "alpha, force at contact"},
            {"exponent", Quantity::ratio, 1e-6, 1e3, Scale::logarithmic,
             "beta, stiffening over the thickness L0"},
            {"yield_energy", Quantity::energy, 1e-12, 1e6, Scale::logarithmic, "Uy, stored at the fracture"},
            {"toughness", Quantity::toughness, 1e-6, 1e9, Scale::logarithmic, "Jc, energy per area of crack"},
            {"width", Quantity::length, 1e-9, 1e3, Scale::logarithmic, "w, of the blade"}};
  }
  static std::vector<OptionInfo> options() {
    return {{"thickness", 0.1, "L0, thickness of the sample [m]"},
            {"hysteresis", 0.0,
             "by which the tool draws back from the tip before the cut ends [m]; 0: at any v <= 0"}};
  }
  static Fracture make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    return {values[0],
            values[1],
            values[2],
            values[3],
            values[4],
            reader.number("thickness", 1e-9, 1e9),
            reader.number("hysteresis", 0.0, 1e9)};
  }

  /// Force while the crack grows, Jc w [N].
  [[nodiscard]] T cutting_force() const { return toughness * width; }
  /// How far a crack runs that all of Uy makes [m].
  [[nodiscard]] T crack_of_a_fracture() const { return yield_energy / cutting_force(); }
  /// Depth at which the stored energy reaches Uy [m].
  [[nodiscard]] T yield_depth() const {
    using std::log1p;
    return thickness / exponent * log1p(yield_energy * exponent / (amplitude * thickness));
  }

  /// Elastic energy of the deformation, U [J]: none while a crack grows.
  [[nodiscard]] T stored_energy(const State& state) const noexcept { return state.stored; }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T>) const noexcept {
    return step_through(state, motion, Stiffening{*this});
  }

  /// Tissue as it is deformed, alpha exp(beta d / L0).
  struct Stiffening {
    const Fracture& law;
    [[nodiscard]] T growth(const T& depth) const {  ///< exp(beta d / L0) - 1
      using std::expm1;
      return expm1(law.exponent * (depth / law.thickness));
    }
    [[nodiscard]] T energy(const T& growth) const {
      return law.amplitude * law.thickness / law.exponent * growth;
    }
    [[nodiscard]] T force(const T& growth) const { return law.amplitude * (growth + 1.0); }
    [[nodiscard]] T yield_depth() const { return law.yield_depth(); }
  };
  /// The same path, whatever the tissue is like that yields at Uy.
  template <typename Tissue>
  T step_through(State& state, const MotionOf<Signal<T>>& motion, const Tissue& tissue) const noexcept {
    const Signal<T> x = motion.penetration;
    if (state.mode == Mode::fracture) {
      state.mode = x < state.surface - hysteresis ? Mode::free : Mode::cutting;
    }
    if (state.mode == Mode::cutting && goes_on(state, motion)) {
      if (x < state.surface || motion.velocity <= 0.0) return T(0.0);  // behind the tip, or on the way back
      grow(state, cutting_force() * (x - state.surface));
      state.surface = T(x);
      return cutting_force();
    }
    if (state.mode == Mode::cutting) state.mode = Mode::free;
    return deform(state, x, tissue);
  }

 private:
  /// Whether a crack that grew may go on growing.
  [[nodiscard]] bool goes_on(const State& state, const MotionOf<Signal<T>>& motion) const noexcept {
    return motion.velocity > 0.0 || (hysteresis > 0.0 && motion.penetration >= state.surface - hysteresis);
  }
  template <typename Tissue>
  T deform(State& state, Signal<T> x, const Tissue& tissue) const noexcept {
    const T depth = x - state.surface;
    if (depth <= 0.0) {
      state.work = state.work - state.stored;
      state.stored = T(0.0);
      state.mode = Mode::free;
      return T(0.0);
    }
    const T growth = tissue.growth(depth);
    const T energy = tissue.energy(growth);
    if (energy < yield_energy) {
      state.work = state.work + energy - state.stored;
      state.stored = energy;
      state.mode = Mode::deformation;
      return tissue.force(growth);
    }
    // The tissue yielded at Uy, within the tick; what was left of the travel was cut.
    state.work = state.work - state.stored;  // grow() enters all of Uy, as crack
    state.stored = T(0.0);
    grow(state, yield_energy);
    const T yielded = state.surface + tissue.yield_depth();
    const T tip = state.surface + crack_of_a_fracture();
    state.surface = greater(yielded, tip);
    if (x > state.surface) {
      grow(state, cutting_force() * (x - state.surface));
      state.surface = T(x);
    }
    state.mode = Mode::fracture;
    return T(0.0);
  }
  void grow(State& state, T energy) const noexcept {
    state.work = state.work + energy;
    state.crack_energy = state.crack_energy + energy;
    state.crack_length = state.crack_length + energy / cutting_force();
  }
};

}  // namespace kerf::models

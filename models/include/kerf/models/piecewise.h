#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <kerf/models/branch.h>
#include <kerf/models/choice.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Segmented (piecewise-linear) empirical law over the penetration, continuous at its knots.
///
///     F(x) = F_i + (F_{i+1} - F_i) (x - x_i) / (x_{i+1} - x_i)   for x_i <= x <= x_{i+1}
///
/// With the option `loop` it has a second set of forces on the same knots for opening, and a BranchSelector
/// chooses between them; a positive force resists closing, so an opening branch that resists opening is
/// negative. Before the first knot the first force holds; past the last one the last trend goes on.
///
/// Source: [Okamura2003], section 3.2 (2 to 7 segments were enough for the hand).
template <typename T>
struct Piecewise {
  static constexpr std::string_view name = "piecewise";
  static constexpr std::string_view equation = "F linear between knots, closing and opening branch";
  static constexpr LawFacts facts{
      .search = Search::segments,
      .searched_at_once = 8,
      .from_data = {{"loop", From::cycles}},
      .size = {.option = "segments", .unit = "segment", .first = 1, .last = 12},
      .fineness = Fineness::segments,
      .in_float = true,
      .usual = 3,
      .charted = true,
      .variants = {{.options = {"loop=false"}, .sizes_from = 1, .from_size_2 = {Effect::stiffening}},
                   {.suffix = "-loop",
                    .options = {"loop=true"},
                    .effects = {Effect::loop},
                    .sizes_from = 1,
                    .from_size_2 = {Effect::stiffening},
                    .needs_cycles = true}},
      .rank = 2};
  static constexpr std::size_t max_segments = 16;

  std::size_t knots = 2;
  std::array<T, max_segments + 1> knot{};
  std::array<T, max_segments + 1> closing{};
  std::array<T, max_segments + 1> opening{};
  bool loop = false;
  BranchSelector selector;

  using State = BranchSelector::StateOf<Signal<T>>;

  static std::vector<OptionInfo> options() {
    auto all = BranchSelector::options();
    all.insert(all.begin(), {{"segments", 5.0, "number of linear segments, 1 to 16"},
                             {"loop", false, "opening has forces of its own"},
                             precision_option()});
    return all;
  }
  static std::vector<ParameterInfo> parameters(const Options& given) {
    const OptionReader reader(name, options(), given);
    const auto count = segments(reader) + 1;
    std::vector<ParameterInfo> all;
    const auto add = [&](const char* what, Quantity quantity, double bound, const char* meaning) {
      for (std::size_t i = 0; i < count; ++i) {
        all.push_back({std::string(what) + "[" + std::to_string(i) + "]", quantity, -bound, bound,
                       Scale::linear, meaning});
      }
    };
    add("knot", Quantity::position, 1e6, "penetration of a knot, increasing");
    add("closing", Quantity::force, 1e6, "force at the knot while closing");
    if (reader.flag("loop")) add("opening", Quantity::force, 1e6, "force at the knot while opening");
    return all;
  }
  static Piecewise make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    Piecewise law;
    law.knots = segments(reader) + 1;
    law.loop = reader.flag("loop");
    law.selector = BranchSelector::make(reader);
    for (std::size_t i = 0; i < law.knots; ++i) {
      law.knot[i] = values[i];
      law.closing[i] = values[law.knots + i];
      law.opening[i] = law.loop ? values[2 * law.knots + i] : law.closing[i];
      if (i > 0 && !(law.knot[i - 1] < law.knot[i])) {
        throw std::invalid_argument("law 'piecewise': knot[" + std::to_string(i) +
                                    "] must be greater than knot[" + std::to_string(i - 1) + "]");
      }
    }
    return law;
  }

  /// Force of one branch at a penetration [N].
  [[nodiscard]] T branch_force(bool is_closing, Signal<T> at) const noexcept {
    const auto penetration = static_cast<Input<T>>(at);
    const auto& force = is_closing ? closing : opening;
    if (knot[0] >= penetration) return force[0];
    const auto i = segment_of(knot, knots, penetration);
    const T& at_knot = entry(force, i);
    const T& from = entry(knot, i);
    return at_knot + (entry(force, i, 1) - at_knot) * ((penetration - from) / (entry(knot, i, 1) - from));
  }

  /// This law with an opening branch made from the closing of empty scissors, by default -1/2 of it: opening
  /// meets friction alone, and less of it ([Okamura2003], section 3.2).
  [[nodiscard]] Piecewise with_opening_from(
      const Piecewise& empty, double factor = -0.5) const noexcept requires std::is_floating_point_v<T> {
    Piecewise both = *this;
    both.loop = true;
    for (std::size_t i = 0; i < knots; ++i) {
      both.opening[i] = factor * empty.branch_force(true, knot[i]);
    }
    return both;
  }

  /// recoverable_energy() between the first knot and the last one [J]. Passive where the opening branch is
  /// nowhere above the closing one and the selector at once and whole: a ramp band and the factor after a
  /// reversal lessen also what is taken in, and the filter leaves the branch of before on for a while.
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    return models::recoverable_energy<T>(
        state.penetration, knots, [&](std::size_t i) { return static_cast<double>(knot[i]); },
        [&](bool is_closing, std::size_t i) { return is_closing ? closing[i] : opening[i]; },
        [&](bool is_closing, double at) { return branch_force(is_closing, at); });
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T> period_s) const noexcept {
    if (!loop) {
      state.penetration = motion.penetration;
      return branch_force(true, motion.penetration);
    }
    const auto branch = selector.step(state, motion, period_s);
    return static_cast<Input<T>>(branch.scale) * branch_force(branch.closing, motion.penetration);
  }

 private:
  static std::size_t segments(const OptionReader& reader) {
    return reader.count("segments", 1, max_segments);
  }
};

}  // namespace kerf::models

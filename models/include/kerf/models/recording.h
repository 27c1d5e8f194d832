#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/branch.h>
#include <kerf/models/choice.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

namespace kerf::models {

/// Haptic recording: the recorded forces themselves, looked up over the penetration.
///
///     F(x) = s f_close(x) while closing, s f_open(x) while opening
///
/// Two tables on one uniform grid, linear in between; a BranchSelector chooses the table and the factor s.
/// Before the first grid point the first value holds; past the last one the last trend goes on, to the
/// fully closed scissors. Without the option `loop` there is one table for both directions.
///
/// Source: [Okamura2003], section 3.1, eqs. 4-5.
template <typename T>
struct Recording {
  static constexpr std::string_view name = "recording";
  static constexpr std::string_view equation = "F = s f_close(x) or s f_open(x), tables over x";
  static constexpr LawFacts facts{
      .search = Search::tables,
      .from_data = {{"loop", From::cycles},
                    {"points", From::number, 101.0},
                    {"first", From::first},
                    {"last", From::last}},
      .size = {.option = "points", .unit = "point", .first = 2, .last = 256, .doubles = true},
      .fineness = Fineness::points,
      .in_float = true,
      .usual = 4,
      .charted = true,
      .variants = {{.options = {"points=101", "loop=false"}, .effects = {Effect::stiffening}},
                   {.suffix = "-loop",
                    .options = {"points=101", "loop=true"},
                    .effects = {Effect::stiffening, Effect::loop},
                    .needs_cycles = true}},
      .rank = 2};
  static constexpr std::size_t max_points = 4096;

  double first = 0.0;  ///< penetration of the first grid point
  double last = 1.0;   ///< penetration of the last grid point
  std::vector<T> closing;
  std::vector<T> opening;  ///< empty without `loop`
  BranchSelector selector;

  using State = BranchSelector::StateOf<Signal<T>>;

  static std::vector<OptionInfo> options() {
    auto all = BranchSelector::options();
    all.insert(all.begin(), {{"points", 101.0, "grid points of a table, 2 to 4096"},
                             {"first", 0.0, "penetration of the first grid point"},
                             {"last", 1.0, "penetration of the last grid point"},
                             {"loop", false, "opening has a table of its own"},
                             precision_option()});
    return all;
  }
  static std::vector<ParameterInfo> parameters(const Options& given) {
    const OptionReader reader(name, options(), given);
    std::vector<ParameterInfo> all;
    const auto add = [&](const char* what, const char* meaning) {
      for (std::size_t i = 0; i < points(reader); ++i) {
        all.push_back({std::string(what) + "[" + std::to_string(i) + "]", Quantity::force, -1e6, 1e6,
                       Scale::linear, meaning});
      }
    };
    add("closing", "force at a grid point while closing");
    if (reader.flag("loop")) add("opening", "force at a grid point while opening");
    return all;
  }
  static Recording make(std::span<const T> values, const Options& given) {
    const OptionReader reader(name, options(), given);
    Recording law;
    law.first = reader.number("first", -1e6, 1e6);
    law.last = reader.number("last", -1e6, 1e6);
    if (!(law.first < law.last)) {
      throw std::invalid_argument("law 'recording': option 'last' must be greater than option 'first'");
    }
    law.selector = BranchSelector::make(reader);
    const auto count = static_cast<std::ptrdiff_t>(points(reader));
    law.closing.assign(values.begin(), values.begin() + count);
    if (reader.flag("loop")) law.opening.assign(values.begin() + count, values.begin() + 2 * count);
    return law;
  }

  /// Force of one branch at a penetration [N].
  [[nodiscard]] T branch_force(bool is_closing, Signal<T> penetration) const noexcept {
    const auto& table = is_closing || opening.empty() ? closing : opening;
    using std::floor;
    const Signal<T> place = (penetration - first) * (static_cast<double>(table.size() - 1) / (last - first));
    if (!(place > 0.0)) return table.front();
    const Signal<T> cell = lesser(floor(place), Signal<T>(static_cast<double>(table.size() - 2)));
    const auto i = place_of(cell);
    const T& here = entry(table, i);
    return here + (entry(table, i, 1) - here) * static_cast<Input<T>>(place - cell);
  }

  /// recoverable_energy() between the first point and the last one [J], with what Piecewise says of a loop.
  /// Goes through all points.
  [[nodiscard]] T stored_energy(const State& state) const noexcept {
    const double spacing = (last - first) / static_cast<double>(closing.size() - 1);
    return models::recoverable_energy<T>(
        state.penetration, closing.size(),
        [&](std::size_t i) { return first + spacing * static_cast<double>(i); },
        [&](bool is_closing, std::size_t i) {
          return is_closing || opening.empty() ? closing[i] : opening[i];
        },
        [&](bool is_closing, double at) { return branch_force(is_closing, at); });
  }

  T step(State& state, const MotionOf<Signal<T>>& motion, Signal<T> period_s) const noexcept {
    if (opening.empty()) {
      state.penetration = motion.penetration;
      return branch_force(true, motion.penetration);
    }
    const auto branch = selector.step(state, motion, period_s);
    return static_cast<Input<T>>(branch.scale) * branch_force(branch.closing, motion.penetration);
  }

 private:
  static std::size_t points(const OptionReader& reader) { return reader.count("points", 2, max_points); }
};

}  // namespace kerf::models

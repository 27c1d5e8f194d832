#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <vector>

#include <kerf/models/parameter.h>

namespace kerf::models {

/// No more than `Max` values, at compile time.
template <typename T, std::size_t Max>
class Few {
 public:
  constexpr Few() = default;
  constexpr Few(std::initializer_list<T> values) : size_(values.size()) {
    std::copy(values.begin(), values.end(), values_.begin());
  }
  /// Where there is room for it. @throws std::out_of_range.
  constexpr void add(const T& value) {
    values_.at(size_) = value;
    ++size_;
  }
  [[nodiscard]] constexpr const T* begin() const { return values_.data(); }
  [[nodiscard]] constexpr const T* end() const { return values_.data() + size_; }
  [[nodiscard]] constexpr std::size_t size() const { return size_; }
  [[nodiscard]] constexpr bool empty() const { return size_ == 0; }

 private:
  std::array<T, Max> values_{};
  std::size_t size_ = 0;
};

/// How a law's parameters are found in recordings.
enum class Search : std::uint8_t {
  none,       ///< not at all: a law of several axes
  blade,      ///< from strokes along six axes
  descent,    ///< by a trust region from the best starts of a scan
  tables,     ///< linear in all of them: solved at once
  segments,   ///< knots and forces on them: breakpoints by dynamic programming
  threshold,  ///< memberships of a FuzzySurface, trained on means over depth and speed
  fracture,   ///< over the cells of depth and crack within which the same samples break
  ruptures    ///< a Kelvin element between the drops of the force, a FuzzySurface at them
};

/// What a search by descent scans for its starts. In what is left the law is linear.
enum class Scan : std::uint8_t {
  nothing,     ///< linear in all
  values,      ///< of one parameter
  relaxation,  ///< times of one arm, along which its dashpot goes with its spring
  prony        ///< sets of times of a generalised Maxwell model
};

/// In what the values of a scan are given.
enum class ScanUnit : std::uint8_t {
  one,
  depth,      ///< the largest penetration
  per_depth,  ///< an option of the law over it
  range       ///< of the penetration
};

struct ScanFacts {
  Scan over = Scan::nothing;
  std::string_view parameter = {};  ///< whose values they are; the dashpot of a relaxation
  std::string_view spring = {};     ///< of a relaxation
  Few<double, 16> values = {};
  std::size_t steps = 0;  ///< so many in geometric steps from the first value to the last; 0: the values
  ScanUnit unit = ScanUnit::one;
  std::string_view option = {};  ///< of ScanUnit::per_depth
  bool has_a_kink = false;       ///< of the force, at a place that goes with the parameter
};

/// Where an option comes from that is not given to a fit.
enum class From : std::uint8_t {
  number,
  cycles,   ///< whether the recording has any
  first,    ///< the least penetration
  last,     ///< the largest
  depth,    ///< likewise, and more than nothing
  speed,    ///< the largest, and more than nothing
  contact,  ///< position of the axis at contact
};
struct DataOption {
  std::string_view name = {};
  From from = From::number;
  double number = 0.0;
};

/// The option that makes a law of one kind larger or smaller.
struct SizeFacts {
  std::string_view option = {};  ///< empty: there is none
  std::string_view unit = {};    ///< "arm": of how many a chart speaks
  std::size_t first = 0;         ///< the smallest on a chart
  std::size_t last = 0;          ///< the largest, there and by a fit that takes one more
  bool doubles = false;          ///< on a chart each is twice the one before, not one more
  bool squared = false;          ///< a chart speaks of its square
  bool grows = false;            ///< a fit takes one more while held-out data pay for it
};

/// In what a law can be computed more finely or less.
enum class Fineness : std::uint8_t {
  nothing,
  integrators,  ///< option `integrator` (integrator.h)
  strips,       ///< options `fidelity` and `strips`
  nodes,        ///< of a lattice, and its sub-steps
  projections,  ///< option `projection`
  segments,     ///< fewer or more of them along the same curve
  points,       ///< fewer or more of them from the same table
  memberships   ///< fewer or more of them for the same FuzzySurface, which ends the parameters
};

/// What a law can tell of a cut beside a force that grows with the depth.
enum class Effect : std::uint8_t {
  rotation,    ///< of a blade: parts of it move at speeds and depths of their own
  loop,        ///< hysteresis: opening is felt otherwise than closing, at any speed
  relaxation,  ///< the force fades while the tool is held
  cutting,     ///< the tissue gives way, and the force falls
  rate,        ///< the force depends on the speed
  stiffening   ///< the force is no straight line over the depth
};
using KnownEffects = Few<Effect, 6>;

/// A form in which a law may be chosen.
struct Variant {
  std::string_view suffix = {};           ///< of its name: "-elastic"
  Few<std::string_view, 2> options = {};  ///< NAME=VALUE
  KnownEffects effects = {};
  std::size_t sizes_from = 0;     ///< one candidate for each size from here on; 0: one alone
  KnownEffects from_size_2 = {};  ///< further effects of those larger than one
  bool needs_cycles = false;
};

/// What fit, chart, choice and page know of a law beside its equation. Every law has its own as `facts`; no
/// line elsewhere asks for the name of a law (tests/dependencies).
struct LawFacts {
  Search search = Search::none;
  int searched_at_once =
      4;  ///< the most parameters of a descent that are differentiated in one pass, up to 14
  ScanFacts scan = {};
  Few<DataOption, 5> from_data = {};
  Few<std::string_view, 3> held = {};  ///< parameters that begin so are not searched: no recording tells them
  std::string_view held_note = {};     ///< what a fit says of that
  SizeFacts size = {};
  Few<std::string_view, 2> arm = {};  ///< parameters that begin so, one of each to an arm: a law may lack it
  Fineness fineness = Fineness::nothing;
  bool in_float = false;          ///< has the option `precision`
  int usual = 0;                  ///< place among those that are fitted where none is named; 0: not there
  bool charted = false;           ///< where none is named, and fits are charted
  Few<Variant, 3> variants = {};  ///< in which it is chosen
  std::string_view not_a_candidate = {};  ///< why it is in none
  int rank =
      0;  ///< of candidates with as many parameters the lower come first, then those first in the registry
};

/// A law that acts on axes which it names, and not along any one.
template <typename L>
concept SpatialLaw = requires {
  L::axes();
};

/// Whether nothing is missing in the facts, and none contradicts another.
consteval bool are_complete(const LawFacts& facts, bool spatial) {
  const ScanFacts& scan = facts.scan;
  const bool fitted = facts.search != Search::none && facts.search != Search::blade;
  const bool chosen = !facts.variants.empty();
  return fitted != spatial && (spatial ? !chosen : chosen == facts.not_a_candidate.empty()) &&
         (fitted || (facts.usual == 0 && !facts.charted)) &&
         (scan.over == Scan::nothing || facts.search == Search::descent) &&
         (scan.over != Scan::values || !(scan.parameter.empty() || scan.values.empty())) &&
         (scan.over != Scan::relaxation || !(scan.parameter.empty() || scan.spring.empty())) &&
         (scan.unit == ScanUnit::per_depth) != scan.option.empty() && facts.searched_at_once >= 4 &&
         facts.searched_at_once <= 14 && facts.size.first <= facts.size.last &&
         (facts.size.option.empty() || (facts.size.first > 0 && !facts.size.unit.empty())) &&
         std::all_of(facts.variants.begin(), facts.variants.end(),
                     [&](const Variant& one) { return one.sizes_from == 0 || !facts.size.option.empty(); });
}

/// What a law of the registry is made of. One without its facts does not compile there.
template <typename L>
concept RegistrableLaw = requires(const Options& given) {
  { L::name } -> std::convertible_to<std::string_view>;
  { L::equation } -> std::convertible_to<std::string_view>;
  { L::options() } -> std::same_as<std::vector<OptionInfo>>;
  { L::parameters(given) } -> std::same_as<std::vector<ParameterInfo>>;
  typename L::State;
}
&&are_complete(L::facts, SpatialLaw<L>);

}  // namespace kerf::models

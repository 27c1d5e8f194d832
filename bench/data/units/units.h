#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// A unit as a lab writes it, and what it is in SI.
///
/// `parse_unit("N·s/mm")` has the factor 1000 and the SI unit "N·s/m". A factor may stand before a unit for
/// raw counts: `parse_unit("0.0439453125 deg")` has the factor 0.0439453125 pi / 180 and the SI unit "rad".
/// So may how many counts are one unit: `parse_unit("counts/1000000 N")` has the factor 1e-6.
struct Unit {
  double factor = 1.0;  ///< value in SI = factor * value
  std::string si;       ///< "m", "s", "rad", "N", "V", "1", or a product such as "N·s/rad"
  double offset = 0.0;  ///< added to that: of a temperature in degF; zero of all others

  friend bool operator==(const Unit&, const Unit&) = default;
};

/// Reads a unit: the symbols of unit_symbols() and their other spellings, products with `·` or `*`, quotients
/// with `/`, powers with `²`, `³`, `^2` or `^3`. `degC` is kept as it is, `degF` in a product or quotient is
/// a difference.
/// @throws std::invalid_argument that names the symbol and lists those known, and for a `?` where a factor is
///         to be told.
[[nodiscard]] Unit parse_unit(std::string_view text);

/// A unit as it is written, without the factor before it: "N" of "-0.5 N" and of "counts/1000 N".
[[nodiscard]] std::string_view without_factor(std::string_view text);

/// The symbols that stand for a unit of SI, "s ms us min h" of "s": of those that say the same the first. Of
/// a quotient by s, as "m/s", those of what is above, by s.
[[nodiscard]] std::vector<std::string> symbols_of(std::string_view si);
/// All of them.
[[nodiscard]] std::vector<std::string> all_symbols();

/// The unit of a force times the way it goes: "J" of N over m and of N·m over rad; "N·rad" of a force over an
/// angle, which is no energy before it is multiplied by a lever.
[[nodiscard]] std::string work_unit(std::string_view force_unit, std::string_view position_unit);

}  // namespace kerf::bench

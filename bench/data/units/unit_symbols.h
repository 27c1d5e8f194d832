#pragma once

#include <span>
#include <string_view>

namespace kerf::bench {

/// A unit without factor, product or quotient, and what one of it is in SI.
struct Symbol {
  std::string_view text;
  double factor;
  std::string_view si;
};

/// All of them, in the order in which they are shown.
[[nodiscard]] std::span<const Symbol> unit_symbols() noexcept;

/// The symbol that a text stands for, by itself, by another spelling ("KN", μ for µ) or as a word in whatever
/// case ("Sec", "inches"); null if there is none. Where case tells two units apart, as "MN" and "mN", another
/// case is none.
[[nodiscard]] const Symbol* symbol_called(std::string_view text);

}  // namespace kerf::bench

#include <cmath>
#include <stdexcept>

#include "fuzz/target.h"
#include "units/units.h"

namespace kerf::fuzz {
namespace {

/// A unit that is understood has a factor to convert by, and its SI unit is understood as itself.
void fuzz_units(Bytes bytes) {
  bench::Unit unit;
  if (!is_taken<std::invalid_argument>([&] { unit = bench::parse_unit(text_of(bytes)); })) return;
  promise(std::isfinite(unit.factor) && unit.factor != 0.0, "a unit's factor is finite and not zero");
  const bench::Unit again = bench::parse_unit(unit.si);
  promise(again.si == unit.si, "'" + unit.si + "' is an SI unit, and read as '" + again.si + "'");
  promise(again.factor == 1.0, "the factor of an SI unit is 1");
}

const Registered registered("units", fuzz_units);

}  // namespace
}  // namespace kerf::fuzz

#include "devices/woodenhaptics_wiring.h"

#include <array>

namespace kerf::emulators {
namespace {

using drivers::woodenhaptics::Generation;
using PerJoint = std::array<double, 3>;

/// Whether a counter with the usual table grows as its body's angle does.
constexpr PerJoint mounted_in_a_woody{-1.0, -1.0, -1.0};
constexpr PerJoint mounted_in_a_polhem{-1.0, 1.0, -1.0};
/// Whether a positive current of V1's amplifiers turns a body towards greater angles.
constexpr PerJoint turned_by_v1{1.0, -1.0, -1.0};

double table_of(Generation generation) { return generation == Generation::v1 ? 1.0 : -1.0; }

}  // namespace

mechanisms::WoodenHaptics::Signs wiring_of(Generation generation,
                                           const mechanisms::WoodenHaptics::Configuration& model) noexcept {
  mechanisms::WoodenHaptics::Signs signs;
  signs.encoder = model.linkage ? mounted_in_a_polhem : mounted_in_a_woody;
  for (double& one : signs.encoder) one *= table_of(generation);
  signs.motor = generation == Generation::v1 ? turned_by_v1 : signs.encoder;
  return signs;
}

}  // namespace kerf::emulators

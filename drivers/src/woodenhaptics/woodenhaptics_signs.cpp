#include "kerf/drivers/woodenhaptics_signs.h"

namespace kerf::drivers::woodenhaptics {
namespace {

using Signs = mechanisms::WoodenHaptics::Signs;

constexpr Signs chai3d{.encoder = {-1.0, -1.0, -1.0}, .motor = {1.0, -1.0, -1.0}};
constexpr Signs none_reversed{.encoder = {1.0, 1.0, 1.0}, .motor = {1.0, 1.0, 1.0}};
constexpr Signs b_reversed{.encoder = {1.0, -1.0, 1.0}, .motor = {1.0, -1.0, 1.0}};

}  // namespace

std::optional<Signs> signs_of(Generation generation,
                              const mechanisms::WoodenHaptics::Configuration& model) noexcept {
  const bool polhem = model.linkage.has_value();
  if (generation != Generation::v1) return polhem ? b_reversed : none_reversed;
  return polhem ? std::nullopt : std::optional(chai3d);
}

}  // namespace kerf::drivers::woodenhaptics

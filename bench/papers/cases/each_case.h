#pragma once

#include <cstdint>

#include "cases/cases.h"

namespace kerf::bench::cases {

// One function a case; cases.cpp has their order.
NamedCase velocity_sign(std::uint64_t seed);
NamedCase equal_thresholds(std::uint64_t seed);
NamedCase euler_maxwell(std::uint64_t seed);
NamedCase euler_lattice(std::uint64_t seed);
NamedCase fracture_at_low_rate(std::uint64_t seed);
NamedCase quantised_velocity(std::uint64_t seed);
NamedCase delay(std::uint64_t seed);
NamedCase fast_contact(std::uint64_t seed);
NamedCase stiff_grip(std::uint64_t seed);
NamedCase exponential_depth(std::uint64_t seed);
NamedCase passivity_control(std::uint64_t seed);

}  // namespace kerf::bench::cases

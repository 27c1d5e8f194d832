#pragma once

#include <cstdint>

#include "cases/cases.h"

// A namespace a case, so that each has constants of its own under names of its own; cases.cpp has their
// order.
namespace kerf::bench::cases::velocity_sign {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::equal_thresholds {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::euler {
NamedCase run_maxwell(std::uint64_t seed);
NamedCase run_lattice(std::uint64_t seed);
}  // namespace kerf::bench::cases::euler
namespace kerf::bench::cases::fracture_at_low_rate {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::quantised_velocity {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::delay {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::fast_contact {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::stiff_grip {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::exponential_depth {
NamedCase run(std::uint64_t seed);
}
namespace kerf::bench::cases::passivity_control {
NamedCase run(std::uint64_t seed);
}

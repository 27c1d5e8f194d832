#pragma once

#include <string_view>

namespace kerf::drivers {

/// The option by which a URI says of which name of the bench file it is. No driver has one with a dot.
inline constexpr std::string_view bench_option = "bench.toml";

}  // namespace kerf::drivers

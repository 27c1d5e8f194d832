#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include <kerf/compare/tolerance.h>

#include "laws/law_toml.h"

namespace kerf::bench {

/// What a case, a channel or a file of tolerances may say of them.
inline constexpr std::array<std::string_view, 8> tolerance_keys{"absolute",  "relative", "jnd",   "exact",
                                                                "vibration", "slew",     "drift", "peak"};

/// The tolerance that a table names, over that which it inherits. @throws std::invalid_argument as Place.
void read_tolerance(const Place& place, const toml::table& table, compare::Tolerance& tolerance);

/// The same of a whole file, with tables [channel.NAME] of single channels.
/// @throws std::invalid_argument as Place and NamedFile; for one that allows nothing tick by tick.
[[nodiscard]] compare::Tolerance read_tolerance_file(const std::filesystem::path& file);

/// A bare number within bounds. @throws std::invalid_argument as Place.
[[nodiscard]] double number_within(const Place& place, const toml::node& node, std::string_view what,
                                   double lower, double upper);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <string>

#include <kerf/fitting/rupture.h>

namespace kerf::bench {

/// Rupture forces of a liver-like tissue, made from a formula with the trends of [FuzzyKelvin] (deeper is
/// harder; faster is harder, less and less so), not measured:
///
///     F = 0.05 N (d / 5 mm)^1.2 (0.6 + 0.4 sqrt(s / 2 mm/s)),   d = 1 to 10 mm, s = 0.5 to 10 mm/s
[[nodiscard]] fitting::RuptureSamples liver_ruptures();

/// Reads a table of ruptures: columns named depth, speed and force with their units, in any order, among any
/// others.
/// @throws std::invalid_argument that names the column or the line; std::system_error if it cannot be read.
[[nodiscard]] fitting::RuptureSamples read_ruptures(const std::filesystem::path& file);

/// Writes one in mm, mm/s and N.
[[nodiscard]] std::string as_csv(const fitting::RuptureSamples& samples);

}  // namespace kerf::bench

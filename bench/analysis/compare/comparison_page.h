#pragma once

#include <array>
#include <cstddef>
#include <filesystem>

#include "compare/run_comparison.h"
#include "plot/plot.h"

namespace kerf::bench {

/// Of one channel expected and got, with what is outside marked; and their difference with the band that is
/// allowed.
[[nodiscard]] std::array<Chart, 2> channel_charts(const RunComparison& result,
                                                  const compare::Tolerance& tolerance, std::size_t channel);

/// Writes compare.html, compare.json and CHANNEL.svg into a folder. @throws std::invalid_argument if they are
/// there and `replace` is false; std::system_error; std::runtime_error without gnuplot.
void write_comparison(const std::filesystem::path& folder, const RunComparison& result,
                      const RunComparisonOptions& options, bool replace);

}  // namespace kerf::bench

#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "compare/run_comparison.h"
#include "plot/plot.h"

namespace kerf::bench {

/// Of one channel expected and got, with what is outside marked; their difference with the band that is
/// allowed; and the difference in JNDs of the expected force.
using ChannelCharts = std::array<Chart, 3>;
[[nodiscard]] ChannelCharts channel_charts(const RunComparison& result, const compare::Tolerance& tolerance,
                                           std::size_t channel);

/// Drawings below each other, each of 900 by 340, as one.
[[nodiscard]] std::string below_each_other(std::span<const std::string> drawings);

/// Writes compare.html, compare.json and CHANNEL.svg into a folder. @throws std::invalid_argument if they are
/// there and `replace` is false; std::system_error; std::runtime_error without gnuplot.
void write_comparison(const std::filesystem::path& folder, const RunComparison& result,
                      const RunComparisonOptions& options, bool replace);

}  // namespace kerf::bench

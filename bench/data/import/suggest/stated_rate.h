#pragma once

#include <optional>
#include <string_view>

namespace kerf::bench {

/// The rate that the lines before the data say in so many words and in Hz ("Sample rate: 1000 Hz", "Sampling
/// frequency (kHz) = 2") [Hz]; nothing if none says it, or two say it differently.
[[nodiscard]] std::optional<double> stated_rate(std::string_view preamble);

}  // namespace kerf::bench

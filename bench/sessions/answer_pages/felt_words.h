#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "answers/felt_check.h"

namespace kerf::bench {

/// Lines for a terminal: each sample, then each pair. None where nothing was felt.
[[nodiscard]] std::vector<std::string> felt_lines(const FeltCheck& check,
                                                  const std::vector<std::string>& names, double confidence);
[[nodiscard]] nlohmann::ordered_json felt_json(const FeltCheck& check, const std::vector<std::string>& names);
/// A section of the page; empty where nothing was felt.
[[nodiscard]] std::string felt_section(const FeltCheck& check, const std::vector<std::string>& names,
                                       double confidence);

}  // namespace kerf::bench

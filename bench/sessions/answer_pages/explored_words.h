#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "answers/explored/explored_alike.h"

// Whether the samples were explored alike, as lines, JSON and a part of the page; empty where nothing is
// known.

namespace kerf::bench {

[[nodiscard]] std::vector<std::string> explored_lines(const std::vector<ExploredPair>& pairs,
                                                      const std::vector<std::string>& names,
                                                      double confidence);
[[nodiscard]] nlohmann::ordered_json explored_json(const std::vector<ExploredPair>& pairs,
                                                   const std::vector<std::string>& names);
[[nodiscard]] std::string explored_section(const std::vector<ExploredPair>& pairs,
                                           const std::vector<std::string>& names, double confidence);

}  // namespace kerf::bench

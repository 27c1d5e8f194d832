#pragma once

#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/compare/diagnose.h>

namespace kerf::bench {

/// Names for what changed, each with kind, channel, the number that says how much and its unit, and what it
/// leaves of the difference. docs/comparing.md has the keys.
[[nodiscard]] nlohmann::ordered_json findings_as_json(const std::vector<compare::Finding>& all,
                                                      const std::vector<compare::Channel>& channels);

}  // namespace kerf::bench

#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/schema/regression.h>

namespace kerf::bench {

/// What is in a file of stored forces, as `kerf info --json` gives it: each case with its law, its ticks, its
/// channels and why it was stored.
[[nodiscard]] nlohmann::ordered_json stored_facts(const std::vector<schema::StoredForces>& cases);

/// The same as lines for people.
[[nodiscard]] std::string stored_facts_table(const nlohmann::ordered_json& facts);

}  // namespace kerf::bench

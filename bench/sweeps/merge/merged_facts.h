#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <kerf/schema/sweep_tables_file.h>

namespace kerf::bench {

/// What is in the tables of a sweep, as `kerf info --json` gives it: the verb, its cells, each table with its
/// rows and columns.
[[nodiscard]] nlohmann::ordered_json merged_facts(const schema::SweepTablesFacts& facts);

/// The same as lines for people.
[[nodiscard]] std::string merged_facts_table(const nlohmann::ordered_json& facts);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// What everybody may know of a session, without its key, as `kerf info --json` gives it: subject, protocol's
/// laws, trials done, openings, entries, and whether a journal lies beside it or is being written.
/// @throws as schema::read_session().
[[nodiscard]] nlohmann::ordered_json session_facts(const std::filesystem::path& file);

/// The same as lines for people.
[[nodiscard]] std::string session_facts_table(const nlohmann::ordered_json& facts);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "choose/candidate_search.h"

namespace kerf::bench {

/// The JSON of `kerf choose`.
[[nodiscard]] nlohmann::ordered_json choice_as_json(const LawChoice& choice);

/// Its table of candidates, one row a law.
[[nodiscard]] std::string choice_csv(const LawChoice& choice);

/// @throws std::invalid_argument if a file that write_choice() always writes stands in the folder.
void refuse_to_replace_choice(const std::filesystem::path& folder, bool replace);

/// Writes choose.json, choose.csv, choose.html and NAME.law.toml of the law that was taken, and of the one
/// that is as good, into a folder; the recording's checksum is added. `json` is the choice's, with whatever
/// the caller added.
/// @throws std::system_error.
void write_choice(LawChoice& choice, const nlohmann::ordered_json& json,
                  const std::filesystem::path& recording, const std::filesystem::path& folder);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include <kerf/schema/final_name.h>

namespace kerf::bench {

/// A result as text, indented, with the program that made it under "software"; no character of it steers a
/// terminal (for_terminal()).
[[nodiscard]] std::string json_text(nlohmann::ordered_json result);

/// Writes it as write_whole_file() does.
void write_json_file(const std::filesystem::path& file, const nlohmann::ordered_json& result,
                     schema::Existing existing = schema::Existing::replace);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "choose/candidate_search.h"
#include "plot/plot.h"

namespace kerf::bench {

/// Error on held-out data against the number of parameters, what a person can feel as a line. `json` is what
/// `kerf choose` writes.
[[nodiscard]] Chart choice_chart(const nlohmann::ordered_json& json);

/// One self-contained HTML page of a choice: the law that was taken and why, every candidate, which effects
/// matter, and the law over the recording.
/// @throws schema::FormatError, std::system_error.
[[nodiscard]] std::string choice_page(const nlohmann::ordered_json& json,
                                      const std::filesystem::path& recording, const LawChoice& choice);

}  // namespace kerf::bench

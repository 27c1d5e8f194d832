#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Which law was chosen and why, for the top of the page; not good if the fit is `outdated`.
[[nodiscard]] std::string choice_paragraph(const nlohmann::ordered_json& fits, bool outdated = false);

/// The laws compared, drawn over the data, their residuals and parameters. `fits` is the JSON of `kerf fit`,
/// whose law files are in `folder`. @throws std::invalid_argument if the JSON lacks what `kerf fit` writes.
[[nodiscard]] std::string fit_section(const schema::Recording& recording, std::size_t axis,
                                      const nlohmann::ordered_json& fits,
                                      const std::filesystem::path& folder);

}  // namespace kerf::bench

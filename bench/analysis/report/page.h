#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kerf::bench {

/// What a report is made of. Parts that are not given are left out of the page, which says so.
struct ReportInput {
  std::filesystem::path recording;
  std::optional<std::filesystem::path> fits;   ///< folder that `kerf fit` wrote
  std::optional<std::filesystem::path> check;  ///< JSON that `kerf check -o` wrote
  std::vector<std::filesystem::path>
      results{};     ///< further results, files or folders, as find_results() takes them
  std::string axis;  ///< name; empty: the axis of the cycles, or the first
};

/// One self-contained HTML page: what was recorded, the fits over the data, their residuals, the parameters
/// with their uncertainty, the choice and its reason, how the law held its deadlines, and whatever other
/// verbs have found of it; above all a summary of what holds, what does not, and what is not known.
/// @throws schema::FormatError, std::invalid_argument (a fit or check that is not one), std::system_error.
[[nodiscard]] std::string report_page(const ReportInput& input);

}  // namespace kerf::bench

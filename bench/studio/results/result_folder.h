#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "workspace/workspace.h"

namespace kerf::bench {

/// A folder of results while it is made: beside where it will stand, under a hidden name, so that nobody
/// meets half a result. What was not published is removed.
class ResultFolder {
 public:
  /// @throws std::system_error if it cannot be made.
  explicit ResultFolder(const Workspace& workspace);
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;
  ~ResultFolder();

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Gives it its name in the workspace, STEM with the ending, or STEM-2, STEM-3, ... where that is taken,
  /// and finds its file there. The file's id. @throws std::system_error, RequestError.
  [[nodiscard]] std::string publish(Workspace& workspace, const std::string& stem, std::string_view ending,
                                    std::string_view file);

 private:
  std::filesystem::path path_;  ///< empty: published
};

/// What results of a file or a device are named after: its own name without folder and endings, with "-" in
/// place of what a name may not have.
[[nodiscard]] std::string result_stem(std::string_view name);

}  // namespace kerf::bench

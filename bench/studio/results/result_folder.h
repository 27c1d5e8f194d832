#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "files/whole_folder.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// A folder of results of the studio: STEM with the ending, or STEM-2, STEM-3, ... where that is taken.
/// Nobody meets half a result, and what was not published is removed (WholeFolder). One at a time.
class ResultFolder {
 public:
  /// @throws std::system_error if it cannot be made; RequestError if there is no name left.
  ResultFolder(const Workspace& workspace, const std::string& stem, std::string_view ending);

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return whole_.path(); }
  /// Gives it its name, and finds its file there. The file's id. @throws std::system_error.
  [[nodiscard]] std::string publish(Workspace& workspace, std::string_view file);

 private:
  std::filesystem::path name_;
  WholeFolder whole_;
};

/// What results of a file or a device are named after: its own name without folder and endings, with "-" in
/// place of what a name may not have.
[[nodiscard]] std::string result_stem(std::string_view name);

}  // namespace kerf::bench

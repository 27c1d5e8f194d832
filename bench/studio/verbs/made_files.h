#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "workspace/workspace.h"

namespace kerf::bench {

/// A file that a job has made.
struct MadeFile {
  std::string name;  ///< in the workspace
  std::filesystem::path path;
  std::uintmax_t bytes = 0;
  std::string_view what;  ///< picture, page, table, text or other: how a page shows it
  std::string_view type;  ///< of its content
};

/// The files among what a job was to make, pages and pictures first; those of a folder up to two folders
/// deep. Links are left out, and so is what is more than 500.
[[nodiscard]] std::vector<MadeFile> made_files(const Workspace& workspace,
                                               const std::vector<std::string>& outputs);

/// Names of files and folders of the workspace, as its scan goes, for whoever is to choose one.
struct OfferedNames {
  std::vector<std::string> files;
  std::vector<std::string> folders;
};
[[nodiscard]] OfferedNames offered_names(const Workspace& workspace);

}  // namespace kerf::bench

#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "workspace/workspace.h"

namespace kerf::bench {

/// What lies in the trash.
struct TrashedFile {
  std::string key;   ///< which one, "3"
  std::string name;  ///< that it had in the workspace
  std::string time;  ///< when it was deleted, ISO 8601
  std::uintmax_t bytes = 0;
};

/// Files that were deleted in the page: moved, within the workspace's own state folder, and never removed but
/// by empty(). For one thread.
class Trash {
 public:
  explicit Trash(const Workspace& workspace);

  /// @throws std::system_error: the file cannot be moved. Its key.
  std::string take(const WorkspaceEntry& entry);
  /// Puts it back where it was. @throws RequestError 404, 409 where the name is taken; std::system_error.
  void restore(const std::string& key);
  /// Newest first.
  [[nodiscard]] std::vector<TrashedFile> list() const;
  /// Removes what lies there for good.
  void empty();

 private:
  std::filesystem::path workspace_;
  std::filesystem::path folder_;
};

}  // namespace kerf::bench

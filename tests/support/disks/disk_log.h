#pragma once

#include <filesystem>
#include <vector>

#include <sys/types.h>

namespace kerf::test {

/// One thing that this process asked of the disk.
struct DiskCall {
  enum class Kind {
    write,
    resize,
    synchronise,       ///< of a file
    rename,            ///< to a name that nobody had
    synchronise_names  ///< of a folder
  };
  Kind kind;
  off_t at = 0;               ///< of a write; the size after a resize
  std::vector<char> bytes{};  ///< of a write
};

/// While it lives, what this process asks of the disk about the files of one folder, in its order: the calls
/// are those of the C library, which disk_log.cpp puts itself in the place of.
class DiskLog {
 public:
  explicit DiskLog(const std::filesystem::path& folder);
  DiskLog(const DiskLog&) = delete;
  DiskLog& operator=(const DiskLog&) = delete;
  ~DiskLog();
  [[nodiscard]] const std::vector<DiskCall>& calls() const;
};

}  // namespace kerf::test

#pragma once

#include <filesystem>

namespace kerf::bench {

/// Held while a suite's forces are read or stored: runs go side by side, an update alone. It is a lock on the
/// suite's file, which ends with the process; where the file system has none, nothing is locked.
class SuiteLock {
 public:
  enum class To { read, store };

  /// @throws std::invalid_argument, at once, if another process is at work on the suite.
  SuiteLock(const std::filesystem::path& suite, To what);
  SuiteLock(const SuiteLock&) = delete;
  SuiteLock& operator=(const SuiteLock&) = delete;
  ~SuiteLock();

 private:
  int descriptor_;
};

}  // namespace kerf::bench

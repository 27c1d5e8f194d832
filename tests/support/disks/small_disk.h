#pragma once

#include <string>
#include <vector>

#include "support/program.h"

namespace kerf::test {

/// Runs a script of the shell where `folder` is a disk of its own with so many bytes, which goes when the
/// script ends. Needs the right to mount in a namespace of one's own.
inline Outcome run_on_small_disk(const std::string& folder, std::size_t bytes, const std::string& script) {
  const std::string mount = "mount -t tmpfs -o size=" + std::to_string(bytes) + " none '" + folder + "' && ";
  return run({"unshare", "--user", "--map-root-user", "--mount", "sh", "-c", mount + script});
}

inline bool can_have_small_disk() {
  const TemporaryFolder folder;
  return run_on_small_disk(folder.path().string(), 65536, "true").exit_status == 0;
}

}  // namespace kerf::test

#include "regress/stored/suite_lock.h"

#include <cerrno>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

namespace kerf::bench {

SuiteLock::SuiteLock(const std::filesystem::path& suite, To what)
    : descriptor_(::open(suite.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  if (descriptor_ < 0) return;  // who reads the suite says why
  if (::flock(descriptor_, (what == To::store ? LOCK_EX : LOCK_SH) | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    return;
  ::close(descriptor_);
  throw std::invalid_argument(
      what == To::store
          ? fmt::format(
                "{}: another 'kerf regress' is at work on this suite; nothing was touched, start this "
                "again when it has ended",
                suite.string())
          : fmt::format(
                "{}: a 'kerf regress update' is storing forces of this suite; start this again when it "
                "has ended",
                suite.string()));
}

SuiteLock::~SuiteLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace kerf::bench

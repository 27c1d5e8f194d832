#pragma once

#include <exception>
#include <stdexcept>

#include <unistd.h>

namespace kerf::test {

/// While it lives, this process is a user without rights; it was already where it does not run as root.
class AsNobody {
 public:
  AsNobody() {
    if (is_root_ && seteuid(65534) != 0) throw std::runtime_error("root cannot become nobody");
  }
  AsNobody(const AsNobody&) = delete;
  AsNobody& operator=(const AsNobody&) = delete;
  ~AsNobody() {
    if (is_root_ && seteuid(0) != 0) std::terminate();
  }

 private:
  bool is_root_ = geteuid() == 0;
};

}  // namespace kerf::test

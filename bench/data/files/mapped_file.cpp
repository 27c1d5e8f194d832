#include "files/mapped_file.h"

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::bench {

MappedFile::MappedFile(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT)
    throw std::invalid_argument(fmt::format("{}: no such file", file.string()));
  struct stat facts {};
  int reason = descriptor < 0 || fstat(descriptor, &facts) != 0 ? errno : 0;
  if (reason == 0 && !S_ISREG(facts.st_mode)) {
    close(descriptor);
    throw std::invalid_argument(fmt::format("{}: not a regular file; expected a text file", file.string()));
  }
  size_ = static_cast<std::size_t>(facts.st_size);
  if (reason == 0 && size_ > 0) {
    begin_ = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (begin_ == MAP_FAILED) reason = errno;
  }
  if (descriptor >= 0) close(descriptor);
  if (reason != 0) throw std::system_error(reason, std::generic_category(), "cannot read " + file.string());
}

MappedFile::~MappedFile() {
  if (begin_ != nullptr) munmap(begin_, size_);
}

}  // namespace kerf::bench

#include "files/mapped_file.h"

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <sys/mman.h>
#include <sys/stat.h>

#include "files/named_file.h"

namespace kerf::bench {

MappedFile::MappedFile(const std::filesystem::path& file) {
  const NamedFile named(file);
  struct stat facts {};
  if (fstat(named.descriptor(), &facts) != 0 || !S_ISREG(facts.st_mode))
    throw std::invalid_argument(file.string() + ": not a regular file; expected a text file");
  size_ = static_cast<std::size_t>(facts.st_size);
  if (size_ == 0) return;
  void* const mapped = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, named.descriptor(), 0);
  if (mapped == MAP_FAILED)
    throw std::system_error(errno, std::generic_category(), "cannot read " + file.string());
  begin_ = mapped;
}

MappedFile::~MappedFile() {
  if (begin_ != nullptr) munmap(begin_, size_);
}

}  // namespace kerf::bench

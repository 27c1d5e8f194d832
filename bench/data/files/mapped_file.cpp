#include "files/mapped_file.h"

#include <cerrno>
#include <system_error>

#include <sys/mman.h>
#include <unistd.h>

#include "files/named_file.h"

namespace kerf::bench {

MappedFile::MappedFile(const std::filesystem::path& file, std::uintmax_t at_most) {
  const NamedFile named(file);
  if (named.is_pipe()) {
    piped_ = named.read_all(at_most);
    return;
  }
  named.require_at_most(at_most);
  size_ = static_cast<std::size_t>(named.size());
  if (size_ == 0) return;
  void* const mapped = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, named.descriptor(), 0);
  if (mapped == MAP_FAILED)
    throw std::system_error(errno, std::generic_category(), "cannot read " + file.string());
  begin_ = mapped;
}

void MappedFile::let_go_of(std::string_view part) const noexcept {
  if (begin_ == nullptr) return;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const auto first = static_cast<std::size_t>(part.data() - text().data()) / page * page;
  const auto end = static_cast<std::size_t>(part.data() + part.size() - text().data()) / page * page;
  if (end > first) (void)madvise(static_cast<char*>(begin_) + first, end - first, MADV_DONTNEED);
}

MappedFile::~MappedFile() {
  if (begin_ != nullptr) munmap(begin_, size_);
}

}  // namespace kerf::bench

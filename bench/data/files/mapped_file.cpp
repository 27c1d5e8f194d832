#include "files/mapped_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <stdexcept>
#include <system_error>

#include <sys/mman.h>
#include <unistd.h>

#include "files/named_file.h"

namespace kerf::bench {

/// Where a file lies in memory, as the handler of a signal may read it: nothing of it moves or is freed.
struct WatchedMapping {
  std::atomic<bool> is_taken = false;
  std::atomic<std::uintptr_t> begin = 0;  ///< 0: of none
  std::atomic<std::uintptr_t> end = 0;
  std::atomic<bool> is_damaged = false;
};

namespace {

// One more than these is not watched, and ends the program as every such mapping would.
std::array<WatchedMapping, 1024> watched_mappings;
struct sigaction before_ours;

std::uintptr_t page_bytes() noexcept {
  static const auto bytes = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  return bytes;
}

/// Zeros from the page that cannot be read to the end of its mapping, so that whoever reads goes on.
bool put_zeros(std::uintptr_t address) noexcept {
  for (WatchedMapping& one : watched_mappings) {
    const std::uintptr_t begin = one.begin.load(std::memory_order_acquire);
    const std::uintptr_t end = one.end.load(std::memory_order_relaxed);
    if (begin == 0 || address < begin || address >= end) continue;
    const std::uintptr_t page = address / page_bytes() * page_bytes();
    // NOLINTNEXTLINE(performance-no-int-to-ptr): an address is all that a signal has
    void* const put = mmap(reinterpret_cast<void*>(page), end - page, PROT_READ,
                           MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
    if (put == MAP_FAILED) return false;
    one.is_damaged.store(true, std::memory_order_release);
    return true;
  }
  return false;
}

void on_bus_error(int signal, siginfo_t* info, void* context) {
  const int error = errno;
  if (!put_zeros(reinterpret_cast<std::uintptr_t>(info->si_addr))) {
    // What is nobody's: the handler before this one has it, and without one the default, on the next attempt.
    if ((before_ours.sa_flags & SA_SIGINFO) != 0)
      before_ours.sa_sigaction(signal, info, context);
    else
      (void)sigaction(SIGBUS, &before_ours, nullptr);
  }
  errno = error;
}

void watch_for_bus_errors() {
  static const bool watches = [] {
    (void)page_bytes();
    struct sigaction ours {};
    ours.sa_sigaction = on_bus_error;
    ours.sa_flags = SA_SIGINFO | SA_ONSTACK;
    return sigaction(SIGBUS, &ours, &before_ours) == 0;
  }();
  (void)watches;
}

WatchedMapping* watched(const void* begin, std::size_t bytes) {
  watch_for_bus_errors();
  for (WatchedMapping& one : watched_mappings) {
    if (one.is_taken.exchange(true)) continue;
    const auto address = reinterpret_cast<std::uintptr_t>(begin);
    one.is_damaged.store(false, std::memory_order_relaxed);
    one.end.store(address + bytes, std::memory_order_relaxed);
    one.begin.store(address, std::memory_order_release);
    return &one;
  }
  return nullptr;
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& file, std::uintmax_t at_most) : file_(file) {
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
  watched_ = watched(begin_, size_);
}

void MappedFile::require_whole() const {
  if (watched_ != nullptr && watched_->is_damaged.load(std::memory_order_acquire))
    throw std::invalid_argument(file_.string() +
                                ": it became shorter while it was read; try again when it has been written");
}

void MappedFile::let_go_of(std::string_view part) const noexcept {
  if (begin_ == nullptr) return;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const auto first = static_cast<std::size_t>(part.data() - text().data()) / page * page;
  const auto end = static_cast<std::size_t>(part.data() + part.size() - text().data()) / page * page;
  if (end > first) (void)madvise(static_cast<char*>(begin_) + first, end - first, MADV_DONTNEED);
}

MappedFile::~MappedFile() {
  if (watched_ != nullptr) watched_->begin.store(0);
  if (begin_ != nullptr) munmap(begin_, size_);
  if (watched_ != nullptr) watched_->is_taken.store(false);
}

}  // namespace kerf::bench

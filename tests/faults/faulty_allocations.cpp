// Stands between a program and the C library (LD_PRELOAD) and lets the n-th allocation of the program fail:
// malloc and its kin, and so operator new. Not of what it starts: others may do without memory as they like.
//
//   KERF_FAULT_AT    which one, from 1; 0: none
//   KERF_FAULT_LOG   gets which library was refused its memory, and at the end how many allocations there
//   were

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

// What glibc calls its own.
extern "C" {
void* __libc_malloc(std::size_t) noexcept;                 // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t, std::size_t) noexcept;    // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void*, std::size_t) noexcept;         // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t, std::size_t) noexcept;  // NOLINT(bugprone-reserved-identifier)
}

namespace {

std::atomic<long> allocations{0};
long fails_at = -1;  // before the program begins nothing fails: that is the libraries' own start

void note(const char* what, const char* whom) {
  const char* const path = std::getenv("KERF_FAULT_LOG");
  if (path == nullptr) return;
  std::array<char, 4600> line{};
  const int length = std::snprintf(line.data(), line.size(), "%s %s\n", what, whom);
  const auto file =
      static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND, 0600));
  if (file < 0) return;
  (void)syscall(SYS_write, file, line.data(), static_cast<std::size_t>(length));
  (void)syscall(SYS_close, file);
}

__attribute__((constructor)) void read_the_plan() {
  const char* const at = std::getenv("KERF_FAULT_AT");
  if (at == nullptr || std::strncmp(program_invocation_short_name, "kerf", 4) != 0) return;
  std::array<void*, 1> frame{};
  (void)backtrace(frame.data(), 1);  // the first time it loads what it needs
  fails_at = std::strtol(at, nullptr, 10);
  allocations = 0;
}

__attribute__((destructor)) void tell_the_count() {
  if (fails_at < 0) return;
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%ld", allocations.load());
  note("allocations", number.data());
}

/// The library whose doing it is: the innermost one that is neither this nor one of the languages.
const char* asker() {
  std::array<void*, 12> frames{};
  const int depth = backtrace(frames.data(), static_cast<int>(frames.size()));
  for (int i = 0; i < depth; ++i) {
    Dl_info library{};
    if (dladdr(frames.at(static_cast<std::size_t>(i)), &library) == 0 || library.dli_fname == nullptr)
      continue;
    const std::string_view name = library.dli_fname;
    constexpr std::array<std::string_view, 3> passed{"/libc.so", "/libstdc++.so", "faulty_allocations"};
    const auto is_named = [&](std::string_view part) { return name.find(part) != std::string_view::npos; };
    if (std::ranges::none_of(passed, is_named)) return library.dli_fname;
  }
  return "?";
}

/// Whether this allocation is the one.
bool fails() {
  if (allocations.fetch_add(1, std::memory_order_relaxed) + 1 != fails_at) return false;
  note("refused", asker());
  errno = ENOMEM;
  return true;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept { return fails() ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) noexcept {
  return fails() ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept { return fails() ? nullptr : __libc_realloc(old, size); }
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return fails() ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return fails() ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) noexcept {
  if (fails()) return ENOMEM;
  void* const memory = __libc_memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *result = memory;
  return 0;
}

}  // extern "C"

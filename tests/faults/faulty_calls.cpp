// Stands between a program and the C library (LD_PRELOAD), counts the calls that write below a folder, and
// lets the n-th of them go wrong, as SQLite's tests do. Calls from within the C library itself do not come by
// here.
//
//   KERF_FAULT_BELOW   the folder
//   KERF_FAULT_KIND    short | EINTR | ENOSPC | EIO | EDQUOT | slow | count
//   KERF_FAULT_AT      which call, from 1; with a + behind it that one and all that follow
//   KERF_FAULT_LOG     gets one line for each process in which a fault came about: what it was asked, and of
//   which file; of
//                      the kind "count" how many calls there were
//
// Counted: opening, writing, lengthening, flushing, closing, renaming, linking, making a folder. Each process
// counts for itself.

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

using Path = std::array<char, 4096>;

struct Plan {
  std::string_view below;
  std::string_view kind;
  long at = 0;
  bool from_then_on = false;
  int error = 0;  // 0: the call is done, short or late

  Plan() {
    const char* const folder = std::getenv("KERF_FAULT_BELOW");
    const char* const what = std::getenv("KERF_FAULT_KIND");
    const char* const when = std::getenv("KERF_FAULT_AT");
    if (folder == nullptr || what == nullptr || when == nullptr) return;
    below = folder;
    kind = what;
    char* end = nullptr;
    at = std::strtol(when, &end, 10);
    from_then_on = *end == '+';
    error = kind == "EINTR"    ? EINTR
            : kind == "ENOSPC" ? ENOSPC
            : kind == "EIO"    ? EIO
            : kind == "EDQUOT" ? EDQUOT
                               : 0;
  }
};

const Plan& plan() {
  static const Plan the_plan;
  return the_plan;
}

std::atomic<long> calls{0};

template <typename Function>
Function* next(Function*& kept, const char* name) {
  if (kept == nullptr) kept = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
  return kept;
}

// What the C library offers under a name that stands here too.
#define KERF_NEXT(name)                \
  ([]() {                              \
    static decltype(&::name) function; \
    return next(function, #name);      \
  }())

void note(const char* call, const char* path) {
  const char* const log = std::getenv("KERF_FAULT_LOG");
  if (log == nullptr) return;
  std::array<char, 4600> line{};
  const int length = std::snprintf(line.data(), line.size(), "%s %s\n", call, path);
  const auto file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND, 0600));
  if (file < 0) return;
  (void)syscall(SYS_write, file, line.data(), static_cast<std::size_t>(length));
  (void)syscall(SYS_close, file);
}

bool lies_below(const char* path) {
  if (plan().at == 0 || path == nullptr) return false;
  Path whole{};
  if (path[0] != '/') {
    if (syscall(SYS_getcwd, whole.data(), whole.size() - 1) < 0) return false;
    const std::size_t length = std::strlen(whole.data());
    std::snprintf(whole.data() + length, whole.size() - length, "/%s", path);
    path = whole.data();
  }
  return std::string_view(path).starts_with(plan().below);
}

/// Whether this call is the one; says so.
bool is_the_one(const char* call, const char* path) {
  const long number = calls.fetch_add(1) + 1;
  if (number != plan().at && !(plan().from_then_on && number > plan().at)) return false;
  if (number == plan().at) note(call, path);
  if (plan().kind == "slow") usleep(2000);
  return true;
}

__attribute__((destructor)) void tell_the_count() {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%ld", calls.load());
  if (plan().kind == "count") note("calls", number.data());
}

/// Whether a call on a path is the one.
bool strikes(const char* call, const char* path) { return lies_below(path) && is_the_one(call, path); }

/// Whether a call on an open file is the one.
bool strikes(const char* call, int file) {
  if (plan().at == 0) return false;
  std::array<char, 64> link{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", file);
  Path path{};
  if (readlink(link.data(), path.data(), path.size() - 1) < 0) return false;
  return path[0] == '/' && strikes(call, path.data());  // no pipe, no socket
}

/// The call fails with the error that was asked for. Not every call knows every error.
bool fails(bool struck) {
  if (!struck || plan().error == 0) return false;
  errno = plan().error;
  return true;
}
bool fails_uninterrupted(bool struck) { return plan().error != EINTR && fails(struck); }

/// How much of a write is done.
std::size_t done_of(bool struck, std::size_t size) {
  return struck && plan().kind == "short" && size > 1 ? size / 2 : size;
}

mode_t mode_of(int flags, va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? static_cast<mode_t>(va_arg(more, int)) : 0;
}

}  // namespace

extern "C" {

int openat(int folder, const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  if (fails(strikes("open", path))) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return openat(AT_FDCWD, path, flags, mode);
}

int creat(const char* path, mode_t mode) {
  return openat(AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC, mode);
}

int open64(const char* path, int flags, ...) __attribute__((alias("open")));
int openat64(int folder, const char* path, int flags, ...) __attribute__((alias("openat")));
int creat64(const char* path, mode_t mode) __attribute__((alias("creat")));

// fopen opens within the C library.
FILE* fopen(const char* path, const char* mode) {
  if (fails(strikes("fopen", path))) return nullptr;
  return KERF_NEXT(fopen)(path, mode);
}
FILE* fopen64(const char* path, const char* mode) __attribute__((alias("fopen")));

ssize_t write(int file, const void* bytes, std::size_t size) {
  const bool struck = strikes("write", file);
  if (fails(struck)) return -1;
  return syscall(SYS_write, file, bytes, done_of(struck, size));
}

ssize_t pwrite(int file, const void* bytes, std::size_t size, off_t at) {
  const bool struck = strikes("pwrite", file);
  if (fails(struck)) return -1;
  return syscall(SYS_pwrite64, file, bytes, done_of(struck, size), at);
}
ssize_t pwrite64(int file, const void* bytes, std::size_t size, off_t at) __attribute__((alias("pwrite")));

ssize_t writev(int file, const iovec* parts, int count) {
  const bool struck = strikes("writev", file);
  if (fails(struck)) return -1;
  if (struck && plan().kind == "short" && count > 0)
    return syscall(SYS_write, file, parts[0].iov_base, done_of(true, parts[0].iov_len));
  return syscall(SYS_writev, file, parts, count);
}

ssize_t pwritev(int file, const iovec* parts, int count, off_t at) {
  const bool struck = strikes("pwritev", file);
  if (fails(struck)) return -1;
  if (struck && plan().kind == "short" && count > 0)
    return syscall(SYS_pwrite64, file, parts[0].iov_base, done_of(true, parts[0].iov_len), at);
  return KERF_NEXT(pwritev)(file, parts, count, at);
}
ssize_t pwritev64(int file, const iovec* parts, int count, off_t at) __attribute__((alias("pwritev")));

int ftruncate(int file, off_t length) noexcept {
  if (fails(strikes("ftruncate", file))) return -1;
  return static_cast<int>(syscall(SYS_ftruncate, file, length));
}
int ftruncate64(int file, off_t length) noexcept __attribute__((alias("ftruncate")));

int fallocate(int file, int mode, off_t begin, off_t length) {
  if (fails(strikes("fallocate", file))) return -1;
  return static_cast<int>(syscall(SYS_fallocate, file, mode, begin, length));
}
int fallocate64(int file, int mode, off_t begin, off_t length) __attribute__((alias("fallocate")));

int posix_fallocate(int file, off_t begin, off_t length) {
  if (fails(strikes("posix_fallocate", file))) return errno;
  return KERF_NEXT(posix_fallocate)(file, begin, length);
}
int posix_fallocate64(int file, off_t begin, off_t length) __attribute__((alias("posix_fallocate")));

int fsync(int file) {
  if (fails(strikes("fsync", file))) return -1;
  return static_cast<int>(syscall(SYS_fsync, file));
}

int fdatasync(int file) {
  if (fails(strikes("fdatasync", file))) return -1;
  return static_cast<int>(syscall(SYS_fdatasync, file));
}

// The file is closed whatever is said, as Linux does it.
int close(int file) {
  const bool struck = strikes("close", file);
  const auto closed = static_cast<int>(syscall(SYS_close, file));
  return fails(struck) ? -1 : closed;
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  if (fails_uninterrupted(strikes("rename", to))) return -1;
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

int rename(const char* from, const char* to) noexcept { return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0); }

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  return renameat2(from_folder, from, to_folder, to, 0);
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  if (fails_uninterrupted(strikes("link", to))) return -1;
  return static_cast<int>(syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}

int link(const char* from, const char* to) noexcept { return linkat(AT_FDCWD, from, AT_FDCWD, to, 0); }

int mkdir(const char* path, mode_t mode) noexcept {
  if (fails_uninterrupted(strikes("mkdir", path))) return -1;
  return static_cast<int>(syscall(SYS_mkdirat, AT_FDCWD, path, mode));
}

}  // extern "C"

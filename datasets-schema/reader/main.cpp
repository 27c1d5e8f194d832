// kerf-reader: reads one HDF5 file for the program that started it, which a damaged file could bring down
// (apart/reader_process.h). Has all signals blocked, a session of its own, and no more of the machine than
// reading takes.

#include <cerrno>
#include <cstdint>
#include <exception>
#include <string>

#include <fcntl.h>
#include <hdf5.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "apart/serve.h"

namespace {

using namespace kerf::schema::apart;

/// Sanitizers need a shadow that is larger than any memory, and system calls of their own.
#ifdef KERF_SANITIZED
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

void limit(__rlimit_resource resource, rlim_t most) {
  rlimit limits{};
  if (getrlimit(resource, &limits) != 0) return;
  most = most < limits.rlim_max ? most : limits.rlim_max;
  limits = {.rlim_cur = most, .rlim_max = most};
  static_cast<void>(setrlimit(resource, &limits));
}

/// What reading a file of so many bytes may take.
void give_up_the_rest(std::uint64_t file_bytes) {
  constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30U;
  if (!is_sanitized) limit(RLIMIT_AS, gibibyte + 4 * file_bytes);
  limit(RLIMIT_CPU, 3600);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_NOFILE, 32);
  limit(RLIMIT_NPROC, 0);
  limit(RLIMIT_CORE, 0);
  static_cast<void>(prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0));
  // Who starts it may be one of those that keep a deadline.
  const sched_param lowest{};
  static_cast<void>(sched_setscheduler(0, SCHED_OTHER, &lowest));
  // A file names filters that it wants, and other files that it goes on in: none is loaded or read for it.
  static_cast<void>(H5PLset_loading_state(0));
  static_cast<void>(H5Lunregister(H5L_TYPE_EXTERNAL));
}

/// From here on it may read, take memory, talk to who asks, and end. Whatever else a file might make of it is
/// refused by the system. @returns false where the system knows no such filters.
bool shut_itself_in() {
  scmp_filter_ctx const filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return false;
  bool is_whole = true;
  for (const int call : {SCMP_SYS(read),
                         SCMP_SYS(pread64),
                         SCMP_SYS(lseek),
                         SCMP_SYS(close),
                         SCMP_SYS(fstat),
                         SCMP_SYS(newfstatat),
                         SCMP_SYS(readlink),
                         SCMP_SYS(getcwd),
                         SCMP_SYS(flock),
                         SCMP_SYS(fcntl),
                         SCMP_SYS(brk),
                         SCMP_SYS(mmap),
                         SCMP_SYS(munmap),
                         SCMP_SYS(mremap),
                         SCMP_SYS(mprotect),
                         SCMP_SYS(madvise),
                         SCMP_SYS(recvfrom),
                         SCMP_SYS(sendto),
                         SCMP_SYS(futex),
                         SCMP_SYS(getrandom),
                         SCMP_SYS(clock_gettime),
                         SCMP_SYS(clock_nanosleep),
                         SCMP_SYS(getpid),
                         SCMP_SYS(gettid),
                         SCMP_SYS(tgkill),
                         SCMP_SYS(rt_sigaction),
                         SCMP_SYS(rt_sigprocmask),
                         SCMP_SYS(rt_sigreturn),
                         SCMP_SYS(exit),
                         SCMP_SYS(exit_group)}) {
    is_whole = seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0 && is_whole;
  }
  const scmp_arg_cmp only_reading{
      .arg = 2, .op = SCMP_CMP_MASKED_EQ, .datum_a = O_ACCMODE | O_CREAT | O_TRUNC, .datum_b = O_RDONLY};
  is_whole =
      seccomp_rule_add_array(filter, SCMP_ACT_ALLOW, SCMP_SYS(openat), 1, &only_reading) == 0 && is_whole;
  is_whole = is_whole && seccomp_load(filter) == 0;
  seccomp_release(filter);
  return is_whole;
}

}  // namespace

int main() {
  struct stat file {};
  if (fstat(reader_of_file, &file) != 0) return 1;
  give_up_the_rest(static_cast<std::uint64_t>(file.st_size));
  void* const mapped = mmap(nullptr, window_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, reader_of_window, 0);
  if (mapped == MAP_FAILED) return 1;
  // Where there are no filters, the limits stand.
  if (!is_sanitized) static_cast<void>(shut_itself_in());
  try {
    serve("/proc/self/fd/" + std::to_string(reader_of_file), reader_to_asker,
          Window(static_cast<std::byte*>(mapped), window_bytes));
  } catch (const std::exception&) {
    return 1;  // nobody listens
  }
  return 0;
}

// kerf-reader: reads one HDF5 file for the program that started it, which a damaged file could bring down
// (apart/reader_process.h). Has all signals blocked, a session of its own, and no more of the machine than
// reading takes.

#include <cstdint>
#include <exception>

#include <hdf5.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "apart/serve.h"

namespace {

using namespace kerf::schema::apart;

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
#ifndef KERF_SANITIZED  // whose shadow is larger than any memory
  limit(RLIMIT_AS, gibibyte + 4 * file_bytes);
#endif
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

}  // namespace

int main() {
  struct stat file {};
  if (fstat(reader_of_file, &file) != 0) return 1;
  give_up_the_rest(static_cast<std::uint64_t>(file.st_size));
  void* const mapped = mmap(nullptr, window_bytes, PROT_READ | PROT_WRITE, MAP_SHARED, reader_of_window, 0);
  if (mapped == MAP_FAILED) return 1;
  try {
    serve("/proc/self/fd/" + std::to_string(reader_of_file), reader_to_asker,
          Window(static_cast<std::byte*>(mapped), window_bytes));
  } catch (const std::exception&) {
    return 1;  // nobody listens
  }
  return 0;
}

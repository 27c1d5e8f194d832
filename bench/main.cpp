#include <exception>
#include <new>
#include <string_view>

#include <malloc.h>
#include <unistd.h>

#include "program/app.h"

namespace {

std::terminate_handler terminate_as_ever = nullptr;

/// Ends the program where memory is missing and nobody can catch it: before main(), and in what promised not
/// to throw. Whatever else ends it is for the handler of the library.
void end_without_memory() noexcept {
  try {
    if (const std::exception_ptr why = std::current_exception()) std::rethrow_exception(why);
  } catch (const std::bad_alloc&) {
    constexpr std::string_view line = "kerf: there is no memory\n";
    (void)!write(STDERR_FILENO, line.data(), line.size());
    _exit(static_cast<int>(kerf::bench::Exit::file_error));
  } catch (...) {
  }
  terminate_as_ever();
}

/// Before all that the program initialises.
[[gnu::constructor(101)]] void watch_for_memory() {
  terminate_as_ever = std::set_terminate(end_without_memory);
}

}  // namespace

int main(int argc, char** argv) {
  // A fit takes and gives back whole columns of samples; memory that returns to the kernel each time is
  // cleared anew.
  constexpr int large = 1 << 28;
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, large);
  return kerf::bench::run_program(argc, argv);
}

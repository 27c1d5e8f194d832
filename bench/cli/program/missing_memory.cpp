#include "program/missing_memory.h"

#include <atomic>
#include <exception>
#include <new>
#include <string_view>

#include <unistd.h>

#include "program/app.h"

namespace kerf::bench {
namespace {

std::terminate_handler terminate_as_ever = nullptr;
std::atomic<bool> memory_was_missing{false};

/// `new` asks here before it gives up.
[[noreturn]] void note_missing_memory() {
  memory_was_missing = true;
  throw std::bad_alloc();
}

/// Of std::terminate(). Where an exception leaves a function that promised not to throw, GCC ends the program
/// before it is caught: then nobody can say which one it was.
bool ends_without_memory() noexcept {
  const std::exception_ptr why = std::current_exception();
  if (!why) return memory_was_missing && std::uncaught_exceptions() > 0;
  try {
    std::rethrow_exception(why);
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
}

void end() noexcept {
  if (!ends_without_memory()) terminate_as_ever();
  constexpr std::string_view line = "kerf: there is no memory\n";
  (void)!write(STDERR_FILENO, line.data(), line.size());
  _exit(static_cast<int>(Exit::file_error));
}

}  // namespace

void end_where_memory_is_missing() noexcept {
  std::set_new_handler(note_missing_memory);
  terminate_as_ever = std::set_terminate(end);
}

}  // namespace kerf::bench

#include "crash.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>

#include <unistd.h>

#include "kerf/models/foreign.h"

namespace kerf::plugins {
namespace {

constexpr int status_of_a_crash = 4;
constexpr std::array crashes{SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};

std::array<struct sigaction, crashes.size()> before;

// By system calls alone: this may be a signal handler.
void put(const char* text) noexcept {
  const ssize_t written = write(STDERR_FILENO, text, std::strlen(text));
  static_cast<void>(written);
}

[[noreturn]] void end_for(const models::ForeignLaw& law, const char* what, const char* detail) noexcept {
  put("kerf: ");
  put(law.plugin().path.c_str());
  put(": the law of this plug-in ");
  put(what);
  put(detail);
  put("; the program ends, and motors are let go\n");
  _exit(status_of_a_crash);
}

void on_crash(int number, siginfo_t*, void*) noexcept {
  if (const models::ForeignLaw* const law = models::running_foreign_law()) {
    const char* const name = sigabbrev_np(number);
    end_for(*law, "crashed: SIG", name == nullptr ? "?" : name);
  }
  for (std::size_t i = 0; i < crashes.size(); ++i) {
    if (crashes[i] == number) sigaction(number, &before[i], nullptr);
  }
  raise(number);
}

void on_exit_of_program(int, void*) noexcept {
  if (const models::ForeignLaw* const law = models::running_foreign_law()) end_for(*law, "called exit()", "");
}

void install() {
  // Of the thread that loads: a plug-in that overflows its stack can be named there.
  static std::array<char, 16 * 1024> stack;
  const stack_t own{.ss_sp = stack.data(), .ss_flags = 0, .ss_size = stack.size()};
  stack_t there{};
  if (sigaltstack(nullptr, &there) == 0 && (there.ss_flags & SS_DISABLE) != 0) sigaltstack(&own, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_crash;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < crashes.size(); ++i) sigaction(crashes[i], &action, &before[i]);
  on_exit(on_exit_of_program, nullptr);
}

}  // namespace

void blame_crashes() {
  static std::once_flag once;
  std::call_once(once, install);
}

}  // namespace kerf::plugins

#include "crash.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>

#include <unistd.h>

#include "kerf/models/foreign.h"
#include "kerf/models/foreign_call.h"

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

constexpr int looks = 5;  // before a call is given up, for a thread that looks seldom may have slept too

[[noreturn]] void look_for_hangs(std::chrono::milliseconds patience) noexcept {
  struct Look {
    models::ForeignCall call;
    int same = 0;
  };
  const std::string what = "has not come back for " + std::to_string(patience.count()) + " ms";
  std::array<Look, models::watched_threads> last{};
  for (;;) {
    std::this_thread::sleep_for(patience / looks);
    for (std::size_t thread = 0; thread < last.size(); ++thread) {
      Look& look = last[thread];
      const models::ForeignCall call = models::foreign_call(thread);
      look.same = call.law != nullptr && call == look.call ? look.same + 1 : 0;
      look.call = call;
      if (look.same == looks) end_for(*call.law, what.c_str(), "");
    }
  }
}

}  // namespace

void blame_hangs(std::chrono::milliseconds patience) {
  static std::once_flag once;
  std::call_once(once, [&] {
    // Signals are for the threads that wait for them.
    sigset_t all;
    sigset_t before_it;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_it);
    std::thread(look_for_hangs, patience).detach();
    pthread_sigmask(SIG_SETMASK, &before_it, nullptr);
  });
}

void blame_crashes() {
  static std::once_flag once;
  std::call_once(once, install);
}

}  // namespace kerf::plugins

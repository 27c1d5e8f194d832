#include "trial/guarded_state.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "trial/report.h"

namespace kerf::law_trial {
namespace {

constexpr std::byte canary{0xC5};

struct Guarded {
  const std::byte* begin;
  const std::byte* end;
  std::string refusal;
};
std::vector<Guarded> guarded;

void on_fault(int number, siginfo_t* info, void*) {
  const auto* const at = static_cast<const std::byte*>(info->si_addr);
  for (const Guarded& one : guarded) {
    if (at >= one.begin && at < one.end) refuse(one.refusal);
  }
  (void)std::signal(number, SIG_DFL);
  (void)std::raise(number);
}

}  // namespace

GuardedBlock::GuardedBlock(std::size_t size, std::size_t alignment, const std::string& what) : size_(size) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t whole = std::max(page, (size + alignment + page - 1) / page * page);
  void* const memory =
      mmap(nullptr, whole + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) refuse("there is no memory for " + what);
  pages_ = static_cast<std::byte*>(memory);
  guard_ = pages_ + whole;
  mprotect(guard_, page, PROT_NONE);
  std::memset(pages_, static_cast<int>(canary), whole);
  begin_ = guard_ - (size + alignment - 1) / alignment * alignment;
  clear();
  guarded.push_back({.begin = guard_, .end = guard_ + page, .refusal = "it reads or writes behind " + what});
}

void GuardedBlock::clear() const noexcept {
  if (size_ > 0) std::memset(begin_, 0, size_);
}

bool GuardedBlock::is_damaged() const noexcept {
  const auto is_canary = [](std::byte one) { return one == canary; };
  return !std::all_of(pages_, begin_, is_canary) || !std::all_of(begin_ + size_, guard_, is_canary);
}

void GuardedBlock::make_read_only() const noexcept {
  guarded.push_back({.begin = pages_, .end = guard_, .refusal = "it writes to its parameters"});
  mprotect(pages_, static_cast<std::size_t>(guard_ - pages_), PROT_READ);
}

void watch_for_faults() {
  struct sigaction action {};
  action.sa_sigaction = on_fault;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGSEGV, SIGBUS}) sigaction(number, &action, nullptr);
}

}  // namespace kerf::law_trial

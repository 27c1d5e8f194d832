#include "kerf/drivers/urgent_thread.h"

#include <algorithm>
#include <mutex>

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace kerf::drivers {
namespace {

cpu_set_t allowed_processors() noexcept {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  (void)sched_getaffinity(0, sizeof allowed, &allowed);
  return allowed;
}

/// Those of the process, before any thread kept itself off one: a thread inherits what its parent did, and
/// all have to mean the same one by the loop's.
const cpu_set_t process_processors = allowed_processors();

struct Urgent {
  std::mutex mutex;
  std::vector<UrgentThread> threads;
};
Urgent& urgent() {
  static Urgent all;
  return all;
}

}  // namespace

Priorities priorities_within(std::uint64_t rtprio_limit) noexcept {
  constexpr Priorities usual;
  if (rtprio_limit < 2) return usual;
  const auto most = static_cast<int>(std::min<std::uint64_t>(rtprio_limit, usual.urgent));
  return {.loop = most - 1, .urgent = most};
}

Priorities priorities() noexcept {
  rlimit limit{};
  if (geteuid() == 0 || getrlimit(RLIMIT_RTPRIO, &limit) != 0) return {};
  return priorities_within(limit.rlim_cur);
}

int loop_processor() noexcept {
  int last = -1;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &process_processors)) last = cpu;
  }
  return last;
}

void stay_off_loop_processor() noexcept {
  cpu_set_t others = process_processors;
  if (CPU_COUNT(&others) < 2) return;
  CPU_CLR(loop_processor(), &others);
  (void)sched_setaffinity(0, sizeof others, &others);
}

void become_urgent(const std::string& name) {
  stay_off_loop_processor();
  pthread_setname_np(pthread_self(), name.c_str());
  prctl(PR_SET_TIMERSLACK, 1UL);
  const sched_param parameters{.sched_priority = priorities().urgent};
  const bool obtained = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
  const UrgentThread here{.name = name, .priority = obtained ? parameters.sched_priority : 0};
  const std::lock_guard lock(urgent().mutex);
  const auto same = std::ranges::find(urgent().threads, name, &UrgentThread::name);
  if (same == urgent().threads.end()) {
    urgent().threads.push_back(here);
  } else {
    *same = here;
  }
}

std::vector<UrgentThread> urgent_threads() {
  const std::lock_guard lock(urgent().mutex);
  return urgent().threads;
}

}  // namespace kerf::drivers

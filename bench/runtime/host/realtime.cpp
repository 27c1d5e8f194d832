#include "host/realtime.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/core.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <kerf/drivers/urgent_thread.h>

namespace kerf::bench {
namespace {

/// Those of the calling thread.
cpu_set_t allowed_processors() noexcept {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  (void)sched_getaffinity(0, sizeof allowed, &allowed);
  return allowed;
}

std::string reason() { return std::strerror(errno); }

}  // namespace

RealtimeMeasure use_realtime_scheduling() {
  const int priority = drivers::priorities().loop;
  const sched_param parameters{.sched_priority = priority};
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) {
    return {
        .name = "scheduling", .obtained = true, .detail = fmt::format("SCHED_FIFO at priority {}", priority)};
  }
  return {
      .name = "scheduling",
      .obtained = false,
      .detail = fmt::format("ordinary scheduling, SCHED_FIFO refused: {}; permit it by 'USER - rtprio {}' in "
                            "/etc/security/limits.conf and log in again",
                            reason(), drivers::Priorities{}.urgent)};
}

RealtimeMeasure lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  // Locking future memory under a small limit would make later allocations fail.
  if (geteuid() == 0 || limit.rlim_cur == RLIM_INFINITY) {
    if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
      std::array<volatile char, 256 * 1024> stack{};
      for (std::size_t page = 0; page < stack.size(); page += 4096) stack[page] = 1;
      return {.name = "memory", .obtained = true, .detail = "locked, stack touched"};
    }
    return {.name = "memory", .obtained = false, .detail = fmt::format("not locked: {}", reason())};
  }
  return {.name = "memory",
          .obtained = false,
          .detail = fmt::format("not locked: the limit is {} kB; permit it by 'USER - memlock unlimited' in "
                                "/etc/security/limits.conf and log in again",
                                limit.rlim_cur / 1024)};
}

RealtimeMeasure wake_without_slack() {
  if (prctl(PR_SET_TIMERSLACK, 1UL) == 0) {
    return {.name = "timers", .obtained = true, .detail = "woken without slack"};
  }
  return {.name = "timers", .obtained = false, .detail = fmt::format("woken with slack: {}", reason())};
}

std::vector<RealtimeMeasure> urgent_threads() {
  std::vector<RealtimeMeasure> measures;
  for (const drivers::UrgentThread& thread : drivers::urgent_threads()) {
    measures.push_back(
        {.name = thread.name,
         .obtained = thread.priority > 0,
         .detail = thread.priority > 0
                       ? fmt::format("SCHED_FIFO at priority {}, off the loop's processor", thread.priority)
                       : "ordinary scheduling, off the loop's processor"});
  }
  return measures;
}

RealtimeMeasure pin_to_processor() {
  const int processor = drivers::loop_processor();
  cpu_set_t one;
  CPU_ZERO(&one);
  if (processor >= 0) CPU_SET(processor, &one);
  if (processor >= 0 && sched_setaffinity(0, sizeof one, &one) == 0) {
    return {.name = "processor", .obtained = true, .detail = fmt::format("stays on processor {}", processor)};
  }
  return {.name = "processor", .obtained = false, .detail = fmt::format("not pinned: {}", reason())};
}

void give_way() noexcept {
  constexpr int patient = 10;  // a tenth of a busy processor, still: a fit must end some day
  // Of a thread, not of the process: Linux keeps it for each.
  const auto self = static_cast<id_t>(gettid());
  (void)setpriority(PRIO_PROCESS, self, std::max(patient, getpriority(PRIO_PROCESS, self)));
}

std::size_t usable_processors() noexcept {
  const cpu_set_t allowed = allowed_processors();
  return static_cast<std::size_t>(std::max(1, CPU_COUNT(&allowed)));
}

bool may_use_realtime_scheduling() noexcept {
  rlimit limit{};
  return geteuid() == 0 || (getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur >= 2);
}

ThreadUsage ThreadUsage::now() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {.page_faults = usage.ru_minflt,
          .major_page_faults = usage.ru_majflt,
          .voluntary_switches = usage.ru_nvcsw,
          .involuntary_switches = usage.ru_nivcsw};
}

ThreadUsage ThreadUsage::since(const ThreadUsage& before) const noexcept {
  return {.page_faults = page_faults - before.page_faults,
          .major_page_faults = major_page_faults - before.major_page_faults,
          .voluntary_switches = voluntary_switches - before.voluntary_switches,
          .involuntary_switches = involuntary_switches - before.involuntary_switches};
}

AwakeProcessors::AwakeProcessors() : measure_{.name = "sleep_states", .obtained = false, .detail = {}} {
  descriptor_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const std::int32_t no_latency = 0;
  if (descriptor_ >= 0 && write(descriptor_, &no_latency, sizeof no_latency) == sizeof no_latency) {
    measure_.obtained = true;
    measure_.detail = "deep sleep states held off";
  } else {
    measure_.detail = fmt::format(
        "deep sleep states stay on, /dev/cpu_dma_latency: {}; permit it by a udev rule that "
        "gives your group write access",
        reason());
  }
}

AwakeProcessors::~AwakeProcessors() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace kerf::bench

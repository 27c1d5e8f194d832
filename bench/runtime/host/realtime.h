#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <kerf/drivers/urgent_thread.h>

namespace kerf::bench {

/// One measure towards an undisturbed loop: what it is, whether it was obtained, and if not, why and how to
/// permit it.
struct RealtimeMeasure {
  std::string name;
  bool obtained = false;
  std::string detail;
};

/// Runs the calling thread at SCHED_FIFO with a priority below the kernel's own interrupt threads.
[[nodiscard]] RealtimeMeasure use_realtime_scheduling();
/// Locks the process's memory and touches the stack, so that the loop meets no page fault.
[[nodiscard]] RealtimeMeasure lock_memory();
/// Keeps the calling thread on the last processor that it may use.
[[nodiscard]] RealtimeMeasure pin_to_processor();

/// Lets the calling thread be woken at the time that it asked for: an ordinary thread is else woken up to 50
/// us later.
[[nodiscard]] RealtimeMeasure wake_without_slack();
/// What the threads obtained that must not wait for the loop: watchdog, and who speaks to a device.
[[nodiscard]] std::vector<RealtimeMeasure> urgent_threads();

using drivers::stay_off_loop_processor;
/// Makes the calling thread, and those that it starts, give way to everything else: nice 10, at which a busy
/// machine still comes to it.
void give_way() noexcept;
/// How many processors the calling thread may use, at least 1.
[[nodiscard]] std::size_t usable_processors() noexcept;
/// Whether this user may run a loop at SCHED_FIFO, and others above it.
[[nodiscard]] bool may_use_realtime_scheduling() noexcept;

/// What the system has counted for a thread.
struct ThreadUsage {
  std::int64_t page_faults = 0;           ///< without reading from a disk
  std::int64_t major_page_faults = 0;     ///< with reading from a disk
  std::int64_t voluntary_switches = 0;    ///< it slept or waited
  std::int64_t involuntary_switches = 0;  ///< it was made to wait

  /// Of the calling thread so far.
  [[nodiscard]] static ThreadUsage now() noexcept;
  [[nodiscard]] ThreadUsage since(const ThreadUsage& before) const noexcept;
};

/// Holds the processors out of deep sleep through /dev/cpu_dma_latency while the object lives.
class AwakeProcessors {
 public:
  AwakeProcessors();
  AwakeProcessors(const AwakeProcessors&) = delete;
  AwakeProcessors& operator=(const AwakeProcessors&) = delete;
  ~AwakeProcessors();
  [[nodiscard]] const RealtimeMeasure& measure() const noexcept { return measure_; }

 private:
  int descriptor_ = -1;
  RealtimeMeasure measure_;
};

}  // namespace kerf::bench

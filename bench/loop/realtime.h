#pragma once

#include <string>
#include <vector>

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

#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>

#include "doctor/facts/host_tree.h"
#include "doctor/watch/history.h"

namespace kerf::bench::doctor {

/// Looks at the machine from a thread of its own, off the loop's processor, while a loop runs: at what the
/// kernel counts each 20 ms, at all threads four times a second, and at both at once when somebody was late.
/// A scan of threads that takes long is done less often, so that looking takes a tenth of a processor at
/// most.
class MachineObserver {
 public:
  /// `late`: how many late wake-ups there have been; asked from the observer's thread.
  MachineObserver(const HostTree& tree, int processor, std::function<std::size_t()> late);
  MachineObserver(const MachineObserver&) = delete;
  MachineObserver& operator=(const MachineObserver&) = delete;
  ~MachineObserver() = default;

  /// Looks a last time and ends. @returns what was seen.
  [[nodiscard]] History end();

 private:
  void observe(const std::stop_token& stop);
  void scan();

  const HostTree& tree_;
  int processor_;
  std::function<std::size_t()> late_;
  History history_;
  std::vector<Task> last_tasks_;
  std::int64_t last_scan_ns_ = 0;
  std::int64_t scan_took_ns_ = 0;
  std::jthread thread_;  ///< the last member: it uses all the others
};

}  // namespace kerf::bench::doctor

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench::doctor {

// What the kernel has counted for one processor, out of its texts.

/// Time of a processor since the start [us], in steps of a clock tick, some 10 ms.
struct ProcessorTimes {
  double total_us = 0.0;
  double idle_us = 0.0;
  double interrupt_us = 0.0;
  double softirq_us = 0.0;
  double steal_us = 0.0;  ///< it had something to do, and the hypervisor had it wait
};
/// Of /proc/stat; nothing if it does not tell of that processor.
[[nodiscard]] std::optional<ProcessorTimes> processor_times(std::string_view stat, int processor,
                                                            std::int64_t ticks_per_s);

/// Something that is counted by name.
struct Count {
  std::string name;  ///< "36 virtio1-req.0", "LOC Local timer interrupts", "NET_RX"
  std::uint64_t count = 0;
};
/// Of /proc/interrupts, in its order; empty if it does not tell of that processor.
[[nodiscard]] std::vector<Count> interrupts_of(std::string_view interrupts, int processor);
/// Of /proc/softirqs.
[[nodiscard]] std::vector<Count> softirqs_of(std::string_view softirqs, int processor);
/// Whether it is the processor's own timer, which wakes every sleeper.
[[nodiscard]] bool is_timer(const Count& interrupt);

/// By how much each grew, the most first; those that did not are left out.
[[nodiscard]] std::vector<Count> growth(const std::vector<Count>& before, const std::vector<Count>& after);

}  // namespace kerf::bench::doctor

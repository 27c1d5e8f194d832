#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace kerf::drivers {

/// Priorities of SCHED_FIFO: of a loop, and above it of what must not wait for one.
struct Priorities {
  int loop = 79;
  int urgent = 80;
};
/// The highest two that a limit of `rtprio` permits, at most those above; those above too where it permits
/// less than two, which the system then refuses to whoever has no right of another kind.
[[nodiscard]] Priorities priorities_within(std::uint64_t rtprio_limit) noexcept;
/// Those of this user.
[[nodiscard]] Priorities priorities() noexcept;

/// The processor that a loop keeps to, -1 if that cannot be told: the last one of those that the process may
/// use, because the first is where most systems handle their interrupts.
[[nodiscard]] int loop_processor() noexcept;
/// Keeps the calling thread off it where there is another: what it does in the kernel cannot always be
/// interrupted.
void stay_off_loop_processor() noexcept;

/// A thread that must not wait for the loop, and what it obtained.
struct UrgentThread {
  std::string name;
  int priority = 0;  ///< of SCHED_FIFO; 0: it is scheduled as any other
};
/// Makes the calling thread one: as urgent as is permitted, off the loop's processor, woken without slack.
/// Its name, of at most 15 letters, is what the system shows.
void become_urgent(const std::string& name);
/// Those that have become so, each name once, as it went the last time.
[[nodiscard]] std::vector<UrgentThread> urgent_threads();

}  // namespace kerf::drivers

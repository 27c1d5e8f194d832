#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "host/realtime.h"

namespace kerf::bench {

/// The stages of a tick, and the wake-up before them.
enum class Stage : std::uint8_t { wake, read, compute, write, record };
inline constexpr std::array<const char*, 5> stage_names{"wake", "read", "compute", "write", "record"};

/// Who is to blame where a rate was not held.
enum class Cause : std::uint8_t { law, device, machine, unknown };
inline constexpr std::array<const char*, 4> cause_names{"law", "device", "machine", "unknown"};

/// A law may use half of the periods that it steps over.
inline constexpr double compute_share = 0.5;

/// A tick that cost deadlines, with what speaks for and against each who may be to blame.
struct Miss {
  std::uint64_t tick = 0;
  std::uint64_t deadlines = 0;  ///< that it cost
  Stage stage = Stage::wake;    ///< that took longest
  std::int64_t wall_ns = 0;     ///< by the clock, in that stage
  // Processor time of the thread in that stage. At most what was used since somebody asked for it last; at
  // least that without all the time up to the stage, which it is exactly if nobody made the thread wait.
  std::int64_t most_cpu_ns = 0;
  std::int64_t least_cpu_ns = 0;
  std::uint64_t periods = 1;     ///< that the rendering stepped over
  std::int64_t waited = 0;       ///< times that the thread waited of itself in this tick
  std::int64_t preempted = 0;    ///< times that it was made to wait
  std::int64_t disk_faults = 0;  ///< pages that were read from a disk
  bool stood_still = false;      ///< the whole process did, the watchdog with it
  Cause cause = Cause::unknown;
};

/// What a miss says.
///
/// A loop that was woken late, was stopped as a whole, or was held up in handing over a row, was held up by
/// the machine. A computation that used more than half of the periods that it stepped over, or waited of
/// itself without being made to, is the law's; one that used no more is the machine's, which made it wait or
/// had made it late before: a law whose cost grows with the time that it steps over is not to blame for a
/// step that somebody else made long. A read or write in which the thread worked, or waited of itself without
/// being made to, is the device's; one in which it was made to wait, or stood still for no reason of its own,
/// is the machine's. What the evidence does not decide is unknown.
[[nodiscard]] Cause cause_of(const Miss& miss, double period_ns) noexcept;

/// The evidence, in words.
[[nodiscard]] std::string in_words(const Miss& miss);

/// Collects the evidence of one tick while it runs. Asks the system shortly before the deadline, while the
/// loop waits for it anyway, and again only in a tick that lasts long.
template <typename Clock>
class Evidence {
 public:
  explicit Evidence(std::int64_t period_ns) noexcept : long_ns_(period_ns / 4) {}

  /// Shortly before the tick, at `now_ns`.
  void begin(const Clock& clock, std::int64_t now_ns) noexcept {
    usage_ = clock.usage();
    know_cpu(clock.cpu_ns(), now_ns);
    miss_ = {};
  }
  /// A stage is over; one that was long is looked at.
  void end(const Clock& clock, Stage stage, std::int64_t from_ns, std::int64_t until_ns) noexcept {
    const std::int64_t wall_ns = until_ns - from_ns;
    if (wall_ns < long_ns_) return;
    const std::int64_t cpu_ns = clock.cpu_ns();
    if (wall_ns > miss_.wall_ns) {
      miss_.stage = stage;
      miss_.wall_ns = wall_ns;
      miss_.most_cpu_ns = std::min(cpu_ns - cpu_ns_, wall_ns);
      miss_.least_cpu_ns = std::max<std::int64_t>(0, cpu_ns - cpu_ns_ - (from_ns - known_ns_));
      miss_.least_cpu_ns = std::min(miss_.least_cpu_ns, miss_.most_cpu_ns);
    }
    know_cpu(cpu_ns, until_ns);
  }
  /// The tick has cost deadlines, most by this stage.
  [[nodiscard]] Miss judge(const Clock& clock, Miss about, double period_ns) noexcept {
    const ThreadUsage used = clock.usage().since(usage_);
    if (miss_.stage == about.stage) {
      about.most_cpu_ns = miss_.most_cpu_ns;
      about.least_cpu_ns = miss_.least_cpu_ns;
    }
    about.waited = used.voluntary_switches;
    about.preempted = used.involuntary_switches;
    about.disk_faults = used.major_page_faults;
    if (about.preempted == 0) about.most_cpu_ns = about.least_cpu_ns;
    about.cause = cause_of(about, period_ns);
    return about;
  }

 private:
  void know_cpu(std::int64_t cpu_ns, std::int64_t now_ns) noexcept {
    cpu_ns_ = cpu_ns;
    known_ns_ = now_ns;
  }

  std::int64_t long_ns_;
  ThreadUsage usage_;
  std::int64_t cpu_ns_ = 0;
  std::int64_t known_ns_ = 0;
  Miss miss_;
};

}  // namespace kerf::bench

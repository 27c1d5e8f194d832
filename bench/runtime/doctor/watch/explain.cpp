#include "doctor/watch/explain.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace kerf::bench::doctor {
namespace {

constexpr double interrupt_us = 10.0;  // a long one

double us(std::int64_t ns) { return 1e-3 * static_cast<double>(ns); }

std::uint64_t all_but_timer(const std::vector<Count>& counts) {
  std::uint64_t sum = 0;
  for (const Count& count : counts) sum += is_timer(count) ? 0 : count.count;
  return sum;
}

/// The counts on both sides of a wake-up; nothing if there are none on one.
struct Around {
  const Moment* before = nullptr;
  const Moment* after = nullptr;
};
Around around(const LateWake& wake, const std::vector<Moment>& moments) {
  Around found;
  for (const Moment& moment : moments) {
    if (moment.at_ns <= wake.due_ns) found.before = &moment;
    if (moment.at_ns >= wake.woken_ns && found.after == nullptr) found.after = &moment;
  }
  return found;
}

void count_interrupts(const Around& counts, const std::vector<Moment>& moments, WakeEvidence& evidence) {
  const Moment& first = moments.front();
  const Moment& last = moments.back();
  const double run_us = std::max(1.0, us(last.at_ns - first.at_ns));
  const auto in_window = growth(counts.before->interrupts, counts.after->interrupts);
  const auto in_run = growth(first.interrupts, last.interrupts);
  evidence.interrupts_expected = static_cast<double>(all_but_timer(in_run)) / run_us * evidence.window_us;
  evidence.more_interrupts =
      std::max(0.0, static_cast<double>(all_but_timer(in_window)) - evidence.interrupts_expected);
  const auto most = std::ranges::find_if_not(in_window, is_timer);
  if (most != in_window.end()) evidence.interrupt = most->name;
}

/// Who of those that ran for at least so long made a thread wait: one that is more urgent, else who ran most.
const Task* who_ran(const std::vector<Task>& ran, int than_priority, double at_least_us) {
  const Task* most = nullptr;
  for (const Task& task : ran) {
    if (task.run_us < at_least_us) continue;
    if (task.rt_priority > than_priority) return &task;
    if (most == nullptr) most = &task;
  }
  return most;
}

}  // namespace

WakeEvidence evidence_for(const LateWake& wake, const History& history, std::span<const LateWake> witness) {
  WakeEvidence evidence;
  for (const LateWake& other : witness) {
    const std::int64_t together_ns =
        std::min(wake.woken_ns, other.woken_ns) - std::max(wake.due_ns, other.due_ns);
    evidence.others_stood_still |= 2 * together_ns >= wake.late_ns();
  }
  for (const TasksBetween& tasks : history.tasks) {
    if (tasks.from_ns <= wake.woken_ns && tasks.until_ns >= wake.due_ns) add_tasks(evidence.ran, tasks.ran);
  }
  const Around counts = around(wake, history.moments);
  if (counts.before == nullptr || counts.after == nullptr) return evidence;
  evidence.window_us = us(counts.after->at_ns - counts.before->at_ns);
  if (counts.before->times && counts.after->times)
    evidence.steal_us = counts.after->times->steal_us - counts.before->times->steal_us;
  if (counts.before->throttled && counts.after->throttled)
    evidence.throttled_times =
        static_cast<double>(counts.after->throttled->times - counts.before->throttled->times);
  count_interrupts(counts, history.moments, evidence);
  return evidence;
}

ExplainedWake explain(const LateWake& wake, const WakeEvidence& evidence) {
  const double late_us = us(wake.late_ns());
  const double waited_us = wake.run_delay_ns < 0 ? 0.0 : us(wake.run_delay_ns);
  const auto because = [&](WakeCause cause, std::string by) {
    return ExplainedWake{.wake = wake, .cause = cause, .by = std::move(by), .pid = 0};
  };
  if (wake.usage.major_page_faults > 0)
    return because(WakeCause::page_fault,
                   fmt::format("{} pages of its own read from a disk", wake.usage.major_page_faults));
  const bool had_to_wait = 2.0 * waited_us >= late_us;
  if (had_to_wait && evidence.throttled_times > 0.0)
    return because(WakeCause::throttled,
                   fmt::format("its control group was held back {:.0f} times", evidence.throttled_times));
  const Task* const who = who_ran(evidence.ran, wake.priority, waited_us / 2.0);
  if (had_to_wait && who != nullptr) {
    ExplainedWake found = because(WakeCause::process, in_words(*who));
    found.pid = who->pid;
    return found;
  }
  if (2.0 * evidence.steal_us >= late_us)
    return because(WakeCause::steal, fmt::format("the hypervisor took {:.0f} us of the {:.0f} us around it",
                                                 evidence.steal_us, evidence.window_us));
  if (had_to_wait)
    return because(WakeCause::unknown,
                   fmt::format("it waited {:.0f} us for its processor; for whom was not seen", waited_us));
  if (evidence.others_stood_still)
    return because(WakeCause::stood_still, "another processor stood still at the same time");
  const double usual = evidence.interrupts_expected;
  if (evidence.more_interrupts * interrupt_us >= late_us &&
      evidence.more_interrupts > 3.0 * std::sqrt(std::max(1.0, usual)))
    return because(WakeCause::interrupts, fmt::format("{:.0f} more than usual, most of them {}",
                                                      evidence.more_interrupts, evidence.interrupt));
  return because(WakeCause::unknown, wake.run_delay_ns < 0
                                         ? "the kernel does not tell whether it was woken late or had to wait"
                                         : "it was woken late, and nothing within this machine was seen");
}

std::vector<ExplainedWake> explain_all(std::span<const LateWake> wakes, const History& history,
                                       std::span<const LateWake> witness) {
  std::vector<ExplainedWake> all;
  all.reserve(wakes.size());
  for (const LateWake& wake : wakes) all.push_back(explain(wake, evidence_for(wake, history, witness)));
  return all;
}

}  // namespace kerf::bench::doctor

#include "doctor/facts/rights.h"

#include <algorithm>
#include <charconv>
#include <string>

#include <fmt/core.h>

#include "doctor/facts/cgroups.h"

namespace kerf::bench::doctor {
namespace {

constexpr int cap_ipc_lock = 14;
constexpr int cap_sys_nice = 23;

std::string told(std::optional<std::int64_t> limit) {
  if (!limit) return "not told";
  return *limit < 0 ? "unlimited" : fmt::format("{}", *limit);
}

std::string told(std::optional<bool> capability) {
  if (!capability) return "not told";
  return *capability ? "yes" : "no";
}

constexpr const char* rights_mend =
    "sudo addgroup haptics; sudo adduser $USER haptics; sudo cp examples/rights/kerf.conf "
    "/etc/security/limits.d/   # then log in again";

/// The folder of a group that gives real-time threads no time at all, whatever their rights: kernels with
/// CONFIG_RT_GROUP_SCHED under version 1.
std::optional<std::string> group_without_realtime(const HostTree& tree) {
  for (const std::string& folder : cpu_groups(tree)) {
    if (tree.number(folder + "/cpu.rt_runtime_us") == 0) return folder;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::int64_t> limit_of(std::string_view limits, std::string_view name) {
  for (const std::string_view line : lines_of(limits)) {
    if (!line.starts_with(name)) continue;
    const auto words = words_of(line.substr(name.size()));
    if (words.empty()) return std::nullopt;
    return words.front() == "unlimited" ? std::optional<std::int64_t>(-1) : number_of(words.front());
  }
  return std::nullopt;
}

std::optional<bool> has_capability(std::string_view status, int number) {
  for (const std::string_view line : lines_of(status)) {
    if (!line.starts_with("CapEff:")) continue;
    const auto words = words_of(line);
    if (words.size() < 2) return std::nullopt;
    std::uint64_t set = 0;
    const auto [end, error] = std::from_chars(words[1].data(), words[1].data() + words[1].size(), set, 16);
    if (error != std::errc{}) return std::nullopt;
    return ((set >> number) & 1U) != 0;
  }
  return std::nullopt;
}

Finding realtime_scheduling(const HostTree& tree, const MachineTrials& trials) {
  const auto limits = tree.text("/proc/self/limits").value_or("");
  const auto status = tree.text("/proc/self/status").value_or("");
  Finding finding{.name = "realtime_scheduling",
                  .state = trials.may_be_realtime ? State::good : State::costs,
                  .seen = fmt::format("{} (tried); limit rtprio {}, nice {}, capability SYS_NICE {}",
                                      trials.realtime_detail, told(limit_of(limits, "Max realtime priority")),
                                      told(limit_of(limits, "Max nice priority")),
                                      told(has_capability(status, cap_sys_nice))),
                  .where = "sched_setscheduler(2), /proc/self/limits, /proc/self/status",
                  .cost = {},
                  .mend = {}};
  if (trials.realtime) {
    finding.cost = {
        .us = std::max(0.0, trials.without_slack.p99_us - trials.realtime->p99_us),
        .why = "measured: lateness of a sleeper at p99 under ordinary scheduling less that at SCHED_FIFO"};
    return finding;
  }
  finding.cost.why = "not measured: that needs the right";
  finding.mend = rights_mend;
  if (const auto folder = group_without_realtime(tree)) {
    finding.seen += fmt::format("; {} gives real-time threads no time", *folder);
    finding.mend = fmt::format(
        "echo 950000 | sudo tee {}/cpu.rt_runtime_us   # in a container: docker run "
        "--cpu-rt-runtime=950000 --ulimit rtprio=80 --cap-add=sys_nice",
        *folder);
  }
  return finding;
}

Finding memory_lock(const HostTree& tree) {
  constexpr std::string_view name = "memory_lock";
  constexpr std::string_view where = "/proc/self/limits, /proc/self/status";
  const auto limits = tree.text("/proc/self/limits");
  if (!limits) return unknown(name, where, "the limits are not told");
  const auto limit = limit_of(*limits, "Max locked memory");
  const auto capability = has_capability(tree.text("/proc/self/status").value_or(""), cap_ipc_lock);
  if (!limit && !capability) return unknown(name, where, "the limit is not told");
  const bool may = limit.value_or(0) < 0 || capability.value_or(false);
  Finding finding{
      .name = std::string(name),
      .state = may ? State::good : State::costs,
      .seen = fmt::format("limit memlock {} bytes, capability IPC_LOCK {}", told(limit), told(capability)),
      .where = std::string(where),
      .cost = {.us = std::nullopt,
               .why = "not measured: a page that has to come from a disk takes milliseconds; own page "
                      "faults of late ticks are counted"},
      .mend = {}};
  if (!may) finding.mend = rights_mend;
  return finding;
}

Finding realtime_throttling(const HostTree& tree, std::optional<double> loop_share) {
  constexpr std::string_view name = "realtime_throttling";
  const std::string path = "/proc/sys/kernel/sched_rt_runtime_us";
  const auto runtime_us = tree.number(path);
  const auto period_us = tree.number("/proc/sys/kernel/sched_rt_period_us");
  if (!runtime_us || !period_us || *period_us <= 0)
    return unknown(name, path, "how much of a processor real-time threads are given is not told");
  Finding finding{
      .name = std::string(name), .state = State::good, .seen = {}, .where = path, .cost = {}, .mend = {}};
  if (*runtime_us < 0) {
    finding.seen = "real-time threads are given all of a processor";
    finding.cost.why = "there is none";
    return finding;
  }
  const double share = static_cast<double>(*runtime_us) / static_cast<double>(*period_us);
  finding.seen = fmt::format("real-time threads are given {:.0f} % of a processor", 100.0 * share);
  finding.cost.why = fmt::format("not measured: a loop that uses more stands still for {} us in each {} us",
                                 *period_us - *runtime_us, *period_us);
  if (!loop_share) {
    finding.state = State::unknown;
    finding.seen += "; what the loop uses was not measured";
    return finding;
  }
  finding.seen += fmt::format("; the loop uses {:.1f} %", 100.0 * *loop_share);
  if (*loop_share < share) return finding;
  finding.state = State::costs;
  finding.mend =
      "sudo sysctl kernel.sched_rt_runtime_us=-1   # then a loop that never sleeps takes the processor for "
      "good";
  return finding;
}

Finding timer_slack(const MachineTrials& trials) {
  constexpr std::int64_t usual_ns = 50'000;
  Finding finding{
      .name = "timer_slack",
      .state = trials.slack_ns > usual_ns ? State::costs : State::good,
      .seen = fmt::format("timers of this process are {} ns late unless it asks; the loop asks for 1 ns",
                          trials.slack_ns),
      .where = "prctl(PR_GET_TIMERSLACK)",
      .cost = {.us = std::max(0.0, trials.with_slack.p50_us - trials.without_slack.p50_us),
               .why = "measured: lateness of an ordinary sleeper at the median with this slack less that "
                      "with 1 ns"},
      .mend = {}};
  if (trials.slack_ns > usual_ns)
    finding.mend =
        "echo 0 > /proc/PID/timerslack_ns   # of the shell or service that starts Kerf and hands the slack "
        "down";
  return finding;
}

}  // namespace kerf::bench::doctor

#include "doctor/facts/processors.h"

#include <algorithm>
#include <string>

#include <fmt/core.h>

namespace kerf::bench::doctor {
namespace {

std::string processor_folder(int processor) {
  return fmt::format("/sys/devices/system/cpu/cpu{}", processor);
}

struct IdleState {
  std::string name;
  std::int64_t latency_us = 0;
};

/// The one of longest latency that is not disabled; nothing if no state tells one.
std::optional<IdleState> deepest_idle_state(const HostTree& tree, const std::string& folder) {
  std::optional<IdleState> deepest;
  for (const std::string& state : tree.names(folder)) {
    const std::string path = folder + "/" + state;
    const auto latency = tree.number(path + "/latency");
    if (!latency || tree.number(path + "/disable").value_or(0) != 0) continue;
    if (!deepest || *latency > deepest->latency_us)
      deepest = {.name = tree.text(path + "/name").value_or(state), .latency_us = *latency};
  }
  return deepest;
}

/// As PM QoS takes a request of 0 us.
constexpr std::int64_t shallow_us = 10;

}  // namespace

Finding frequency_governor(const HostTree& tree, int processor, const MachineTrials& trials) {
  constexpr std::string_view name = "frequency_governor";
  const std::string folder = processor_folder(processor) + "/cpufreq";
  const std::string path = folder + "/scaling_governor";
  const auto governor = tree.text(path);
  if (!governor) {
    Finding finding = unknown(name, path,
                              "the governor cannot be seen or set here: the kernel shows no frequency "
                              "scaling (a virtual machine's is its host's)");
    finding.mend = "none here: set the governor where the processor is, on the host or in the firmware";
    return finding;
  }
  Finding finding{
      .name = std::string(name),
      .state = State::good,
      .seen = fmt::format("'{}' on processor {}", *governor, processor),
      .where = path,
      .cost = {.us = std::max(0.0, trials.work_after_sleep_us - trials.work_us),
               .why = fmt::format("measured: a computation of {:.0f} us takes so much longer after "
                                  "1 ms of sleep, at the median",
                                  trials.work_us)},
      .mend = {}};
  if (*governor == "performance") return finding;
  finding.state = State::costs;
  finding.mend = "sudo cpupower frequency-set -g performance";
  const auto offered = tree.text(folder + "/scaling_available_governors");
  if (offered && std::ranges::count(words_of(*offered), "performance") == 0)
    finding.mend = fmt::format("none here: this machine offers '{}' and no 'performance'", *offered);
  return finding;
}

Finding idle_states(const HostTree& tree, int processor, const MachineTrials& trials) {
  constexpr std::string_view name = "idle_states";
  const std::string folder = processor_folder(processor) + "/cpuidle";
  const auto deepest = deepest_idle_state(tree, folder);
  if (!deepest) {
    return unknown(name, folder,
                   "the kernel shows no idle states of this processor (a virtual machine's are its host's)");
  }
  Finding finding{
      .name = std::string(name),
      .state = State::good,
      .seen = fmt::format("deepest {}, {} us to wake from it", deepest->name, deepest->latency_us),
      .where = folder,
      .cost = {},
      .mend = {}};
  if (trials.awake) {
    const Percentiles& with = trials.realtime ? *trials.realtime : trials.without_slack;
    finding.cost = {.us = std::max(0.0, with.p99_us - trials.awake->p99_us),
                    .why = "measured: lateness of a sleeper at p99 with sleep states less that without"};
  } else {
    finding.cost.why =
        fmt::format("not measured, for that needs the right to hold them off; the kernel tells {} us",
                    deepest->latency_us);
  }
  if (deepest->latency_us <= shallow_us) return finding;
  if (trials.may_stay_awake) {
    finding.seen += "; the loop holds deep ones off through /dev/cpu_dma_latency";
    return finding;
  }
  finding.state = State::costs;
  finding.seen += "; " + trials.awake_detail;
  finding.mend =
      "sudo cp examples/rights/90-kerf-latency.rules /etc/udev/rules.d/ && sudo udevadm control --reload && "
      "sudo udevadm trigger --sysname-match=cpu_dma_latency";
  return finding;
}

std::vector<int> siblings_of(const HostTree& tree, int processor) {
  std::vector<int> siblings;
  const auto list = tree.text(processor_folder(processor) + "/topology/thread_siblings_list");
  if (!list) return siblings;
  constexpr int most = 4096;
  for (int other = 0; other < most; ++other) {
    if (other != processor && is_in_list(*list, other)) siblings.push_back(other);
  }
  return siblings;
}

Finding smt_siblings(const HostTree& tree, int processor, std::optional<double> busy) {
  constexpr std::string_view name = "smt_siblings";
  constexpr double idle_share = 0.05;
  const std::string path = processor_folder(processor) + "/topology/thread_siblings_list";
  const auto list = tree.text(path);
  if (!list) return unknown(name, path, "which processors share a core is not told");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = fmt::format("processor {} has its core to itself", processor),
                  .where = path,
                  .cost = {.us = std::nullopt, .why = "nobody shares the core"},
                  .mend = {}};
  const auto siblings = siblings_of(tree, processor);
  if (siblings.empty()) return finding;
  finding.seen = fmt::format("processors {} are one core", *list);
  finding.cost.why = "not measured: it slows down every computation by what both threads share";
  if (!busy) {
    finding.state = State::unknown;
    finding.seen += "; how busy the others were was not seen";
    return finding;
  }
  finding.seen += fmt::format(", of which another was at work for {:.0f} % of the run", 100.0 * *busy);
  if (*busy < idle_share) return finding;
  finding.state = State::costs;
  finding.mend = tree.has("/sys/devices/system/cpu/smt/control")
                     ? "echo off | sudo tee /sys/devices/system/cpu/smt/control"
                     : fmt::format("echo 0 | sudo tee {}/online", processor_folder(siblings.front()));
  return finding;
}

std::optional<std::int64_t> thermal_throttle_count(const HostTree& tree) {
  std::optional<std::int64_t> sum;
  for (const std::string& cpu : tree.names("/sys/devices/system/cpu")) {
    for (const char* const count : {"core_throttle_count", "package_throttle_count"}) {
      const auto counted =
          tree.number(fmt::format("/sys/devices/system/cpu/{}/thermal_throttle/{}", cpu, count));
      if (counted) sum = sum.value_or(0) + *counted;
    }
  }
  return sum;
}

Finding thermal_throttling(std::optional<std::int64_t> before, std::optional<std::int64_t> after) {
  constexpr std::string_view name = "thermal_throttling";
  constexpr std::string_view path = "/sys/devices/system/cpu/cpu*/thermal_throttle";
  if (!before || !after) return unknown(name, path, "nobody counts here how often heat slows it down");
  const std::int64_t during = *after - *before;
  Finding finding{
      .name = std::string(name),
      .state = during > 0 ? State::costs : State::good,
      .seen = fmt::format("slowed down {} times in the run, {} times since the start", during, *after),
      .where = std::string(path),
      .cost = {.us = std::nullopt, .why = "not measured: a slower clock, for as long as it is hot"},
      .mend = {}};
  if (during > 0) finding.mend = "sensors   # of lm-sensors: look at fans and dust, or take load off";
  return finding;
}

}  // namespace kerf::bench::doctor

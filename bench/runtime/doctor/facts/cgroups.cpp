#include "doctor/facts/cgroups.h"

#include <algorithm>
#include <string_view>

#include <fmt/core.h>

namespace kerf::bench::doctor {
namespace {

/// "50000 100000" of cpu.max, or the two files of version 1.
struct Quota {
  std::string folder;
  std::int64_t quota_us = 0;
  std::int64_t period_us = 0;
  [[nodiscard]] double processors() const {
    return static_cast<double>(quota_us) / static_cast<double>(period_us);
  }
};

/// Nothing where the group has none, `is_told` says whether that was to be read.
std::optional<Quota> quota_of(const HostTree& tree, const std::string& folder, bool& is_told) {
  if (const auto text = tree.text(folder + "/cpu.max")) {
    is_told = true;
    const auto words = words_of(*text);
    if (words.size() != 2) return std::nullopt;
    const auto quota = number_of(words[0]);
    const auto period = number_of(words[1]);
    if (!quota || period.value_or(0) <= 0) return std::nullopt;  // "max"
    return Quota{.folder = folder, .quota_us = *quota, .period_us = *period};
  }
  const auto quota = tree.number(folder + "/cpu.cfs_quota_us");
  const auto period = tree.number(folder + "/cpu.cfs_period_us");
  if (!quota) return std::nullopt;
  is_told = true;
  if (*quota < 0 || period.value_or(0) <= 0) return std::nullopt;
  return Quota{.folder = folder, .quota_us = *quota, .period_us = *period};
}

/// The folder of a group and those above it, up to where the controller is mounted.
void add_group_and_above(std::string mount, std::string group, std::vector<std::string>& folders) {
  while (group.ends_with('/')) group.pop_back();
  for (; group.starts_with('/'); group.erase(group.rfind('/'))) folders.push_back(mount + group);
  folders.push_back(std::move(mount));
}

}  // namespace

std::vector<std::string> cpu_groups(const HostTree& tree) {
  std::vector<std::string> folders;
  const auto groups = tree.text("/proc/self/cgroup");
  if (!groups) return folders;
  for (const std::string_view line : lines_of(*groups)) {
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (first == std::string_view::npos || second == std::string_view::npos) continue;
    const std::string_view controllers = line.substr(first + 1, second - first - 1);
    const std::string group(line.substr(second + 1));
    if (controllers.empty()) {
      add_group_and_above("/sys/fs/cgroup", group, folders);
    } else if (fmt::format(",{},", controllers).find(",cpu,") != std::string::npos) {
      add_group_and_above(fmt::format("/sys/fs/cgroup/{}", controllers), group, folders);
    }
  }
  return folders;
}

std::optional<Throttled> throttled_so_far(const HostTree& tree) {
  std::optional<Throttled> sum;
  for (const std::string& folder : cpu_groups(tree)) {
    const auto stat = tree.text(folder + "/cpu.stat");
    if (!stat) continue;
    for (const std::string_view line : lines_of(*stat)) {
      const auto words = words_of(line);
      const auto value = words.size() == 2 ? number_of(words[1]) : std::nullopt;
      if (!value) continue;
      if (words[0] != "nr_throttled" && words[0] != "throttled_usec" && words[0] != "throttled_time")
        continue;
      if (!sum) sum.emplace();
      if (words[0] == "nr_throttled") sum->times += *value;
      if (words[0] == "throttled_usec") sum->us += static_cast<double>(*value);
      if (words[0] == "throttled_time") sum->us += 1e-3 * static_cast<double>(*value);
    }
  }
  return sum;
}

Finding cgroup_quota(const HostTree& tree, const std::optional<Throttled>& during) {
  constexpr std::string_view name = "cgroup_quota";
  constexpr std::string_view where = "/proc/self/cgroup, /sys/fs/cgroup";
  bool is_told = false;
  std::optional<Quota> tightest;
  for (const std::string& folder : cpu_groups(tree)) {
    const auto quota = quota_of(tree, folder, is_told);
    if (quota && (!tightest || quota->processors() < tightest->processors())) tightest = quota;
  }
  if (!is_told) return unknown(name, where, "no control group of this process tells of a quota");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = "no quota of processor time",
                  .where = std::string(where),
                  .cost = {.us = std::nullopt, .why = "there is none"},
                  .mend = {}};
  if (!tightest) return finding;
  finding.state = State::costs;
  finding.where = tightest->folder;
  finding.seen = fmt::format("{} us of each {} us, {:.2f} processors", tightest->quota_us,
                             tightest->period_us, tightest->processors());
  if (during) {
    finding.seen += fmt::format("; held back {} times in the run", during->times);
    finding.cost = {
        .us = during->times > 0 ? during->us / static_cast<double>(during->times) : 0.0,
        .why =
            "measured: how long the group was held back each time, on average over the run; threads at "
            "SCHED_FIFO are not"};
  } else {
    finding.cost.why = "not measured: nobody counted how often the group was held back";
  }
  finding.mend = tree.has(tightest->folder + "/cpu.max")
                     ? fmt::format(
                           "echo max | sudo tee {}/cpu.max   # a service: systemctl set-property NAME "
                           "CPUQuota=; a container: without --cpus",
                           tightest->folder)
                     : fmt::format("echo -1 | sudo tee {}/cpu.cfs_quota_us   # a container: without --cpus",
                                   tightest->folder);
  return finding;
}

Finding cpuset(const HostTree& tree) {
  constexpr std::string_view name = "cpuset";
  constexpr std::string_view where = "/proc/self/status, /sys/devices/system/cpu/online";
  const std::string status = tree.text("/proc/self/status").value_or("");
  std::string allowed;
  for (const std::string_view line : lines_of(status)) {
    const auto words = words_of(line);
    if (words.size() == 2 && words[0] == "Cpus_allowed_list:") allowed = words[1];
  }
  if (allowed.empty()) return unknown(name, where, "which processors this process may use is not told");
  const auto online = tree.text("/sys/devices/system/cpu/online").value_or("not told");
  const bool several = allowed.find_first_of(",-") != std::string::npos;
  Finding finding{
      .name = std::string(name),
      .state = several ? State::good : State::costs,
      .seen = fmt::format("processors {} may be used; online are {}", allowed, online),
      .where = std::string(where),
      .cost = {.us = std::nullopt,
               .why = "not measured: on one processor the loop shares it with the device's thread, the "
                      "watchdog and the recorder"},
      .mend = {}};
  if (!several)
    finding.mend = online == allowed
                       ? "none here: there is one processor"
                       : fmt::format("taskset -c {} kerf ...   # or widen cpuset.cpus of its group", online);
  return finding;
}

}  // namespace kerf::bench::doctor

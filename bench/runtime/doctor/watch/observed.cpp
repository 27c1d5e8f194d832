#include "doctor/watch/observed.h"

#include <algorithm>
#include <charconv>

#include <fmt/core.h>

#include "doctor/facts/kernel.h"

namespace kerf::bench::doctor {
namespace {

constexpr std::size_t shown = 6;

double run_us(const History& history) {
  if (history.moments.size() < 2) return 0.0;
  return 1e-3 * static_cast<double>(history.moments.back().at_ns - history.moments.front().at_ns);
}

/// "longest lateness that came of it", or that none did.
Cost cost_of(const Watched& watched, WakeCause cause) {
  const auto us = longest_us(watched.explained, cause);
  return {.us = us,
          .why = us ? "measured: the longest late wake-up of the run that came of it"
                    : fmt::format("no wake-up of the run was more than {:.0f} us late because of it",
                                  watched.late_us)};
}

std::string most_of(const std::vector<Count>& counts) {
  std::string text;
  for (std::size_t at = 0; at < std::min(shown, counts.size()); ++at)
    text += fmt::format("{}{} {}", at == 0 ? "" : ", ", counts[at].name, counts[at].count);
  return text;
}

std::string most_of(const std::vector<Task>& tasks, double of_us) {
  std::string text;
  for (std::size_t at = 0; at < std::min(shown, tasks.size()); ++at)
    text += fmt::format("{}{} {:.1f} %", at == 0 ? "" : ", ", in_words(tasks[at]),
                        100.0 * tasks[at].run_us / of_us);
  return text.empty() ? "nobody" : text;
}

/// A process, and how many late wake-ups it was found to have made.
struct Blamed {
  std::int64_t pid = 0;
  std::string name;
  std::size_t times = 0;
};
/// The most often first.
std::vector<Blamed> blamed_processes(const std::vector<ExplainedWake>& wakes) {
  std::vector<Blamed> all;
  for (const ExplainedWake& one : wakes) {
    if (one.cause != WakeCause::process) continue;
    const auto same = std::ranges::find(all, one.pid, &Blamed::pid);
    if (same == all.end()) {
      all.push_back({.pid = one.pid, .name = one.by, .times = 1});
    } else {
      ++same->times;
    }
  }
  std::ranges::stable_sort(all, std::ranges::greater{}, &Blamed::times);
  return all;
}

std::string most_of(const std::vector<Blamed>& all) {
  std::string text;
  for (std::size_t at = 0; at < std::min(shown, all.size()); ++at)
    text += fmt::format("{} made {} wake-ups late, ", all[at].name, all[at].times);
  if (text.empty()) return text;
  text.resize(text.size() - 2);
  return text + "; ";
}

}  // namespace

std::optional<double> longest_us(std::span<const ExplainedWake> wakes, WakeCause cause) {
  std::optional<double> longest;
  for (const ExplainedWake& one : wakes) {
    if (one.cause == cause)
      longest = std::max(longest.value_or(0.0), 1e-3 * static_cast<double>(one.wake.late_ns()));
  }
  return longest;
}

Finding other_processes(const HostTree& tree, const Watched& watched) {
  constexpr std::string_view name = "other_processes";
  constexpr double much = 0.1;  // of the loop's processor
  const History& history = watched.history;
  const double time_us = run_us(history);
  const auto blamed = blamed_processes(watched.explained);
  if (time_us <= 0.0 || history.tasks.empty())
    return unknown(name, "/proc/*/task/*/schedstat", "no threads of others are shown here");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = fmt::format("{}on the loop's processor {}: {}; on all of them: {}", most_of(blamed),
                                      watched.processor, most_of(history.ran_beside, time_us),
                                      most_of(history.ran_anywhere, time_us)),
                  .where = "/proc/*/task/*/stat and schedstat",
                  .cost = cost_of(watched, WakeCause::process),
                  .mend = {}};
  const bool takes_much = !history.ran_beside.empty() && history.ran_beside.front().run_us >= much * time_us;
  if (!finding.cost.us && !takes_much) return finding;
  finding.state = State::costs;
  const std::int64_t pid = blamed.empty() ? history.ran_beside.front().pid : blamed.front().pid;
  finding.mend = fmt::format("ps -fp {0}   # then end it, or keep it off: taskset -acp {1} {0}", pid,
                             processors_but(tree, watched.processor));
  return finding;
}

Finding interrupts(const HostTree& tree, const Watched& watched) {
  constexpr std::string_view name = "interrupts";
  constexpr double many_per_s = 1000.0;
  const History& history = watched.history;
  const double time_us = run_us(history);
  if (time_us <= 0.0 || history.moments.back().interrupts.empty())
    return unknown(name, "/proc/interrupts", "nobody tells of the loop's processor");
  auto grown = growth(history.moments.front().interrupts, history.moments.back().interrupts);
  std::erase_if(grown, is_timer);
  std::uint64_t all = 0;
  for (const Count& one : grown) all += one.count;
  const double per_s = 1e6 * static_cast<double>(all) / time_us;
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = fmt::format("{:.0f} a second on processor {} beside its timer's{}", per_s,
                                      watched.processor, grown.empty() ? "" : ": " + most_of(grown)),
                  .where = "/proc/interrupts",
                  .cost = cost_of(watched, WakeCause::interrupts),
                  .mend = {}};
  if (!finding.cost.us && per_s < many_per_s) return finding;
  finding.state = State::costs;
  const auto of_device = std::ranges::find_if(
      grown, [](const Count& one) { return number_of(words_of(one.name).front()).has_value(); });
  finding.mend =
      of_device == grown.end()
          ? "none here: they are no device's that could be sent to another processor"
          : fmt::format("echo {} | sudo tee /proc/irq/{}/smp_affinity_list",
                        processors_but(tree, watched.processor), words_of(of_device->name).front());
  return finding;
}

Finding irq_balance(const HostTree& tree, int processor) {
  constexpr std::string_view name = "irq_balance";
  constexpr std::string_view where = "/proc/*/comm, /etc/default/irqbalance";
  const auto running = runs(tree, "irqbalance");
  if (!running) return unknown(name, where, "which programs run is not told");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = *running ? "irqbalance runs" : "irqbalance does not run",
                  .where = std::string(where),
                  .cost = {.us = std::nullopt, .why = "what interrupts cost is measured at interrupts"},
                  .mend = {}};
  if (!*running) return finding;
  if (is_in_list(tree.text("/sys/devices/system/cpu/isolated").value_or(""), processor)) {
    finding.seen += " and leaves isolated processors alone";
    return finding;
  }
  const auto settings = tree.text("/etc/default/irqbalance").value_or("");
  for (const std::string_view line : lines_of(settings)) {
    constexpr std::string_view banned = "IRQBALANCE_BANNED_CPULIST=";
    if (!line.starts_with(banned)) continue;
    std::string list(line.substr(banned.size()));
    std::erase(list, '"');
    if (!is_in_list(list, processor)) continue;
    finding.seen += fmt::format(" and is kept off processor {}", processor);
    return finding;
  }
  finding.state = State::costs;
  finding.seen += fmt::format(" and may send interrupts to processor {}", processor);
  finding.mend = fmt::format(
      "echo IRQBALANCE_BANNED_CPULIST={} | sudo tee -a /etc/default/irqbalance && sudo "
      "systemctl restart irqbalance",
      processor);
  return finding;
}

Finding softirqs(const Watched& watched) {
  constexpr std::string_view name = "softirqs";
  constexpr double much = 0.01;
  const History& history = watched.history;
  if (history.moments.size() < 2 || !history.moments.front().times || !history.moments.back().times)
    return unknown(name, "/proc/softirqs, /proc/stat", "nobody tells of the loop's processor");
  const ProcessorTimes& before = *history.moments.front().times;
  const ProcessorTimes& after = *history.moments.back().times;
  const double total_us = after.total_us - before.total_us;
  const double share = total_us > 0.0 ? (after.softirq_us - before.softirq_us) / total_us : 0.0;
  Finding finding{.name = std::string(name),
                  .state = share >= much ? State::costs : State::good,
                  .seen = fmt::format("{:.1f} % of processor {}{}", 100.0 * share, watched.processor,
                                      history.softirqs.empty() ? "" : ": " + most_of(history.softirqs)),
                  .where = "/proc/softirqs, /proc/stat",
                  .cost = {.us = std::nullopt, .why = "not measured apart: it is in what interrupts cost"},
                  .mend = {}};
  if (finding.state == State::costs)
    finding.mend = "send the interrupts that they follow elsewhere: see interrupts";
  return finding;
}

Finding steal_time(const HostTree& tree, const Watched& watched) {
  constexpr std::string_view name = "steal_time";
  const History& history = watched.history;
  if (history.moments.size() < 2 || !history.moments.front().times || !history.moments.back().times)
    return unknown(name, "/proc/stat", "nobody tells of the loop's processor");
  const double before_us = history.moments.front().times->steal_us;
  const double after_us = history.moments.back().times->steal_us;
  Finding finding{.name = std::string(name),
                  .state = after_us > before_us ? State::costs : State::good,
                  .seen = fmt::format("a hypervisor took {:.0f} us of {:.0f} us from processor {}",
                                      after_us - before_us, run_us(history), watched.processor),
                  .where = "/proc/stat",
                  .cost = cost_of(watched, WakeCause::steal),
                  .mend = {}};
  if (finding.state == State::costs)
    finding.mend = "on the host: give this machine's processors to nobody else (virsh vcpupin, CPU shares)";
  if (after_us == 0.0 && virtual_machine(tree, std::nullopt).state != State::good) {
    finding.state = State::unknown;
    finding.seen = "the hypervisor has told of none since the start, and may tell of none ever";
  }
  return finding;
}

Finding standstill(const Watched& watched) {
  constexpr std::string_view name = "standstill";
  constexpr std::string_view where = "a thread that sleeps on another processor";
  if (usable_processors() < 2)
    return unknown(name, where, "there is no other processor that could have stood still as well");
  const auto times = std::ranges::count(watched.explained, WakeCause::stood_still, &ExplainedWake::cause);
  Finding finding{.name = std::string(name),
                  .state = times > 0 ? State::costs : State::good,
                  .seen = fmt::format("{} times another processor stood still at the same time", times),
                  .where = std::string(where),
                  .cost = cost_of(watched, WakeCause::stood_still),
                  .mend = {}};
  if (times > 0)
    finding.mend =
        "sudo hwlatdetect --duration=60   # of rt-tests: firmware (SMI) shows there; turn off what the "
        "firmware's set-up offers of power and hardware monitoring; a virtual machine: its host";
  return finding;
}

Finding page_faults(const Watched& watched) {
  const auto faults = watched.usage.page_faults + watched.usage.major_page_faults;
  Finding finding{.name = "page_faults",
                  .state = watched.usage.major_page_faults > 0 ? State::costs : State::good,
                  .seen = fmt::format("{} of the loop's own, {} of them from a disk", faults,
                                      watched.usage.major_page_faults),
                  .where = "getrusage(RUSAGE_THREAD)",
                  .cost = cost_of(watched, WakeCause::page_fault),
                  .mend = {}};
  if (finding.state == State::costs) finding.mend = "permit memory to be locked: see memory_lock";
  return finding;
}

Finding load(const HostTree& tree) {
  constexpr std::string_view name = "load";
  const std::string path = "/proc/loadavg";
  const std::string text = tree.text(path).value_or("");
  const auto words = words_of(text);
  double mean = -1.0;
  if (!words.empty()) std::from_chars(words[0].data(), words[0].data() + words[0].size(), mean);
  if (mean < 0.0) return unknown(name, path, "how many threads want to run is not told");
  const auto processors = static_cast<double>(usable_processors());
  Finding finding{.name = std::string(name),
                  .state = mean > processors ? State::costs : State::good,
                  .seen = fmt::format("{:.2f} threads wanted to run in the last minute, on {:.0f} processors",
                                      mean, processors),
                  .where = path,
                  .cost = {.us = std::nullopt, .why = "what it costs is measured at other_processes"},
                  .mend = {}};
  if (finding.state == State::costs) finding.mend = "top   # and end what is not needed";
  return finding;
}

}  // namespace kerf::bench::doctor

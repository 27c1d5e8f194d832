#include "doctor/facts/kernel.h"

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/core.h>
#include <zlib.h>

namespace kerf::bench::doctor {
namespace {

bool contains(std::string_view text, std::string_view word) {
  return text.find(word) != std::string_view::npos;
}

/// The words after "flags" of the first processor; nothing where none are told, as on ARM.
std::optional<std::string> processor_flags(const HostTree& tree) {
  const auto cpuinfo = tree.text("/proc/cpuinfo");
  if (!cpuinfo) return std::nullopt;
  for (const std::string_view line : lines_of(*cpuinfo)) {
    if (line.starts_with("flags")) return " " + std::string(line.substr(line.find(':') + 1)) + " ";
  }
  return std::nullopt;
}

/// What calls itself a virtual machine, by the words that makers of them write into the firmware's tables.
std::optional<std::string> virtual_product(const HostTree& tree) {
  constexpr std::array<std::string_view, 11> makers{
      "QEMU",  "KVM",       "VMware",     "VirtualBox",     "innotek",        "Xen",
      "Bochs", "Parallels", "Amazon EC2", "Google Compute", "Virtual Machine"};
  for (const char* const file : {"/sys/class/dmi/id/sys_vendor", "/sys/class/dmi/id/product_name"}) {
    const auto text = tree.text(file);
    if (text && std::ranges::any_of(makers, [&](std::string_view maker) { return contains(*text, maker); }))
      return fmt::format("{} says '{}'", file, *text);
  }
  if (const auto type = tree.text("/sys/hypervisor/type"))
    return fmt::format("/sys/hypervisor/type says '{}'", *type);
  return std::nullopt;
}

/// The option of a command line: "2-3" of "isolcpus=2-3"; empty if it is not given.
std::string boot_option(std::string_view command_line, std::string_view name) {
  for (const std::string_view word : words_of(command_line)) {
    if (word.starts_with(name) && word.substr(name.size()).starts_with('='))
      return std::string(word.substr(name.size() + 1));
  }
  return "";
}

std::optional<std::string> unpacked(const std::filesystem::path& file) {
  struct Close {
    void operator()(gzFile_s* opened) const { gzclose(opened); }
  };
  const std::unique_ptr<gzFile_s, Close> opened(gzopen(file.c_str(), "re"));
  if (!opened) return std::nullopt;
  std::string text;
  std::array<char, 16384> part{};
  for (int count = 0; (count = gzread(opened.get(), part.data(), part.size())) != 0;) {
    if (count < 0) return std::nullopt;
    text.append(part.data(), static_cast<std::size_t>(count));
  }
  return text;
}

}  // namespace

Finding clock_source(const HostTree& tree, const MachineTrials& trials) {
  constexpr std::string_view name = "clock_source";
  const std::string folder = "/sys/devices/system/clocksource/clocksource0";
  const std::string path = folder + "/current_clocksource";
  const auto source = tree.text(path);
  if (!source) return unknown(name, path, "what the time is read from is not told");
  Finding finding{
      .name = std::string(name),
      .state = State::good,
      .seen = fmt::format("'{}'", *source),
      .where = path,
      .cost = {.us = trials.clock_read_us, .why = "measured: one reading of the clock, at the median"},
      .mend = {}};
  constexpr std::array<std::string_view, 4> slow{"hpet", "acpi_pm", "jiffies", "refined-jiffies"};
  constexpr double slow_us = 0.5;  // a tick reads it some ten times
  const bool is_slow = std::ranges::count(slow, std::string_view(*source)) > 0;
  if (!is_slow && trials.clock_read_us < slow_us) return finding;
  finding.state = State::costs;
  if (is_slow) finding.seen += ", which every reading has to ask a chip for";
  const auto offered = tree.text(folder + "/available_clocksource");
  finding.mend =
      offered && std::ranges::count(words_of(*offered), "tsc") > 0
          ? fmt::format("echo tsc | sudo tee {}", path)
          : "start the kernel with tsc=reliable, where the processor's counters agree (dmesg | grep -i tsc "
            "says why it does not trust them)";
  return finding;
}

Finding virtual_machine(const HostTree& tree, std::optional<double> unexplained_us) {
  constexpr std::string_view name = "virtual_machine";
  const auto flags = processor_flags(tree);
  const auto product = virtual_product(tree);
  if (!flags && !product && !tree.has("/sys/class/dmi/id"))
    return unknown(name, "/proc/cpuinfo, /sys/class/dmi/id", "neither processor nor firmware tells");
  const bool has_flag = flags && contains(*flags, " hypervisor ");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = "no sign of a hypervisor",
                  .where = "/proc/cpuinfo, /sys/class/dmi/id, /sys/hypervisor",
                  .cost = {.us = std::nullopt, .why = "there is none"},
                  .mend = {}};
  if (!has_flag && !product) return finding;
  finding.state = State::costs;
  finding.seen = "a hypervisor is below: ";
  finding.seen += has_flag ? "the processor has the flag 'hypervisor'" : "";
  if (product) finding.seen += (has_flag ? "; " : "") + *product;
  finding.cost = {.us = unexplained_us,
                  .why = unexplained_us
                             ? "measured: the longest late wake-up of the run for which nothing in this "
                               "machine was seen"
                             : "no late wake-up of the run was without a cause within this machine"};
  finding.mend =
      "run Kerf on the machine itself; else, on the host, pin each virtual processor to one of its own "
      "(virsh "
      "vcpupin) and give it real-time priority";
  return finding;
}

std::optional<std::string> kernel_option(const HostTree& tree, const std::string& name) {
  const auto release = tree.text("/proc/sys/kernel/osrelease");
  std::optional<std::string> text;
  if (release) text = tree.text("/boot/config-" + *release);
  if (!text) text = unpacked(tree.file("/proc/config.gz"));
  if (!text) return std::nullopt;
  for (const std::string_view line : lines_of(*text)) {
    if (line.starts_with(name + "=")) return std::string(line.substr(name.size() + 1));
  }
  return "n";
}

Finding preemption(const HostTree& tree) {
  constexpr std::string_view name = "preemption";
  const auto version = tree.text("/proc/version").value_or("");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = "PREEMPT_RT",
                  .where = "/sys/kernel/realtime, /proc/version, the kernel's configuration",
                  .cost = {.us = std::nullopt, .why = "not measured: that needs another kernel"},
                  .mend = {}};
  if (tree.number("/sys/kernel/realtime").value_or(0) == 1 || contains(version, "PREEMPT_RT")) return finding;
  finding.state = State::costs;
  finding.mend = "sudo apt install linux-image-rt-amd64   # a kernel with PREEMPT_RT; then start it";
  const auto chosen = [&](const char* option) { return kernel_option(tree, option) == "y"; };
  if (contains(version, "PREEMPT_DYNAMIC")) {
    finding.seen = "PREEMPT_DYNAMIC, no PREEMPT_RT";
    if (chosen("CONFIG_PREEMPT_NONE")) finding.seen += "; 'none' unless preempt= was given at the start";
    if (chosen("CONFIG_PREEMPT_VOLUNTARY"))
      finding.seen += "; 'voluntary' unless preempt= was given at the start";
  } else if (contains(version, "PREEMPT") || chosen("CONFIG_PREEMPT")) {
    finding.seen = "PREEMPT, no PREEMPT_RT";
  } else if (chosen("CONFIG_PREEMPT_VOLUNTARY")) {
    finding.seen = "PREEMPT_VOLUNTARY: the kernel finishes what it does for others before it wakes the loop";
  } else if (chosen("CONFIG_PREEMPT_NONE")) {
    finding.seen = "PREEMPT_NONE: the kernel finishes what it does for others before it wakes the loop";
  } else {
    return unknown(name, finding.where, "the kernel does not tell how it can be interrupted");
  }
  return finding;
}

Finding isolated_processor(const HostTree& tree, int processor) {
  constexpr std::string_view name = "isolated_processor";
  constexpr std::string_view path = "/proc/cmdline";
  const auto command_line = tree.text(path);
  const auto isolated = tree.text("/sys/devices/system/cpu/isolated");
  if (!command_line || !isolated) return unknown(name, path, "how the kernel was started is not told");
  Finding finding{.name = std::string(name),
                  .state = State::good,
                  .seen = {},
                  .where = "/proc/cmdline, /sys/devices/system/cpu/isolated",
                  .cost = {.us = std::nullopt,
                           .why = "what others cost is measured at other_processes, interrupts and softirqs"},
                  .mend = {}};
  for (const char* const option : {"isolcpus", "nohz_full", "rcu_nocbs", "irqaffinity"}) {
    const std::string value = boot_option(*command_line, option);
    finding.seen +=
        fmt::format("{}{}={}", finding.seen.empty() ? "" : " ", option, value.empty() ? "-" : value);
  }
  if (is_in_list(*isolated, processor)) {
    finding.seen += fmt::format("; the loop's processor {} is kept for it", processor);
    return finding;
  }
  finding.state = State::costs;
  if (!isolated->empty()) {
    finding.seen += fmt::format("; the loop runs on {}, the isolated ones are {}", processor, *isolated);
    finding.mend = fmt::format(
        "taskset -c 0,{} kerf ...   # a process does not get an isolated processor by itself", *isolated);
    return finding;
  }
  finding.seen += fmt::format("; the loop shares processor {} with whoever comes", processor);
  const std::string others = processors_but(tree, processor);
  finding.mend = processor > 0 ? fmt::format(
                                     "start the kernel with isolcpus={0} nohz_full={0} rcu_nocbs={0} "
                                     "irqaffinity={1}, and Kerf with taskset -c {1},{0}",
                                     processor, others)
                               : "none here: there is one processor";
  return finding;
}

Finding huge_pages(const HostTree& tree) {
  constexpr std::string_view name = "huge_pages";
  const std::string path = "/sys/kernel/mm/transparent_hugepage/enabled";
  const auto enabled = tree.text(path);
  if (!enabled) return unknown(name, path, "the kernel tells of no transparent huge pages");
  const bool always = contains(*enabled, "[always]");
  Finding finding{
      .name = std::string(name),
      .state = always ? State::costs : State::good,
      .seen = *enabled,
      .where = path,
      .cost = {.us = std::nullopt,
               .why = "not measured: who faults a page in may wait for memory to be tidied; the loop, "
                      "whose memory is locked, faults in none"},
      .mend = {}};
  if (always) finding.mend = "echo madvise | sudo tee " + path;
  return finding;
}

Finding swap(const HostTree& tree, bool is_locked) {
  constexpr std::string_view name = "swap";
  constexpr std::string_view path = "/proc/swaps";
  const auto swaps = tree.text(path);
  if (!swaps) return unknown(name, path, "whether memory goes to a disk is not told");
  const bool none = lines_of(*swaps).size() < 2;
  Finding finding{
      .name = std::string(name),
      .state = none || is_locked ? State::good : State::costs,
      .seen = none ? "memory goes to no disk" : "memory may go to a disk",
      .where = std::string(path),
      .cost = {.us = std::nullopt, .why = "not measured: a page that has to come back takes milliseconds"},
      .mend = {}};
  if (!none && is_locked) finding.seen += "; the loop's is locked";
  if (finding.state == State::costs)
    finding.mend = "sudo swapoff -a   # or permit memory to be locked: memory_lock";
  return finding;
}

Finding memory_left(const HostTree& tree) {
  constexpr std::string_view name = "memory_left";
  constexpr std::string_view path = "/proc/meminfo";
  constexpr double least_share = 0.05;
  const std::string text = tree.text(path).value_or("");
  const auto kilobytes = [&](std::string_view what) -> std::optional<double> {
    for (const std::string_view line : lines_of(text)) {
      const auto words = words_of(line);
      const auto value = words.size() > 1 && words[0] == what ? number_of(words[1]) : std::nullopt;
      if (value) return static_cast<double>(*value);
    }
    return std::nullopt;
  };
  const auto total = kilobytes("MemTotal:");
  const auto left = kilobytes("MemAvailable:");
  if (!total || !left) return unknown(name, path, "how much memory is left is not told");
  const bool is_short = *left < least_share * *total;
  const auto overcommit = tree.number("/proc/sys/vm/overcommit_memory");
  Finding finding{
      .name = std::string(name),
      .state = is_short ? State::costs : State::good,
      .seen = fmt::format("{:.0f} of {:.0f} MB, overcommit_memory {}", *left / 1024.0, *total / 1024.0,
                          overcommit ? fmt::format("{}", *overcommit) : "not told"),
      .where = "/proc/meminfo, /proc/sys/vm/overcommit_memory",
      .cost = {.us = std::nullopt,
               .why = "not measured: whoever asks for memory waits until some is found, and where it was "
                      "promised twice a process is ended"},
      .mend = {}};
  if (is_short) finding.mend = "ps --sort=-rss -eo pid,rss,comm | head   # and end what is not needed";
  return finding;
}

}  // namespace kerf::bench::doctor

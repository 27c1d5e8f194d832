#include "doctor/doctor.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "doctor/facts/cgroups.h"
#include "doctor/facts/kernel.h"
#include "doctor/facts/processors.h"
#include "doctor/facts/rights.h"
#include "doctor/facts/usb.h"
#include "doctor/watch/observed.h"
#include "host/no_device.h"

namespace kerf::bench::doctor {
namespace {

/// What the group was refused between the first and the last look.
std::optional<Throttled> throttled_during(const History& history) {
  if (history.moments.empty()) return std::nullopt;
  const auto& before = history.moments.front().throttled;
  const auto& after = history.moments.back().throttled;
  if (!before || !after) return std::nullopt;
  return Throttled{.times = after->times - before->times, .us = after->us - before->us};
}

void add_usb(const HostTree& tree, const std::string& uri, std::vector<Finding>& findings) {
  bool any = false;
  for (const drivers::AttachedDevice& device : drivers::list_attached()) {
    if (!uri.empty() && device.uri != uri.substr(0, uri.find('?'))) continue;
    any = true;
    const auto path = usb_path(tree, device.node);
    findings.push_back(usb_autosuspend(tree, path, device.uri));
    findings.push_back(usb_speed(tree, path, device.uri));
    findings.push_back(usb_shared_hub(tree, path, device.uri));
  }
  if (!any && !uri.starts_with("sim:"))
    findings.push_back(
        unknown("usb", "libusb", "no device that Kerf knows is on the USB: its way there was not seen"));
}

}  // namespace

std::vector<Finding> findings_of(const HostTree& tree, const MachineTrials& trials, const Watched& watched,
                                 std::optional<std::int64_t> throttle_count_before, const std::string& uri) {
  const int processor = watched.processor;
  const double busy = watched.history.busiest_sibling;
  const Finding memory = memory_lock(tree);
  auto unseen_us = longest_us(watched.explained, WakeCause::unknown);
  for (const WakeCause cause : {WakeCause::steal, WakeCause::stood_still}) {
    if (const auto us = longest_us(watched.explained, cause))
      unseen_us = std::max(unseen_us.value_or(0.0), *us);
  }
  std::vector<Finding> findings{
      realtime_scheduling(tree, trials),
      memory,
      frequency_governor(tree, processor, trials),
      idle_states(tree, processor, trials),
      smt_siblings(tree, processor, busy < 0.0 ? std::nullopt : std::optional(busy)),
      thermal_throttling(throttle_count_before, thermal_throttle_count(tree)),
      timer_slack(trials),
      realtime_throttling(tree, watched.cpu_share),
      cgroup_quota(tree, throttled_during(watched.history)),
      cpuset(tree),
      clock_source(tree, trials),
      virtual_machine(tree, unseen_us),
      preemption(tree),
      isolated_processor(tree, processor),
      huge_pages(tree),
      swap(tree, memory.state == State::good),
      memory_left(tree),
      other_processes(tree, watched),
      interrupts(tree, watched),
      irq_balance(tree, processor),
      softirqs(watched),
      steal_time(tree, watched),
      standstill(watched),
      page_faults(watched),
      load(tree),
      modem_manager(tree),
  };
  add_usb(tree, uri, findings);
  sort_by_cost(findings);
  return findings;
}

Diagnosis examine(const DoctorOptions& options, const std::atomic<bool>& stop) {
  Diagnosis diagnosis;
  std::unique_ptr<drivers::Device> device;
  if (!options.uri.empty()) {
    drivers::Surroundings surroundings;
    surroundings.stop = &stop;
    device = drivers::open_device(options.uri, std::move(surroundings));
  }
  diagnosis.trials = run_trials();
  const auto run = [&](const std::string& label, const WatchOptions& watch_options, const auto& work) {
    options.progress(label, static_cast<std::size_t>(watch_options.seconds * watch_options.rate_hz), work);
  };
  if (device) {
    constexpr double most_s = 10.0;
    WatchOptions of_device = options.watch;
    of_device.seconds = std::min(of_device.seconds, most_s);
    run("timing " + options.uri, of_device, [&](std::atomic<std::size_t>& done) {
      diagnosis.device.emplace(time_device(options.tree, *device, of_device, stop, done));
    });
    device.reset();  // whose thread is not to be heard in the empty loop
  }
  const auto throttle_count = thermal_throttle_count(options.tree);
  run("an empty loop", options.watch, [&](std::atomic<std::size_t>& done) {
    NoDevice nothing;
    diagnosis.watched = watch(options.tree, nothing, options.watch, stop, done);
  });
  diagnosis.judgement = judge(diagnosis.watched);
  diagnosis.findings =
      findings_of(options.tree, diagnosis.trials, diagnosis.watched, throttle_count, options.uri);
  return diagnosis;
}

}  // namespace kerf::bench::doctor

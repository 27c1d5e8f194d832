#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <thread>

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sched.h>
#include <semaphore.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "host/host_floor.h"
#include "host/realtime.h"
#include "loop/clock.h"
#include "loop/loop.h"

// Injects known causes of missed deadlines into a loop by the wall clock, each in every fiftieth tick, and
// counts which cause is named for the ticks in which that happened. Prints JSON.

namespace kerf::bench {
namespace {

constexpr std::uint64_t ticks = 2000;
constexpr std::int64_t late_ns = 2'600'000;

[[nodiscard]] bool is_injected(std::uint64_t tick) { return tick % 50 == 25; }

void burn_processor(std::int64_t ns) {
  const std::int64_t until = WallClock::cpu_ns() + ns;
  while (WallClock::cpu_ns() < until) {
  }
}
void spin_until(std::int64_t ns) {
  while (WallClock::now_ns() < ns) {
  }
}
void sleep_ns(std::int64_t ns) {
  const timespec wait{.tv_sec = 0, .tv_nsec = ns};
  nanosleep(&wait, nullptr);
}

/// A thread on the loop's processor that is more urgent than the loop, and takes the processor when asked to.
class Bully {
 public:
  Bully() {
    sem_init(&asked_, 0, 0);
    thread_ = std::jthread([this](const std::stop_token& stop) {
      (void)pin_to_processor();
      const sched_param above{.sched_priority = drivers::priorities().urgent};
      (void)sched_setscheduler(0, SCHED_FIFO, &above);
      while (sem_wait(&asked_) == 0 && !stop.stop_requested()) {
        const std::int64_t from_ns = WallClock::now_ns() + delay_ns_;
        sleep_ns(std::max<std::int64_t>(1, delay_ns_));
        spin_until(from_ns + late_ns);
      }
    });
  }
  Bully(const Bully&) = delete;
  Bully& operator=(const Bully&) = delete;
  ~Bully() {
    thread_.request_stop();
    sem_post(&asked_);
  }
  /// Takes the processor `delay_ns` from now.
  void ask(std::int64_t delay_ns) {
    delay_ns_ = delay_ns;
    sem_post(&asked_);
  }
  /// Is made to wait by it.
  void meet() {
    const std::int64_t until_ns = WallClock::now_ns() + late_ns;
    ask(0);
    spin_until(until_ns);
  }

 private:
  sem_t asked_{};
  std::atomic<std::int64_t> delay_ns_{0};
  std::jthread thread_;
};

/// A process that stops this one for 15 ms.
class Stopper {
 public:
  Stopper() {
    if (pipe(pipe_) != 0) std::abort();
    child_ = fork();
    if (child_ != 0) return;
    close(pipe_[1]);
    stay_off_loop_processor();
    for (char byte = 0; read(pipe_[0], &byte, 1) == 1;) {
      kill(getppid(), SIGSTOP);
      sleep_ns(15'000'000);
      kill(getppid(), SIGCONT);
    }
    _exit(0);
  }
  Stopper(const Stopper&) = delete;
  Stopper& operator=(const Stopper&) = delete;
  ~Stopper() {
    close(pipe_[1]);
    waitpid(child_, nullptr, 0);
  }
  void stop_process() {
    const std::int64_t from_ns = WallClock::now_ns();
    const char byte = 0;
    (void)!write(pipe_[1], &byte, 1);
    for (std::int64_t last = from_ns, now = last; now - last < 5'000'000 && now - from_ns < 500'000'000;) {
      last = now;
      now = WallClock::now_ns();
    }
  }

 private:
  int pipe_[2]{};
  pid_t child_ = 0;
};

struct Injection {
  const char* name;
  Cause cause;
  std::function<void(std::uint64_t tick)> read, compute, write, record;
};

class InjectedDevice final : public drivers::Device {
 public:
  explicit InjectedDevice(const Injection& injection) : injection_(injection) {
    info_.axes = {
        {.name = "x", .position_unit = "m", .force_unit = "N", .force_limit = 1.0, .slew_limit = 1e3}};
  }
  [[nodiscard]] const drivers::DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] drivers::Status read(double now_s, drivers::Sample&) noexcept override {
    tick_ = static_cast<std::uint64_t>(std::llround(1e3 * now_s));
    has_read_ = true;
    if (injection_.read) injection_.read(tick_);
    return drivers::Status::ok;
  }
  [[nodiscard]] drivers::Status write(const drivers::Axes&) noexcept override {
    if (std::exchange(has_read_, false) && injection_.write) injection_.write(tick_);
    return drivers::Status::ok;
  }
  void release(double) noexcept override {}
  [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }

 private:
  const Injection& injection_;
  drivers::DeviceInfo info_;
  std::uint64_t tick_ = 0;
  bool has_read_ = false;
};

nlohmann::ordered_json inject(const Injection& injection, std::int64_t spin_ns) {
  LoopReport report;
  Heartbeat heartbeat;
  InjectedDevice device(injection);
  const Watchdog watchdog(device, heartbeat, 1e-3);
  std::jthread([&] {
    (void)use_realtime_scheduling();
    (void)pin_to_processor();
    WallClock clock(spin_ns);
    auto rendering = [&](const drivers::Sample&, double elapsed_s) noexcept {
      if (injection.compute) injection.compute(device.tick());
      (void)elapsed_s;
      return Command{};
    };
    struct Record {
      const Injection& injection;
      void push(const schema::Row& row) noexcept {
        if (injection.record) injection.record(row.tick);
      }
    } record{injection};
    const std::atomic<bool> stop{false};
    std::atomic<std::size_t> done{0};
    run_loop(clock, device, rendering, record, {.ticks = ticks, .safety = {}},
             {.stop = stop, .done = done, .heartbeat = heartbeat}, report);
  }).join();
  int injected = 0;
  int right = 0;
  int law = 0;
  nlohmann::ordered_json wrong = nlohmann::ordered_json::array();
  for (const Miss& miss : report.first_misses()) {
    // What happens between two ticks makes the next one late.
    if (!is_injected(miss.tick) &&
        !(miss.stage == Stage::wake && is_injected(miss.tick - miss.deadlines - 1)))
      continue;
    ++injected;
    right += miss.cause == injection.cause ? 1 : 0;
    law += miss.cause == Cause::law ? 1 : 0;
    if (miss.cause != injection.cause) wrong.push_back(in_words(miss));
  }
  return {{"injected", injection.name}, {"cause", cause_names[static_cast<std::size_t>(injection.cause)]},
          {"late_ticks", injected},     {"named_right", right},
          {"blamed_on_the_law", law},   {"wrong", wrong}};
}

}  // namespace

int benchmark() {
  Stopper stopper;  // before there are threads
  Bully bully;
  const std::int64_t spin_ns = learn_spin_ns(1'000'000);
  const auto at = [](std::function<void()> action) {
    return [action = std::move(action)](std::uint64_t tick) {
      if (is_injected(tick)) action();
    };
  };
  const auto preempted = at([&] { bully.meet(); });
  const auto late = at([] { sleep_ns(late_ns); });
  const std::vector<Injection> all{
      {.name = "law slow in a tick", .cause = Cause::law, .compute = at([] { burn_processor(late_ns); })},
      {.name = "law that waits of itself", .cause = Cause::law, .compute = late},
      {.name = "preempted in read", .cause = Cause::machine, .read = preempted},
      {.name = "preempted in compute", .cause = Cause::machine, .compute = preempted},
      {.name = "preempted in write", .cause = Cause::machine, .write = preempted},
      {.name = "preempted in record", .cause = Cause::machine, .record = preempted},
      {.name = "preempted between ticks", .cause = Cause::machine, .record = at([&] { bully.ask(300'000); })},
      {.name = "device that answers late", .cause = Cause::device, .read = late},
      {.name = "device that takes orders late", .cause = Cause::device, .write = late},
      {.name = "driver that computes", .cause = Cause::device, .read = at([] { burn_processor(late_ns); })},
      {.name = "process stopped in read", .cause = Cause::machine, .read = at([&] {
                                                                     stopper.stop_process();
                                                                   })},
      {.name = "process stopped in compute", .cause = Cause::machine, .compute = at([&] {
                                                                        stopper.stop_process();
                                                                      })},
      {.name = "process stopped in write", .cause = Cause::machine, .write = at([&] {
                                                                      stopper.stop_process();
                                                                    })},
  };
  auto results = nlohmann::ordered_json::array();
  for (const Injection& injection : all) results.push_back(inject(injection, spin_ns));
  fmt::print("{}\n", results.dump(1));
  return 0;
}

}  // namespace kerf::bench

int main() {
  try {
    return kerf::bench::benchmark();
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
  }
}

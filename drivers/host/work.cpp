#include "work.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <stop_token>
#include <thread>

#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "age_limits.h"
#include "kerf/drivers/urgent_thread.h"

namespace kerf::host {

using namespace drivers::hosted;

std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

bool program_is_gone() noexcept {
  char nothing = 0;
  const auto got = recv(host_to_program, &nothing, 1, MSG_PEEK | MSG_DONTWAIT);
  return got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

namespace {

constexpr std::int64_t look_ns = 5'000'000;  // after the program
constexpr std::int64_t at_once_ns = 50'000;  // a read() that took less has waited for nothing
constexpr std::int64_t breath_ns = 200'000;  // after one that waited for nothing, and had nothing
constexpr int command_wait_ms = 5;

void sleep_until(std::int64_t at_ns) noexcept {
  const timespec until{.tv_sec = at_ns / 1'000'000'000, .tv_nsec = at_ns % 1'000'000'000};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

/// How far a count went that begins again at 0 after `modulus`: as little as it can, forwards or back.
std::int64_t count_step(std::uint64_t from, std::uint64_t to, std::uint64_t modulus) noexcept {
  if (modulus == 0) return static_cast<std::int64_t>(to - from);
  const std::uint64_t forward = (to % modulus + modulus - from % modulus) % modulus;
  if (forward <= modulus / 2) return static_cast<std::int64_t>(forward);
  return -static_cast<std::int64_t>(modulus - forward);
}

/// Hands forces over. One thread's.
class Hands {
 public:
  Hands(const Opened& opened, Page& page, Whereabouts& thread)
      : opened_(opened), page_(page), thread_(thread) {}

  /// Hands over the newest command, once; lets go where there is none that still counts.
  void act() {
    if (opened_.description.write == nullptr) return;
    Command command;
    const std::uint64_t number = page_.commands.count();
    const bool is_there = page_.commands.get(number, command);
    const std::int64_t now = now_ns();
    if (number != 0 && !is_there) return;  // another one is just being given: the next time
    const bool counts = is_there && page_.unguarded.load(std::memory_order_acquire) == 0 &&
                        command.at_ns > page_.let_go_ns.load(std::memory_order_acquire) &&
                        now - command.at_ns <= drivers::max_command_age_ns;
    if (!counts) {
      if (held_) let_go();
      return;
    }
    const bool is_force = std::ranges::any_of(command.force, [](double one) { return one != 0.0; });
    if (number != written_) {
      // Before it is on its way: it is held from then on.
      if (is_force) hold(now, command.at_ns);
      const AtStage stage(thread_, Stage::writing);
      const int said = opened_.description.write(opened_.device, command.force.data());
      if (said < 0) page_.lost.store(1, std::memory_order_release);
      if (said > 0) page_.not_taken.fetch_add(1, std::memory_order_relaxed);
      if (said == 0) written_ = number;
      held_ = held_ || is_force;
      if (said == 0 && !is_force) {
        held_ = false;
        page_.until_ns.store(0, std::memory_order_release);
        return;
      }
    }
    if (held_) hold(now, command.at_ns);
  }

  void let_go() {
    if (opened_.description.release == nullptr) return;
    const AtStage stage(thread_, Stage::releasing);
    opened_.description.release(opened_.device);
    held_ = false;
    page_.until_ns.store(0, std::memory_order_release);
  }

 private:
  void hold(std::int64_t now, std::int64_t command_at_ns) noexcept {
    page_.until_ns.store(drivers::guarded_until_ns(now, command_at_ns), std::memory_order_release);
  }

  const Opened& opened_;
  Page& page_;
  Whereabouts& thread_;
  std::uint64_t written_ = 0;
  bool held_ = false;
};

class Reader {
 public:
  Reader(const Opened& opened, Page& page)
      : opened_(opened),
        page_(page),
        period_ns_((opened.facts.flags & KERF_ANSWERS_AT_ONCE) != 0 ? std::llround(1e9 / opened.facts.rate_hz)
                                                                    : 0),
        next_ns_(now_ns()) {}

  /// Waits until it is time to read one that answers at once. @returns whether it is one
  bool wait() noexcept {
    if (period_ns_ == 0) return false;
    // After a long wait the next one counts from now.
    next_ns_ = std::max(next_ns_ + period_ns_, now_ns() - period_ns_);
    sleep_until(next_ns_);
    return true;
  }

  /// False where the device is lost.
  bool read() {
    Reading reading;
    const std::int64_t before = now_ns();
    int said = 0;
    {
      const AtStage stage(page_.reader, Stage::reading);
      said = opened_.description.read(opened_.device, &reading.told);
    }
    reading.arrived_ns = now_ns();
    if (said < 0) return false;
    if (said == 0) {
      if (period_ns_ == 0 && reading.arrived_ns - before < at_once_ns)
        sleep_until(reading.arrived_ns + breath_ns);
      return true;
    }
    count(reading);
    if (reading.told.taken_ns <= 0 || reading.told.taken_ns > reading.arrived_ns)
      reading.told.taken_ns = reading.arrived_ns;
    page_.readings.put(reading);
    if ((opened_.facts.flags & KERF_FORCE_SENSOR) != 0) {
      constexpr std::uint64_t one = 1;
      [[maybe_unused]] const auto written = ::write(host_of_readings, &one, sizeof one);
    }
    return true;
  }

 private:
  void count(Reading& reading) noexcept {
    if ((opened_.facts.flags & KERF_COUNTS_READINGS) == 0) return;
    if (has_number_) {
      reading.step = count_step(number_, reading.told.number, opened_.facts.count_modulus);
      if (reading.step > 1) page_.missing.fetch_add(static_cast<std::uint64_t>(reading.step - 1));
      if (reading.step <= 0) page_.repeated.fetch_add(1);
    }
    has_number_ = true;
    number_ = reading.told.number;
  }

  const Opened& opened_;
  Page& page_;
  std::int64_t period_ns_;
  std::int64_t next_ns_;
  std::uint64_t number_ = 0;
  bool has_number_ = false;
};

void write_beside(const std::stop_token& stop, Hands& hands) {
  drivers::become_urgent("kerf-device-out");
  while (!stop.stop_requested()) {
    pollfd wakes{.fd = host_of_wakes, .events = POLLIN, .revents = 0};
    if (poll(&wakes, 1, command_wait_ms) > 0) {
      std::uint64_t count = 0;
      [[maybe_unused]] const auto taken = ::read(host_of_wakes, &count, sizeof count);
    }
    hands.act();
  }
}

}  // namespace

void work(const Opened& opened, Page& page, pid_t copy) {
  drivers::become_urgent("kerf-device-in");
  const bool beside = (opened.facts.flags & KERF_WRITES_ANY_TIME) != 0;
  Hands hands(opened, page, beside ? page.writer : page.reader);
  std::jthread writer;
  if (beside) writer = std::jthread([&](const std::stop_token& stop) { write_beside(stop, hands); });
  Reader reader(opened, page);
  for (std::int64_t looked_ns = now_ns(); page.lost.load(std::memory_order_relaxed) == 0;) {
    // So that a force goes out with the reading that is asked for, or right behind the one that has come.
    const bool asks = reader.wait();
    if (asks && !beside) hands.act();
    if (!reader.read()) {
      page.lost.store(1, std::memory_order_release);
      break;
    }
    if (!asks && !beside) hands.act();
    if (now_ns() - looked_ns < look_ns) continue;
    looked_ns = now_ns();
    if (program_is_gone()) break;
    if (copy > 0 && waitpid(copy, nullptr, WNOHANG) == copy) {
      copy = 0;
      page.unguarded.store(1, std::memory_order_release);
    }
  }
  if (writer.joinable()) {
    writer.request_stop();
    writer.join();
  }
  hands.let_go();
}

}  // namespace kerf::host

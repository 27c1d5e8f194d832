#pragma once

#include <chrono>
#include <csignal>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/drivers/device.h>

namespace kerf::test {

/// A device of kerf-emulate, plugged into this machine's kernel while the object lives.
class Emulator {
 public:
  enum class Plugged : std::uint8_t { at_once, by_hand };

  explicit Emulator(const std::string& device, std::vector<std::string> arguments = {},
                    Plugged plugged = Plugged::at_once) {
    std::vector<std::string> all{KERF_EMULATE, device};
    if (plugged == Plugged::at_once) all.emplace_back("--attach");
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> words;
    for (std::string& one : all) words.push_back(one.data());
    words.push_back(nullptr);
    if (posix_spawn(&process_, words[0], nullptr, nullptr, words.data(), environ) != 0) {
      throw std::runtime_error("kerf-emulate cannot be run");
    }
  }
  Emulator(const Emulator&) = delete;
  Emulator& operator=(const Emulator&) = delete;
  ~Emulator() { unplug(); }

  /// Ends the emulator, which unplugs the device, and waits until the kernel has noticed.
  void unplug() {
    if (process_ <= 0) return;
    if (waitpid(process_, nullptr, WNOHANG) == process_) {
      process_ = 0;  // it had unplugged itself
      return;
    }
    const std::size_t before = drivers::list_attached().size();
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
    process_ = 0;
    // One that has unplugged itself is gone already.
    for (int tries = 0; tries < 500 && before > 0 && drivers::list_attached().size() >= before; ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

 private:
  pid_t process_ = 0;
};

/// Whether a device whose URI begins so is attached (or not any more) within 10 s: the kernel takes its time
/// with both.
inline bool becomes_attached(const std::string& scheme, bool attached = true) {
  for (int tries = 0; tries < 500; ++tries) {
    bool found = false;
    for (const auto& device : drivers::list_attached()) found |= device.uri.starts_with(scheme);
    if (found == attached) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

/// What a device counted; -1 if it does not count that.
inline double figure(const drivers::Device& device, std::string_view name) {
  for (const auto& one : device.figures()) {
    if (one.name == name) return one.value;
  }
  return -1.0;
}

/// Ticks at 1 kHz by the clock: `each(tick, status, sample)` after each reading.
template <typename F>
void loop(drivers::Device& device, int ticks, F each) {
  const auto start = std::chrono::steady_clock::now();
  for (int tick = 0; tick < ticks; ++tick) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(tick + 1));
    drivers::Sample sample;
    const drivers::Status status = device.read(1e-3 * tick, sample);
    each(tick, status, sample);
  }
}

}  // namespace kerf::test

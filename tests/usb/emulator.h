#pragma once

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/drivers/device.h>

namespace kerf::tests {

/// A device of kerf-emulate, plugged into this machine's kernel while the object lives.
class Emulator {
 public:
  explicit Emulator(const std::string& device, std::vector<std::string> arguments = {}) {
    std::vector<std::string> all{KERF_EMULATE, device, "--attach"};
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

  /// Ends the emulator, which unplugs the device, and waits for that.
  void unplug() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  pid_t process_ = 0;
};

/// Whether a device whose URI begins so is attached (or not any more) within 10 s: the kernel takes its time with both.
inline bool becomes_attached(const std::string& scheme, bool attached = true) {
  for (int tries = 0; tries < 500; ++tries) {
    bool found = false;
    for (const auto& device : drivers::list_attached()) found |= device.uri.starts_with(scheme);
    if (found == attached) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

}  // namespace kerf::tests

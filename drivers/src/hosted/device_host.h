#pragma once

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <sys/types.h>

#include <kerf/processes/helper.h>

#include "hosted/host_page.h"

namespace kerf::drivers::hosted {

/// What a plug-in says of itself before anything is opened.
struct Look {
  std::string name;
  std::string about;
  std::vector<std::string> options;
};

/// kerf-device-host with one plug-in in it: a process of its own, which ends with this.
class DeviceHost {
 public:
  /// Loads it, and asks no more. @throws DeviceError for what is no device
  [[nodiscard]] static Look look(const std::filesystem::path& plugin);
  /// Of a device of Kerf's own that needs a library of its maker ("openhaptics", "dhd"): `about` is where
  /// that is. @throws DeviceError where it is not
  [[nodiscard]] static Look look_for_library(const std::string& built_in);

  struct Question {
    std::string uri;
    std::filesystem::path plugin;  ///< a shared object; or with none
    std::string built_in{};        ///< a device of Kerf's own that lives there too, "woody-v4"
    std::map<std::string, std::string> options;
    const std::atomic<bool>* stop = nullptr;  ///< nobody waits any more
  };
  /// Returns when the device is open. @throws DeviceError with its own reason, or how it misbehaved
  explicit DeviceHost(const Question& question);
  DeviceHost(const DeviceHost&) = delete;
  DeviceHost& operator=(const DeviceHost&) = delete;
  /// Waits until the device has been let go and closed.
  ~DeviceHost();

  [[nodiscard]] Page& page() const noexcept { return *page_; }
  /// Readable where a reading has come, of a force sensor.
  [[nodiscard]] int readings_descriptor() const noexcept { return readings_.number(); }
  /// A command has come. One system call, no lock.
  void wake() const noexcept;
  /// What became of it, for a person: how it ended, or in what it hangs; empty: nothing is wrong.
  [[nodiscard]] std::string trouble() const;
  /// Waits for the reason of a plug-in that has said that its device is lost, which it says once it has let
  /// go.
  void wait_for_reason() const;

 private:
  enum class Answer { look, opening, ready, refused, silent, ended };
  explicit DeviceHost(std::string uri);
  [[nodiscard]] static Look look(const Question& question);
  void ask(char kind, const Question& question);
  [[nodiscard]] Answer answer(int patience_ms, const std::atomic<bool>* stop, std::string& text);
  [[noreturn]] void refuse(const std::string& why) const;
  /// How it ended, or where it hangs.
  [[noreturn]] void refuse(Answer answer, const std::string& text) const;
  void end() noexcept;

  std::string uri_;
  Page* page_ = nullptr;
  processes::Descriptor socket_;
  processes::Descriptor wakes_;
  processes::Descriptor readings_;
  pid_t process_ = 0;
};

}  // namespace kerf::drivers::hosted

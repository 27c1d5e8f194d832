#pragma once

#include <cstdint>
#include <exception>

#include <sys/types.h>

#include <kerf/device.h>

#include "hosted/host_page.h"

namespace kerf::host {

/// A device that has been opened.
struct Opened {
  const kerf_device_v1& description;
  void* device;
  kerf_device_facts_v1 facts;  ///< its own copy: the plug-in can write anywhere
};

[[nodiscard]] std::int64_t now_ns() noexcept;
/// Whether it has closed its end of the connection, or died.
[[nodiscard]] bool program_is_gone() noexcept;

/// Says where a thread is in the plug-in, while it is there.
class AtStage {
 public:
  AtStage(drivers::hosted::Whereabouts& thread, drivers::hosted::Stage stage) noexcept
      : thread_(thread), before_(thread.stage.load(std::memory_order_relaxed)) {
    enter(stage);
  }
  AtStage(const AtStage&) = delete;
  AtStage& operator=(const AtStage&) = delete;
  /// What is thrown leaves it where it was thrown.
  ~AtStage() {
    if (std::uncaught_exceptions() == 0) enter(before_);
  }

 private:
  void enter(drivers::hosted::Stage stage) noexcept {
    thread_.since_ns.store(now_ns(), std::memory_order_relaxed);
    thread_.stage.store(stage, std::memory_order_release);
  }
  drivers::hosted::Whereabouts& thread_;
  drivers::hosted::Stage before_;
};

/// Reads and writes until the program is gone or the device is lost; then the device is let go.
/// @param copy the process that stands by: without it no force is given
void work(const Opened& opened, drivers::hosted::Page& page, pid_t copy);

}  // namespace kerf::host

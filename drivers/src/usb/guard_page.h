#pragma once

#include <atomic>
#include <cstdint>

#include <kerf/processes/helper.h>

#include "kerf/drivers/protocols/letting_go.h"

/// What a program and the guard of its device agree upon.
namespace kerf::drivers::usb {

/// The page that both see. Only the program writes.
struct GuardPage {
  LettingGo letting_go;  ///< taken once, before the guard says that it is ready
  /// When the device is to be let go unless a later time stands here by then [ns of CLOCK_MONOTONIC]; 0:
  /// nothing is held.
  std::atomic<std::int64_t> until_ns{0};
  static_assert(std::atomic<std::int64_t>::is_always_lock_free);
};

/// The descriptors with which a guard begins.
inline constexpr int guard_of_device = processes::first_descriptor;  ///< usbfs, with the interface claimed
inline constexpr int guard_to_program =
    guard_of_device + 1;  ///< a stream socket; its end is the program's death
inline constexpr int guard_of_page = guard_of_device + 2;

/// What goes over the socket, one byte each.
inline constexpr char guard_is_ready = 'r';
inline constexpr char guard_may_go = 'g';

}  // namespace kerf::drivers::usb

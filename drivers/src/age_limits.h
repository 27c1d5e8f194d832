#pragma once

#include <algorithm>
#include <cstdint>

#include "kerf/drivers/usb/guard.h"

/// How old what is said between a tick and its device may be, alike for all devices.
namespace kerf::drivers {

/// A reading that is older is Status::fault.
inline constexpr std::int64_t max_reading_age_ns = 20'000'000;
/// A device that has said nothing for longer is Status::lost.
inline constexpr std::int64_t max_silence_ns = 1'000'000'000;
/// By how much the time of a report may be wrong: a frame of the bus.
inline constexpr double max_report_jitter_s = 1e-3;
/// An older command is not held any longer: five periods of the slowest loop, so the one that gave it is
/// dead.
inline constexpr std::int64_t max_command_age_ns = 50'000'000;

/// When the guard lets a device go that has the force of a command from the loop: when this thread is silent,
/// or has not let go by itself what the loop does not renew.
inline std::int64_t guarded_until_ns(std::int64_t now_ns, std::int64_t command_at_ns) noexcept {
  return std::min(now_ns, command_at_ns + max_command_age_ns) + usb::Guard::max_silence_ns;
}

}  // namespace kerf::drivers

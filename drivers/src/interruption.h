#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "kerf/drivers/device.h"

namespace kerf::drivers {

/// Ends the opening of `what` where nobody waits for it any more. @throws DeviceError if `stop` is set.
inline void refuse_if_stopped(std::string_view what, const std::atomic<bool>* stop) {
  if (stop != nullptr && stop->load()) {
    throw DeviceError(std::string(what) + ": opening it was interrupted");
  }
}

}  // namespace kerf::drivers

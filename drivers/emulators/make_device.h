#pragma once

#include <memory>
#include <string_view>

#include "emulated_device.h"

namespace kerf::emulators {

/// A device by name with its options: "falcon?homed=on".
/// @throws drivers::DeviceError for a name or an option that there is not.
[[nodiscard]] std::unique_ptr<EmulatedDevice> make_device(std::string_view uri);

}  // namespace kerf::emulators

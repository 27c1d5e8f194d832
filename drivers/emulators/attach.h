#pragma once

#include <kerf/processes/helper.h>

#include "emulated_device.h"

namespace kerf::emulators {

using processes::Descriptor;

/// Plugs a device into this machine's kernel through vhci-hcd; closing what it returns unplugs it.
/// @throws std::runtime_error that says what is missing.
[[nodiscard]] Descriptor attach_here(const Description& device);

/// Waits for a client of USB/IP that imports the device, answering those that only list it, at most so long.
/// @returns no descriptor (-1) if none came.
[[nodiscard]] Descriptor accept_import(const Descriptor& listening, const Description& device,
                                       int timeout_ms);

}  // namespace kerf::emulators

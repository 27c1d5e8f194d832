#pragma once

#include <string_view>

#include "hosted/host_page.h"
#include "kerf/drivers/device.h"

namespace kerf::drivers::hosted {

/// What a plug-in said of its device, once it has been looked at as what a stranger said. Its channels alone;
/// configuration is its settings.
/// @throws DeviceError with the field that is wrong, and what was expected
[[nodiscard]] DeviceInfo info_of(const kerf_device_facts_v1& facts, bool has_write, std::string_view uri);

}  // namespace kerf::drivers::hosted

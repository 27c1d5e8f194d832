#pragma once

#include <string_view>

#include <kerf/device.h>

namespace kerf::host {

/// Kerf's own devices that live in this process, as their URI names them: "woody-v4"; else nothing.
[[nodiscard]] const kerf_device_v1* built_in(std::string_view name) noexcept;

}  // namespace kerf::host

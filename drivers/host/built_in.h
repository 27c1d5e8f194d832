#pragma once

#include <string_view>

#include <kerf/device.h>

namespace kerf::host {

extern const kerf_device_v1 inverse3_device;
extern const kerf_device_v1 two_diy_device;
extern const kerf_device_v1 woody_v4_device;

/// Kerf's own devices that live in this process, by their name: "2diy", "inverse3", "woody-v4"; else nothing.
[[nodiscard]] inline const kerf_device_v1* built_in(std::string_view name) noexcept {
  for (const kerf_device_v1* const one : {&inverse3_device, &two_diy_device, &woody_v4_device}) {
    if (name == one->name) return one;
  }
  return nullptr;
}

}  // namespace kerf::host

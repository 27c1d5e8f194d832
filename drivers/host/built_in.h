#pragma once

#include <string>
#include <string_view>

#include <kerf/device.h>

namespace kerf::host {

extern const kerf_device_v1 force_dimension_device;
extern const kerf_device_v1 hapkit_device;
extern const kerf_device_v1 hapkit_stream_device;
extern const kerf_device_v1 inverse3_device;
extern const kerf_device_v1 open_haptics_device;
extern const kerf_device_v1 two_diy_device;
extern const kerf_device_v1 woody_v4_device;

/// Loads the library of a maker, and opens no device. @returns where it is, and what it tells before one is
/// opened
/// @throws std::runtime_error where it is not installed or not usable, with what mends that
[[nodiscard]] std::string look_for_force_dimension();
[[nodiscard]] std::string look_for_open_haptics();

/// Kerf's own devices that live in this process, by their name: "2diy", "dhd", "inverse3", ...; else nothing.
[[nodiscard]] inline const kerf_device_v1* built_in(std::string_view name) noexcept {
  for (const kerf_device_v1* const one :
       {&force_dimension_device, &hapkit_device, &hapkit_stream_device, &inverse3_device,
        &open_haptics_device, &two_diy_device, &woody_v4_device}) {
    if (name == one->name) return one;
  }
  return nullptr;
}

}  // namespace kerf::host

#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "kerf/drivers/usb/usb_device.h"

namespace kerf::drivers {

inline constexpr usb::Identity falcon_identity{0x0403, 0xcb48, "Novint Falcon"};
inline constexpr std::uint8_t falcon_in = 0x81;
inline constexpr std::uint8_t falcon_out = 0x02;

struct FalconSetup {
  std::string_view uri;
  std::string firmware;  ///< path of an image; empty: none
  bool homing = true;    ///< so that asking does not end a homing that was
  const std::atomic<bool>* stop = nullptr;
};

/// Brings a Falcon to where it answers run-time frames, loading its firmware if it has none.
/// @throws DeviceError
void set_up_falcon(usb::UsbDevice& device, const FalconSetup& setup);

}  // namespace kerf::drivers

#include "make_device.h"

#include <kerf/drivers/device.h>
#include <kerf/drivers/uri.h>

#include "devices/falcon.h"
#include "devices/labjack_u6.h"
#include "devices/spacemouse.h"
#include "devices/woodenhaptics.h"

namespace kerf::emulators {

std::unique_ptr<EmulatedDevice> make_device(std::string_view text) {
  drivers::Uri uri = drivers::parse_uri(text);
  if (uri.name == "falcon")
    return std::make_unique<EmulatedFalcon>(EmulatedFalcon::parse_options(std::move(uri)));
  if (uri.name == "spacemouse") {
    return std::make_unique<EmulatedSpaceMouse>(EmulatedSpaceMouse::parse_options(std::move(uri)));
  }
  if (uri.name == "u6") return std::make_unique<EmulatedU6>(EmulatedU6::parse_options(std::move(uri)));
  if (uri.name == "woody")
    return std::make_unique<EmulatedWoodenHaptics>(EmulatedWoodenHaptics::parse_options(std::move(uri)));
  throw drivers::DeviceError(
      "no emulator of '" + uri.name +
      "'; there are falcon, woody, u6 and spacemouse, net-ft, onrobot and t7, bota, optoforce and ft300");
}

}  // namespace kerf::emulators

#include <algorithm>
#include <string>
#include <string_view>

#include "hosted/device_host.h"
#include "kerf/drivers/attached_ports.h"
#include "kerf/drivers/device.h"

namespace kerf::drivers {

std::vector<MakerLibrary> find_maker_libraries() {
  std::vector<MakerLibrary> all{{.uri = "openhaptics:", .about = "3D Systems Touch, Omni, Desktop, Premium"},
                                {.uri = "dhd:0", .about = "Force Dimension, Falcon"}};
  for (MakerLibrary& one : all) {
    const std::string built_in = one.uri.substr(0, one.uri.find(':'));
    try {
      one.found = hosted::DeviceHost::look_for_library(built_in).about;
    } catch (const DeviceError& error) {
      const std::string_view why = error.what();
      one.problem = why.substr(std::min(why.size(), built_in.size() + std::string_view(": ").size()));
    }
  }
  return all;
}

}  // namespace kerf::drivers

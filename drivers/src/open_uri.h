#pragma once

#include <memory>
#include <string_view>

#include "kerf/drivers/device.h"

namespace kerf::drivers {

/// As open_device(), of a URI that is no name of the bench file and says of none.
[[nodiscard]] std::unique_ptr<Device> open_uri(std::string_view uri, Surroundings surroundings);

}  // namespace kerf::drivers

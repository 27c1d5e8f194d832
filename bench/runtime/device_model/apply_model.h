#pragma once

#include "device_model/model_in_use.h"

namespace kerf::bench {

/// Puts a model that is at hand, such as one that was just measured, into what a driver says of its axes, as
/// take_model() does with one that somebody named: it wins over the driver.
/// @throws std::invalid_argument: it has no axis of the device.
[[nodiscard]] ModelInUse apply_model(drivers::DeviceInfo& device, ModelFile model, const TakeModel& how);

}  // namespace kerf::bench

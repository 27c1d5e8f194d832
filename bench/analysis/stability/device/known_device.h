#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/drivers/device.h>

#include "device_model/model_in_use.h"
#include "stability/device/axis_request.h"
#include "stability/findings.h"

namespace kerf::bench {

/// A device as its driver and a model of it know it.
struct KnownDevice {
  drivers::DeviceInfo info;
  std::optional<ModelInUse> model;
  std::vector<std::string> warnings;

  /// Opens it and takes the model that is asked for, or kept. @throws as open_device() and take_model().
  explicit KnownDevice(const AxisRequest& on);
  /// With a model that was just made, in place of a file's.
  KnownDevice(const AxisRequest& on, const ModelFile& fresh);

  /// Says ahead of what was found whose numbers it rests on: the first lines, and the object `device_model`.
  void tell(Findings& findings) const;
};

}  // namespace kerf::bench

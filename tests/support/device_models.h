#pragma once

#include <string>

#include <kerf/drivers/device_model.h>

namespace kerf::test {

/// A model of the axis `x` of `sim:axis` as it is without options, told apart by nothing but its URI.
inline drivers::DeviceModel model_of(const std::string& uri,
                                     const std::string& date = "2026-01-31T12:00:00Z") {
  using drivers::Estimate;
  drivers::DeviceModel model;
  model.kerf = "0.1.0 (abcdef0)";
  model.date = date;
  model.rate_hz = 1000.0;
  model.conditions = "on the bench";
  model.uri = uri;
  model.model = "sim:axis";
  drivers::AxisModel x;
  x.name = "x";
  x.limits = {
      .lower = -0.1, .upper = 0.1, .force = 10.0, .slew = 5000.0, .speed = 5.0, .acceleration = 2000.0};
  x.mass = Estimate{0.08, 0.07, 0.09};
  x.viscous = Estimate{2.0, 1.9, 2.1};
  x.coulomb_up = Estimate{0.0, -0.01, 0.01};
  x.coulomb_down = Estimate{0.0, -0.01, 0.01};
  x.delay = Estimate{1.3e-3, 1.2e-3, 1.4e-3};
  x.encoder_step = Estimate::exactly(20e-6);
  model.axes = {x};
  return model;
}

}  // namespace kerf::test

#include "cases/devices.h"

#include <kerf/drivers/uri.h>

namespace kerf::bench {

SampledDevice scissors_handle() {
  return sampled_device(drivers::open_device("sim:scissors")->info(), 0, 1000.0);
}

SampledDevice linear_handle() {
  SampledDevice handle = scissors_handle();
  handle.encoder_step_m = 0.0;
  handle.coulomb_n = 0.0;
  return handle;
}

}  // namespace kerf::bench

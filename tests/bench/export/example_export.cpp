#include "bench/export/example_export.h"

#include <limits>

#include "bench/export/liver.c"

namespace kerf::test {

std::vector<double> forces_of_liver(const std::vector<bench::HostSample>& samples) {
  liver_state state;
  liver_reset(&state);
  std::vector<double> forces;
  for (const bench::HostSample& sample : samples) {
    double force = 0.0;
    if (liver_step(&state, sample.position, sample.velocity, sample.elapsed_s, &force) != 0)
      force = std::numeric_limits<double>::quiet_NaN();
    forces.push_back(force);
  }
  return forces;
}

}  // namespace kerf::test

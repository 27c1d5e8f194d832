#include "verbs/simulated_device.h"

#include <stdexcept>

#include <fmt/format.h>

namespace kerf::bench {

std::vector<SweepInput> simulated_device_inputs() {
  return {{.name = "device",
           .kind = SweepInput::Kind::text,
           .what = "Simulated device: sim:axis, sim:scissors?fault=...",
           .required = true},
          {.name = "device_seed",
           .kind = SweepInput::Kind::whole,
           .what = "Seed of what the device draws; as its URI says where it is not given",
           .lower = 0}};
}

std::string simulated_device(const SweepCell& cell) {
  const std::string& uri = cell.text("device");
  if (!uri.starts_with("sim:"))
    throw std::invalid_argument(fmt::format("'{}' is no simulated device, and a sweep moves no other", uri));
  if (!cell.has("device_seed")) return uri;
  return fmt::format("{}{}seed={}", uri, uri.find('?') == std::string::npos ? '?' : '&',
                     cell.number("device_seed"));
}

}  // namespace kerf::bench

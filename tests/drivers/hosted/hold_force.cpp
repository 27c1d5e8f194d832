// Holds a force at a device and is killed: hold_force URI FORCE...

#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <string>

#include <fmt/core.h>
#include <unistd.h>

#include "kerf/drivers/device.h"

int main(int count, char** words) try {
  const auto device = kerf::drivers::open_device(words[1]);
  kerf::drivers::Axes force{};
  for (int i = 2; i < count; ++i) force.at(static_cast<std::size_t>(i - 2)) = std::stod(words[i]);
  kerf::drivers::Sample sample;
  for (int tick = 0; tick < 300; ++tick) {
    (void)device->write(force);
    (void)device->read(0.0, sample);
    usleep(1000);
  }
  (void)std::raise(SIGKILL);
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return EXIT_FAILURE;
}

#include "kerf/drivers/device_notes.h"

#include <mutex>
#include <utility>

namespace kerf::drivers {
namespace {

struct DeviceNotes {
  std::mutex mutex;
  std::vector<std::string> lines;
  std::function<void(const std::string&)> told;
};

DeviceNotes& device_notes() {
  static DeviceNotes notes;
  return notes;
}

}  // namespace

void note_device(std::string line) {
  const std::scoped_lock lock(device_notes().mutex);
  device_notes().lines.push_back(std::move(line));
}

void tell_waits_to(std::function<void(const std::string&)> told) {
  const std::scoped_lock lock(device_notes().mutex);
  device_notes().told = std::move(told);
}

void tell_wait(const std::string& line) {
  const std::scoped_lock lock(device_notes().mutex);
  if (device_notes().told) device_notes().told(line);
}

std::vector<std::string> take_device_notes() {
  const std::scoped_lock lock(device_notes().mutex);
  return std::exchange(device_notes().lines, {});
}

}  // namespace kerf::drivers

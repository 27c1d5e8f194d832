#include "trace.h"

#include <kerf/drivers/device.h>

namespace kerf::emulators {

std::ofstream open_trace(const std::string& path, std::string_view columns) {
  std::ofstream trace;
  if (path.empty()) return trace;
  trace.open(path);
  if (!trace) throw drivers::DeviceError("the trace " + path + " cannot be written; give another trace=FILE");
  trace << columns << '\n';
  return trace;
}

}  // namespace kerf::emulators

#include "stability/device/known_device.h"

#include <string_view>
#include <utility>

#include "device_model/apply_model.h"

namespace kerf::bench {

KnownDevice::KnownDevice(const AxisRequest& on) : info(drivers::open_device(on.device_uri)->info()) {
  model = take_model(info, {.file = on.device_model,
                            .rate_hz = on.rate_hz,
                            .now = {},
                            .warn = [this](std::string_view line) { warnings.emplace_back(line); }});
}

KnownDevice::KnownDevice(const AxisRequest& on, const ModelFile& fresh)
    : info(drivers::open_device(on.device_uri)->info()) {
  model = apply_model(info, fresh, {.rate_hz = on.rate_hz});
}

void KnownDevice::tell(Findings& findings) const {
  findings.json["device_model"] = as_json(model);
  std::vector<std::string> lines = warnings;
  if (model) {
    for (std::string& line : lines_of(*model)) lines.push_back(std::move(line));
  }
  findings.lines.insert(findings.lines.begin(), lines.begin(), lines.end());
}

}  // namespace kerf::bench

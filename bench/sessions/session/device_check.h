#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "felt/felt_remarks.h"
#include "protocol/protocol.h"

namespace kerf::bench {

/// Whether every sample of a protocol, at the ends of its levels too, can be rendered on a device: its axes
/// are there; all laws of a tissue together, as a session computes them, take at most half of a period in
/// 99.9 % of the ticks; and, on a simulated device in virtual time, no law fails and none is cut to the limit
/// of the device in more ticks than the protocol allows, where a session would compare limits and not laws.
/// @return what is worth saying and no reason to refuse: a law that has a limit cycle in a firm grip, and
///         felt_remarks(); whose model of the device that rests on (`device_model`: its file, else the one
///         that is kept of the device).
/// @throws std::invalid_argument that names the sample and what is wrong; drivers::DeviceError.
[[nodiscard]] std::vector<std::string> check_samples(const Protocol& protocol, const std::string& device_uri,
                                                     const std::atomic<bool>& stop,
                                                     SamplesTold told = SamplesTold::without_names,
                                                     const std::string& device_model = {});

}  // namespace kerf::bench

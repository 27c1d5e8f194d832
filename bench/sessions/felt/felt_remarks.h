#pragma once

#include <string>
#include <vector>

#include "protocol/protocol.h"

namespace kerf::bench {

/// Who is told: whoever makes a session learns which samples; at a run, where a subject may sit at the same
/// screen, only that there are some.
enum class SamplesTold { by_name, without_names };

/// Whether anything but their laws tells samples that are compared apart, as they are felt with their gains
/// in a simulated hand: strength of more than a JND, ticks that are cut to a limit, vibration (felt_level.h).
/// On a real device the first simulated one that fits takes its place, and the remark says so. Nothing of a
/// design of levels; whoever makes a session is also told why nothing could be compared.
/// @throws drivers::DeviceError; std::invalid_argument: a law faults.
[[nodiscard]] std::vector<std::string> felt_remarks(const Protocol& protocol, const std::string& device_uri,
                                                    SamplesTold told);

}  // namespace kerf::bench

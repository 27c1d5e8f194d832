#pragma once

#include <functional>
#include <string>

#include "formats/unpacked_limits.h"

namespace kerf::bench {

/// Does work in a process of its own, a fork of this one, which may take as much memory as is allowed to be
/// unpacked and 1 GiB, and two minutes of a processor: for libraries that believe what a damaged file says of
/// itself. What the work returns or throws as std::invalid_argument comes back.
/// @throws std::invalid_argument if the process fell over the file or ran out of what it may take;
///         std::system_error if there is no process to be had.
[[nodiscard]] std::string run_apart(const UnpackedLimits& limits, const std::function<std::string()>& work);

}  // namespace kerf::bench

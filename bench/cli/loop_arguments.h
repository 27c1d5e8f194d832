#pragma once

#include <string>
#include <vector>

#include "cli/verb.h"
#include "loop/run.h"

namespace kerf::bench {

/// The options of a verb that runs the loop on a device.
struct LoopArguments {
  RunOptions options;
  std::vector<std::string> changes;  ///< LAW@SECONDS
};

/// Adds --device, --sensor, --seconds, --rate, --virtual, --switch, --ramp, --passivity-control and --force.
void add_loop_options(Verb& verb, LoopArguments& arguments);

/// What was asked for, with the laws of --switch read. @throws std::invalid_argument, std::system_error
[[nodiscard]] RunOptions run_options(const LoopArguments& arguments);

}  // namespace kerf::bench

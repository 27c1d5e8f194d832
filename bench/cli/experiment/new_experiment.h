#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "experiment/key_arguments.h"
#include "program/app.h"
#include "protocol/protocol.h"

namespace kerf::bench {

struct NewExperimentArguments {
  std::string experiment;   ///< its file or folder
  std::string replaces;     ///< a participant who left; empty: all sessions are made
  std::string participant;  ///< code of whoever replaces them; empty: the next one
  std::uint64_t seed = 0;   ///< of the orders
  /// Makes samples equally loud and checks them on a device, before anything is written.
  std::function<void(Protocol&)> prepare;
};

/// Registers an experiment and makes the sessions of all its participants, or that of a replacement.
void make_experiment(const NewExperimentArguments& arguments, KeyArguments& key, Context& context);

}  // namespace kerf::bench

#include "replay/replay_modes.h"

#include <array>

namespace kerf::bench {
namespace {

/// An option that not every mode has a use for.
struct OptionOfModes {
  const char* option;
  std::array<bool, 3> used;  ///< by ReplayMode
  const char* instead;       ///< where it says something
};
constexpr const char* of_through = "it is for --through";
constexpr const char* of_path = "it is for --as path";
constexpr const char* of_device = "it is for --as table and --as path";
constexpr const char* of_motion = "it is for --through and --as path";
constexpr const char* of_law = "it is for --through and --as table";
constexpr std::array options_of_modes{
    OptionOfModes{"--speed", {true, false, true}, of_motion},
    OptionOfModes{"--bridge", {true, false, true}, of_motion},
    OptionOfModes{"--loop", {false, false, true}, of_path},
    OptionOfModes{"--stiffness", {false, false, true}, of_path},
    OptionOfModes{"--damping", {false, false, true}, of_path},
    OptionOfModes{"--limit", {false, false, true}, of_path},
    OptionOfModes{"--approach", {false, false, true}, of_path},
    OptionOfModes{"--contact", {true, true, false}, of_law},
    OptionOfModes{"--direction", {true, true, false}, of_law},
    OptionOfModes{"--realtime", {true, false, false}, of_through},
    OptionOfModes{"--contact-force", {true, false, false}, of_through},
    OptionOfModes{"--drop-window", {true, false, false}, of_through},
    OptionOfModes{"--match", {true, false, false}, of_through},
    OptionOfModes{"--axis", {false, true, true}, of_device},
    OptionOfModes{"--record", {false, true, true}, "what it gives is in the folder of -o"},
    OptionOfModes{"--device", {false, true, true}, of_device},
    OptionOfModes{"--scene", {false, true, true}, of_device},
    OptionOfModes{"--sensor", {false, true, true}, of_device},
    OptionOfModes{"--seconds", {false, true, true}, of_device},
    OptionOfModes{"--rate", {false, true, true}, of_device},
    OptionOfModes{"--virtual", {false, true, true}, of_device},
    OptionOfModes{"--ramp", {false, true, true}, of_device},
    OptionOfModes{"--passivity-control", {false, true, true}, of_device},
    OptionOfModes{"--device-model", {false, true, true}, of_device},
    OptionOfModes{"--switch", {false, false, false}, "it is for 'kerf check'"},
};

constexpr std::array mode_names{"--through", "--as table", "--as path"};

}  // namespace

void refuse_options_of_others(ReplayMode mode, const RefuseIdle& refuse_idle) {
  const auto at = static_cast<std::size_t>(mode);
  for (const OptionOfModes& one : options_of_modes) {
    if (!one.used.at(at)) refuse_idle({one.option}, mode_names.at(at), one.instead);
  }
}

}  // namespace kerf::bench

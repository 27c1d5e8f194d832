#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json.hpp>

#include "choose/choose.h"
#include "choose/loop_checks.h"

namespace kerf::bench {

/// What laws are tried by beside held-out data.
enum class TriedBy : std::uint8_t {
  data,          ///< by nothing else
  virtual_time,  ///< by their stability on the device, which is computed
  wall_clock     ///< and by their deadlines, which takes the machine for itself
};

struct DeviceChoiceOptions {
  ChooseOptions choose;   ///< with the contact; its search's checks are set here
  LoopCheckOptions loop;  ///< without a device: device_for() the recording
  TriedBy tried_by = TriedBy::wall_clock;
  /// Before a law is tried, with the device's URI.
  std::function<void(const std::string& law, const std::string& device_uri)> begins;
};

/// A choice, and its JSON as `kerf choose` writes it.
struct DeviceChoice {
  LawChoice choice;
  nlohmann::ordered_json json;
};

/// choose_law() for a recording, in closed loop with a device. `file` is the recording's name in the JSON.
/// @throws as choose_law() and LoopChecks do.
[[nodiscard]] DeviceChoice choose_on_device(const schema::Recording& recording,
                                            const std::filesystem::path& file, DeviceChoiceOptions options,
                                            const std::atomic<bool>& stop);

/// Lets a search try laws by these checks, which must outlive it.
void connect(const LoopChecks& checks, TriedBy tried_by, CandidateSearchOptions& search);

}  // namespace kerf::bench

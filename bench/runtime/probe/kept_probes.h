#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>

#include "probe/push_judgement.h"

namespace kerf::bench {

struct ProbeResult;

/// What is kept of a probe.
struct KeptProbe {
  struct Axis {
    std::string name;
    PushVerdict verdict = PushVerdict::unknown;
  };
  std::string date;  ///< UTC, ISO 8601
  std::vector<Axis> axes;

  /// Names of the axes with a verdict: "x, z".
  [[nodiscard]] std::string axes_that_are(PushVerdict verdict) const;
};

/// The probes that are kept, in one file for all devices of a user.
///
/// A device is known by its model, which names the generation too, its serial number and the port that it is
/// plugged in at: makers give all of their devices one serial number. Any other model, and another version of
/// the drivers' sign tables, make it a device that was never probed.
class KeptProbes {
 public:
  explicit KeptProbes(std::filesystem::path file) : file_(std::move(file)) {}

  /// probes.json in $XDG_DATA_HOME/kerf, or in ~/.local/share/kerf; empty where there is neither.
  [[nodiscard]] static std::filesystem::path usual_file();

  /// That of a device. A file that cannot be read as one of ours holds none, and `warn` is told so.
  [[nodiscard]] std::optional<KeptProbe> find(const drivers::DeviceInfo& device,
                                              const std::function<void(std::string_view)>& warn) const;
  /// Keeps it in place of what was kept of the same device. Others that keep theirs at the same time wait.
  /// @throws std::system_error
  void keep(const ProbeResult& result) const;

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  std::filesystem::path file_;
};

/// Asked before anything is rendered on a device. Where no probe of it is kept, or one that could not tell of
/// an axis, `warn` gets a line that says so; a simulated device, and one without force, needs none.
/// @throws drivers::DeviceError where a push moved the handle the wrong way.
void require_probed(const drivers::DeviceInfo& device, const std::function<void(std::string_view)>& warn);

}  // namespace kerf::bench

#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <kerf/drivers/device_model.h>

namespace kerf::bench {

/// A model, and the file that it stands in.
struct ModelFile {
  std::filesystem::path file;
  drivers::DeviceModel model;
};

/// Reads the model of a device. @throws as drivers::read_device_model() does, what is wrong in it being bad
/// input: std::invalid_argument.
[[nodiscard]] ModelFile read_model_file(const std::filesystem::path& file);
/// Writes it as write_whole_file() does.
void write_model_file(const std::filesystem::path& file, const drivers::DeviceModel& model,
                      bool replace = true);

/// The models that are kept, a file for each device of a user, so that whoever judges a device finds its own.
///
/// A device is known as its probes are (KeptProbes): by its model, its serial number and the port that it is
/// plugged in at, for makers give all of their devices one serial number. A simulated device, which has
/// neither, is known by its URI.
class KeptModels {
 public:
  explicit KeptModels(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// kerf/devices in $XDG_DATA_HOME, or in ~/.local/share; empty where there is neither.
  [[nodiscard]] static std::filesystem::path usual_folder();

  /// That of a device; of several the one that was measured last. A file that cannot be read is told to
  /// `warn` and passed over.
  [[nodiscard]] std::optional<ModelFile> find(const drivers::DeviceInfo& device,
                                              const std::function<void(std::string_view)>& warn) const;
  /// Keeps it in place of what was kept of the same device, and says where. @throws std::system_error
  std::filesystem::path keep(const drivers::DeviceModel& model) const;
  /// All of them, in the order of their files' names.
  [[nodiscard]] std::vector<ModelFile> all(const std::function<void(std::string_view)>& warn) const;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// Whether a model is of a device.
[[nodiscard]] bool is_of(const drivers::DeviceModel& model, const drivers::DeviceInfo& device);

}  // namespace kerf::bench

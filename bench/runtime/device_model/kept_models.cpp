#include "device_model/kept_models.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include <kerf/schema/final_name.h>

#include "files/file_names.h"
#include "files/whole_file.h"

namespace kerf::bench {
namespace {

constexpr std::string_view extension = ".device.toml";

bool same_device(const drivers::DeviceModel& a, const drivers::DeviceModel& b) {
  const bool simulated = a.uri.starts_with("sim:") || b.uri.starts_with("sim:");
  return a.model == b.model && a.serial == b.serial && a.port == b.port && (!simulated || a.uri == b.uri);
}

/// "Novint_Falcon-0000001-1-2.3"
std::string name_of(const drivers::DeviceModel& model) {
  std::string name = model.uri.starts_with("sim:") ? model.uri : model.model;
  if (model.serial && !model.serial->empty()) name += "-" + *model.serial;
  if (!model.port.empty()) name += "-" + model.port;
  return as_file_name(name);
}

}  // namespace

ModelFile read_model_file(const std::filesystem::path& file) {
  try {
    return {.file = file, .model = drivers::read_device_model(file.string())};
  } catch (const drivers::DeviceError& error) {
    throw std::invalid_argument(error.what());
  }
}

void write_model_file(const std::filesystem::path& file, const drivers::DeviceModel& model, bool replace) {
  write_whole_file(file, drivers::to_toml(model), schema::existing_if(replace));
}

bool is_of(const drivers::DeviceModel& model, const drivers::DeviceInfo& device) {
  return model.model == device.model && model.serial == device.serial && model.port == device.port &&
         (!device.simulated || model.uri == device.uri);
}

std::filesystem::path KeptModels::usual_folder() {
  const char* const data = std::getenv("XDG_DATA_HOME");
  const char* const home = std::getenv("HOME");
  if (data == nullptr && home == nullptr) return {};
  const std::filesystem::path root = data != nullptr ? data : std::string(home) + "/.local/share";
  return root / "kerf" / "devices";
}

std::vector<ModelFile> KeptModels::all(const std::function<void(std::string_view)>& warn) const {
  std::vector<ModelFile> models;
  std::error_code ignored;
  if (folder_.empty() || !std::filesystem::is_directory(folder_, ignored)) return models;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
    if (entry.path().filename().string().ends_with(extension)) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const std::filesystem::path& file : files) {
    try {
      models.push_back(read_model_file(file));
    } catch (const std::exception& error) {
      if (warn) warn(fmt::format("{}; it is passed over", error.what()));
    }
  }
  return models;
}

std::optional<ModelFile> KeptModels::find(const drivers::DeviceInfo& device,
                                          const std::function<void(std::string_view)>& warn) const {
  std::optional<ModelFile> found;
  for (ModelFile& one : all(warn)) {
    if (is_of(one.model, device) && (!found || found->model.date < one.model.date)) found = std::move(one);
  }
  return found;
}

std::filesystem::path KeptModels::keep(const drivers::DeviceModel& model) const {
  std::filesystem::create_directories(folder_);
  for (const ModelFile& one : all({})) {
    if (!same_device(one.model, model)) continue;
    write_model_file(one.file, model);
    return one.file;
  }
  const std::string name = name_of(model);
  std::filesystem::path file = folder_ / (name + std::string(extension));
  for (int number = 2; std::filesystem::exists(file); ++number)
    file = folder_ / fmt::format("{}-{}{}", name, number, extension);
  write_model_file(file, model, false);
  return file;
}

}  // namespace kerf::bench

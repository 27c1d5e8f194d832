#include <utility>

#include <fmt/format.h>

#include "bench_file/bench_option.h"
#include "kerf/drivers/bench_file.h"
#include "kerf/drivers/toml_text.h"
#include "kerf/drivers/uri.h"
#include "open_uri.h"

namespace kerf::drivers {
namespace {

/// A device or sensor that the bench file names, with the frame that it gives to a sensor. Name, file and
/// frame stand first in the configuration, where no table has begun.
class NamedDevice final : public Device {
 public:
  NamedDevice(std::unique_ptr<Device> device, const BenchFile& file, const BenchEntry& entry)
      : device_(std::move(device)), info_(device_->info()), frame_(entry.frame) {
    std::string told = fmt::format("bench = {{ name = \"{}\", file = {}, sha256 = \"{}\" }}\n", entry.name,
                                   toml_text(file.file.string()), file.sha256);
    if (frame_) {
      if (const std::string why = no_frame_for(info_.axes); !why.empty())
        throw DeviceError(fmt::format("{}: [sensor.{}.frame]: {}", file.file.string(), entry.name, why));
      if (info_.axes.size() == 3 && frame_->tool_m != SensorFrame::Vector{})
        throw DeviceError(fmt::format("{}: [sensor.{}.frame]: 'tool' moves torques, and {} tells none",
                                      file.file.string(), entry.name, info_.uri));
      told += fmt::format("sensor_frame = {}\n", to_toml(*frame_));
    }
    info_.configuration = told + info_.configuration;
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] Status read(double now_s, Sample& sample) noexcept override {
    const Status status = device_->read(now_s, sample);
    if (frame_) sample.force_measured = frame_->apply(sample.force_measured);
    return status;
  }
  [[nodiscard]] Status write(const Axes& force) noexcept override { return device_->write(force); }
  void release(double at_s) noexcept override { device_->release(at_s); }
  [[nodiscard]] std::vector<Figure> figures() const override { return device_->figures(); }
  [[nodiscard]] std::string trouble() const override { return device_->trouble(); }

 private:
  std::unique_ptr<Device> device_;
  DeviceInfo info_;
  std::optional<SensorFrame> frame_;
};

}  // namespace

std::unique_ptr<Device> open_device(std::string_view text, Surroundings surroundings) {
  const std::string uri = named_uri(text);
  const Uri parts = parse_uri(uri);
  const auto name = parts.options.find(std::string(bench_option));
  if (name == parts.options.end()) return open_uri(uri, std::move(surroundings));
  const auto file = find_bench_file();
  const BenchEntry* entry = file ? file->find(name->second) : nullptr;
  if (entry == nullptr || parse_uri(entry->uri).name != parts.name) {
    throw DeviceError(
        fmt::format("{}: the bench file has no '{}' that is {} any more", uri, name->second, parts.name));
  }
  return std::make_unique<NamedDevice>(open_uri(without_bench_name(uri), std::move(surroundings)), *file,
                                       *entry);
}

std::unique_ptr<Device> open_device(std::string_view uri) {
  Surroundings nothing;
  return open_device(uri, std::move(nothing));
}

}  // namespace kerf::drivers

#include "record/device_recording.h"

#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "recordings/axes.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

std::vector<schema::Channel> channels_of(const drivers::DeviceInfo& device) {
  std::vector<schema::Channel> channels;
  for (const drivers::ChannelInfo& channel : device.channels) {
    channels.push_back({.name = channel.name, .unit = channel.unit, .values = {}});
  }
  return channels;
}

}  // namespace

std::size_t recorded_row_bytes(const drivers::DeviceInfo& device) {
  constexpr std::size_t time_and_tick = 2 * sizeof(double);
  constexpr std::size_t stages_and_flags = 4 * sizeof(float) + sizeof(std::uint32_t);
  const std::size_t of_each_axis = device.measures_force ? 4 : 3;  // position, velocity, forces
  return time_and_tick + stages_and_flags +
         sizeof(double) * (of_each_axis * device.axes.size() + device.channels.size());
}

schema::RecordingWriter begin_device_recording(const std::filesystem::path& file,
                                               const drivers::DeviceInfo& device,
                                               const std::optional<Scene>& scene, bool replace,
                                               std::string_view plugins) {
  schema::Header header = schema::new_header(software());
  header.device_uri = device.uri;
  header.device_toml = device.configuration;
  if (scene) header.scene_toml = scene->toml;
  if (!plugins.empty()) add_history(header, fmt::format("rendered with {}", plugins));
  return {file, header, axes_of(device),
          schema::RecordingWriter::Options{
              .measures_force = device.measures_force, .channels = channels_of(device), .replace = replace}};
}

std::string missed_in_words(const LoopReport& report) {
  std::string text = fmt::format("{} deadlines missed in all, charged to", report.missed());
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage) {
    if (report.missed_by[stage] > 0) {
      text += fmt::format(" {} {}", stage_names[stage], report.missed_by[stage]);
    }
  }
  return text;
}

schema::Properties note_figures(Recorder& recorder, const std::vector<drivers::Figure>& figures,
                                double at_s) {
  schema::Properties properties;
  for (const drivers::Figure& figure : figures) {
    const bool counts = figure.unit == "1";
    properties[counts ? figure.name : figure.name + "_" + figure.unit] = figure.value;
    recorder.note({.time_s = at_s,
                   .kind = "device",
                   .text = fmt::format("{} {:.6g}{}{}", figure.name, figure.value, counts ? "" : " ",
                                       counts ? "" : figure.unit)});
  }
  return properties;
}

std::string close_device_recording(Recorder& recorder, const std::filesystem::path& file,
                                   const std::string& status, const schema::Properties& figures) {
  try {
    recorder.close(status, figures);
  } catch (const schema::NameTaken& taken) {
    return taken.what();
  } catch (const std::exception& error) {
    return fmt::format("{}; what was recorded until then is in {}.partial, and 'kerf repair' closes it",
                       error.what(), file.string());
  }
  return {};
}

}  // namespace kerf::bench

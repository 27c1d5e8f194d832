#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording_writer.h>

#include "loop/loop.h"
#include "record/recorder.h"
#include "scene/scene.h"

namespace kerf::bench {

/// Bytes that a row of such a device takes in a recording.
[[nodiscard]] std::size_t recorded_row_bytes(const drivers::DeviceInfo& device);

/// Begins the file of what a device does: a header that names device, configuration and scene, its axes and
/// channels; in its history which laws of plug-ins were rendered.
/// @throws std::invalid_argument, std::system_error as schema::RecordingWriter does.
[[nodiscard]] schema::RecordingWriter begin_device_recording(const std::filesystem::path& file,
                                                             const drivers::DeviceInfo& device,
                                                             const std::optional<Scene>& scene, bool replace,
                                                             std::string_view plugins = {});

/// How many deadlines a run missed, and by which stages: the text of an event.
[[nodiscard]] std::string missed_in_words(const LoopReport& report);

/// Notes what a device counted as events of kind "device"; returns it as attributes of the recording.
[[nodiscard]] schema::Properties note_figures(Recorder& recorder, const std::vector<drivers::Figure>& figures,
                                              double at_s);

/// Closes a recording. Returns why it could not be written to its end and what is left then; empty if it
/// could.
[[nodiscard]] std::string close_device_recording(Recorder& recorder, const std::filesystem::path& file,
                                                 const std::string& status,
                                                 const schema::Properties& figures = {});

}  // namespace kerf::bench

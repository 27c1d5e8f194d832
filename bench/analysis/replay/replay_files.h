#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "replay/open_loop.h"
#include "replay/path.h"
#include "replay/path_rendering.h"

namespace kerf::bench {

/// What every law gave on the ticks of a recording: figures and events, not the traces themselves.
[[nodiscard]] nlohmann::ordered_json open_loop_as_json(const Source& source, const OpenLoopResult& result);

/// How well a device was held to a path.
[[nodiscard]] nlohmann::ordered_json path_as_json(const Path& path, const PathReport& report,
                                                  const drivers::DeviceInfo& device);

/// Writes LAW.h5 of every law, replay.json, replay.svg and replay.html into a folder, made where it is not.
/// @throws std::invalid_argument if one of them is there and `replace` is false; std::system_error.
void write_open_loop(const std::filesystem::path& folder, const Source& source, const OpenLoopResult& result,
                     const nlohmann::ordered_json& json, bool replace);

}  // namespace kerf::bench

#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include "laws/law_toml.h"
#include "regress/renderers/outside_renderer.h"

namespace kerf::bench {

/// What of a renderer may stand in [defaults] as well as in a case; `forces` is of a case alone.
inline constexpr std::array<std::string_view, 6> settings_of_renderers{
    "renderer", "axes", "sign", "frame", "quaternion", "compute_time"};

/// What a table says of a renderer that is no law, over what it inherits.
/// @throws std::invalid_argument with file, line, found and expected.
void read_renderer(const Place& place, const toml::table& table, const std::filesystem::path& folder,
                   std::optional<OutsideRenderer>& outside);

}  // namespace kerf::bench

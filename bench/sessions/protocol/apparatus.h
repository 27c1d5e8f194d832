#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "laws/law_toml.h"

namespace kerf::bench {

/// What the subject's page plays while a trial runs, so that the device is not heard.
enum class MaskingNoise : std::uint8_t { none, white, pink };
[[nodiscard]] std::string_view name_of(MaskingNoise noise) noexcept;

/// Something about the set-up that the experimenter confirms before a run.
struct ApparatusItem {
  std::string name;  ///< "headphones", "check 1"
  std::string what;  ///< "closed, over both ears"
};

/// The table [apparatus] of a protocol.
struct Apparatus {
  MaskingNoise noise = MaskingNoise::none;
  std::vector<ApparatusItem> items;
};

/// @throws std::invalid_argument with file, line, found and expected.
[[nodiscard]] Apparatus read_apparatus(const Place& place, const toml::table& root);

}  // namespace kerf::bench

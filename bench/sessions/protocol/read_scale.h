#pragma once

#include "protocol/protocol_parts.h"

// The parts of [scale]. All throw std::invalid_argument with file, line, found and expected.

namespace kerf::bench {

inline constexpr std::size_t max_levels = 200;
inline constexpr double largest_level = 100.0;

/// The law at that level has to exist before a subject sits there.
void require_playable(const Place& place, const toml::node& node, const Protocol& protocol, double level);

/// Levels that are shown, or may be, ascending.
void read_levels(const Place& place, const toml::node& node, Protocol& protocol);

/// [scale.quest], and the levels that QUEST+ may show.
void read_quest(const Place& place, const toml::table& root, const toml::table& scale, Protocol& protocol);

}  // namespace kerf::bench

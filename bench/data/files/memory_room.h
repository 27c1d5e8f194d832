#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace kerf::bench {

/// How many more bytes this process can take: the least of what is left of its own limit (RLIMIT_AS), of its
/// control groups (memory.max), and of the machine (MemAvailable and free swap).
[[nodiscard]] std::uintmax_t memory_room();

/// What is left of the limits of a control group and of those it belongs to, within the mounted tree; the
/// largest number where there are none.
[[nodiscard]] std::uintmax_t memory_room_of_group(const std::filesystem::path& tree, std::string_view group);

/// Asked before `bytes` are taken for `file`: what fails half-way names neither file nor reason, and a
/// machine that swaps or kills takes others down with it.
/// @throws std::system_error (ENOMEM) that says how much is needed for what, and how much there is.
void require_memory(const std::filesystem::path& file, std::uintmax_t bytes, std::string_view needed_for);

}  // namespace kerf::bench

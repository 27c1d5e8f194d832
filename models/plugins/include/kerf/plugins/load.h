#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include <kerf/models/foreign.h>

/// Laws of shared objects (kerf/law.h).
namespace kerf::plugins {

/// What a short trial of a law found.
struct Trial {
  double step_s = 0.0;    ///< the median of its steps, with its initial parameters
  std::size_t steps = 0;  ///< that were tried
  std::optional<std::size_t>
      allocations;  ///< of memory, in these steps; nothing where nobody could count them
};

struct Plugin {
  const models::ForeignLaw* law = nullptr;
  Trial trial;
};

/// Loads a law into this program for the rest of its life, after kerf-law-trial has opened the file, checked
/// what it says and stepped it: whatever the file does there, it does to that process. From then on a crash
/// in its code ends this program with one line that names the file, and exit status 4; so do a call of exit()
/// and a step that does not come back for `patience`, as the first plug-in was loaded with. To be called at
/// set-up, before there are other threads that make laws.
/// @param sha256 of the file's content
/// @throws std::invalid_argument in one line that says what is wrong with it.
/// @throws std::system_error where kerf-law-trial cannot be started.
Plugin load(const std::filesystem::path& file, const std::string& sha256,
            std::chrono::milliseconds patience = std::chrono::seconds(5));

/// The trial alone. A plug-in that gives no sign for `patience` is given up. @throws as load() does.
[[nodiscard]] Trial try_law(const std::filesystem::path& file,
                            std::chrono::milliseconds patience = std::chrono::seconds(5));

}  // namespace kerf::plugins

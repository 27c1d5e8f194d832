#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "segment/result_state.h"

namespace kerf::bench {

/// What a verb has found out.
enum class ResultKind : std::uint8_t { inspection, fits, choice, chart, stability, device, replay, check };

/// "kerf choose", which makes one.
[[nodiscard]] std::string_view verb_of(ResultKind kind) noexcept;

/// What a result says of whose it is. That of a device is of no recording.
enum class Belongs : std::uint8_t { here, elsewhere, unknown };

/// The JSON of a verb, as it was found.
struct FoundResult {
  ResultKind kind = ResultKind::fits;
  std::filesystem::path file;
  std::string name;  ///< of the file, as a page has it
  nlohmann::ordered_json json;
  Belongs belongs = Belongs::unknown;        ///< to the recording, or a law that was fitted to it
  ResultState state = ResultState::unknown;  ///< of the recording: tell_states()

  /// Of this recording, and of the state that it is in now, as far as it says.
  [[nodiscard]] bool is_of_now() const noexcept { return belongs == Belongs::here && !is_outdated(state); }
};

/// Reads results by their paths: a JSON that one of the verbs has written, or a folder that is looked
/// through, itself and two folders down, for such of this recording. Which verb wrote one is told by its
/// keys, so that names do not matter. In the order of the verbs above, those of a kind in the order in which
/// they were found. `uuid` is the recording's.
/// @throws std::invalid_argument for a file that is none, or a folder without any.
[[nodiscard]] std::vector<FoundResult> find_results(const std::vector<std::filesystem::path>& paths,
                                                    const std::string& uuid);

/// The UUIDs of the recordings that a result says it is of, fits of several with all of theirs; none where it
/// says nothing, or cannot be read. Reads no further than it has to: of thousands, a list is made.
[[nodiscard]] std::vector<std::string> recordings_of(const std::filesystem::path& file);

/// A JSON file. @throws std::invalid_argument that names it.
[[nodiscard]] nlohmann::ordered_json read_result(const std::filesystem::path& file);

}  // namespace kerf::bench

#include "run/kept_recording.h"

#include <exception>

#include "files/named_file.h"

namespace kerf::bench {

std::optional<StudiedRecording> kept_recording(const std::filesystem::path& folder, const std::string& key) {
  try {
    StudiedRecording kept = studied_recording(
        nlohmann::ordered_json::parse(read_named_file(folder / "result.json", LargestInput::table)));
    if ((key.empty() || kept.key == key) && std::filesystem::exists(folder / "recording.h5")) return kept;
  } catch (const std::exception&) {
    return std::nullopt;  // none, or one that is made anew
  }
  return std::nullopt;
}

}  // namespace kerf::bench

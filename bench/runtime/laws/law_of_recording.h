#pragma once

#include <nlohmann/json.hpp>

#include "laws/law_file.h"

namespace kerf::bench {

/// The identifier of the recording that a law was fitted to, as the key `law_of_recording` of a result has
/// it; null where the law file names none.
[[nodiscard]] inline nlohmann::ordered_json law_of_recording(const LawFile& law) {
  const std::string& uuid = law.fit.recording_uuid;
  return uuid.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(uuid);
}

}  // namespace kerf::bench

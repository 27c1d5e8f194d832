#pragma once

#include <filesystem>
#include <string>

#include <kerf/schema/session.h>

#include "sealed/seal.h"

namespace kerf::bench {

/// To be called before anything under the seal of a session is shown. Of a finished session it does nothing;
/// before its end it notes the opening with its reason in the file.
/// @throws std::invalid_argument: not finished and no reason given; as SessionStore does.
void record_opening(const std::filesystem::path& file, const SealKey& key, const std::string& reason);

/// Nobody sat at it: `kerf session run --rehearse`.
[[nodiscard]] bool was_rehearsed(const schema::Session& session);

}  // namespace kerf::bench

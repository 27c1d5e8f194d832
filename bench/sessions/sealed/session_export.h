#pragma once

#include <filesystem>

#include "sealed/session_store.h"

namespace kerf::bench {

/// Writes a session that is open to all into a folder, which is made if there is none: FOLDER/trials.csv, a
/// row a trial with what was played and answered, and FOLDER/trial-001.h5, ... as recordings (kerf.recording)
/// with an event where what plays changed. A trial without ticks has no recording. FOLDER/slots.csv has a row
/// a slot with what was felt; where the protocol asks a questionnaire, FOLDER/questionnaire.csv a row an item
/// with its score.
/// @throws std::invalid_argument: a file is there and not `replace`; std::system_error.
void export_session(const SessionStore& store, const std::filesystem::path& folder, bool replace);

}  // namespace kerf::bench

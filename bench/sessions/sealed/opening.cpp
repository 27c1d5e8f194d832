#include "sealed/opening.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

#include "sealed/session_store.h"

namespace kerf::bench {

void record_opening(const std::filesystem::path& file, const SealKey& key, const std::string& reason) {
  if (SessionStore(file, key, SessionStore::Purpose::read).finished()) return;
  if (reason.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw std::invalid_argument(
        fmt::format("{}: the session is not finished; to open it early say why with --reason, and the file "
                    "will keep that",
                    file.string()));
  }
  SessionStore store(file, key, SessionStore::Purpose::run);
  store.note("opened", reason);
  store.close();
}

bool was_rehearsed(const schema::Session& session) {
  return std::ranges::any_of(session.entries, [](const auto& entry) { return entry.kind == "rehearsal"; });
}

}  // namespace kerf::bench

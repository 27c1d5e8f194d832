#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/apparatus.h"
#include "sealed/session_store.h"

// What of the set-up was confirmed, and how loud the noise was, in the entries "apparatus" and "noise" of a
// session. They tell nothing of the order, and stand in the chain of the seals with their times.

namespace kerf::bench {

/// By the items' names: it is so, or it is not. What is not in it nobody has said.
using Confirmations = std::map<std::string, bool>;

/// "headphones=yes", "check 1=no". @throws std::invalid_argument: another form, or no item of the protocol.
[[nodiscard]] Confirmations confirmations_in(const std::vector<std::string>& given,
                                             const Apparatus& apparatus);

/// Notes what was confirmed, item by item; nothing of a protocol without items. @throws std::system_error.
void record_apparatus(SessionStore& store, const Confirmations& confirmed);
void record_noise_level(SessionStore& store, double level_db);

/// The level that was set in an earlier run; none: not yet.
[[nodiscard]] std::optional<double> noise_level_of(const schema::Session& session);

/// How often an item was confirmed, denied and left open, over the runs of sessions.
struct ConfirmedItem {
  ApparatusItem item;
  std::size_t yes = 0;
  std::size_t no = 0;
  std::size_t unknown = 0;  ///< also of runs that recorded nothing
};
[[nodiscard]] std::vector<ConfirmedItem> confirmed_items(const std::vector<const SessionStore*>& sessions);

}  // namespace kerf::bench

#include "loop/events.h"

#include <string>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr double quiet_s = 0.25;

std::string text_of(const schema::FlagInfo& flag, std::uint64_t missing) {
  if (missing > 0 && (flag.flag == schema::flag_missed_deadline || flag.flag == schema::flag_rows_lost)) {
    return fmt::format("{} not in the file: {}",
                       missing == 1 ? "1 tick is" : fmt::format("{} ticks are", missing), flag.meaning);
  }
  return std::string(flag.meaning);
}

}  // namespace

void EventFinder::process_flags(const schema::Row& row, std::vector<schema::Event>& events) {
  const std::uint64_t missing = row.tick > last_tick_ ? row.tick - last_tick_ - 1 : 0;
  for (std::size_t i = 0; i < schema::flag_table.size(); ++i) {
    const schema::FlagInfo& flag = schema::flag_table[i];
    if ((row.flags & flag.flag) == 0) continue;
    if (row.time_s - last_seen_s_[i] > quiet_s) {
      events.push_back(
          {.time_s = row.time_s, .kind = std::string(flag.name), .text = text_of(flag, missing)});
    }
    last_seen_s_[i] = row.time_s;
  }
}

}  // namespace kerf::bench

#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Makes the events of a recording out of the flags of its rows, away from the tick: one when something
/// begins, and the next only after it was gone for a quarter of a second, so that a force that hovers at its
/// limit does not fill the file.
class EventFinder {
 public:
  /// Rows in their order. Appends what begins with this one.
  void process(const schema::Row& row, std::vector<schema::Event>& events) {
    if (row.flags != 0) process_flags(row, events);
    last_tick_ = row.tick;
  }

 private:
  void process_flags(const schema::Row& row, std::vector<schema::Event>& events);

  static constexpr double never = -std::numeric_limits<double>::infinity();
  std::uint64_t last_tick_ = 0;
  std::array<double, schema::flag_table.size()> last_seen_s_ = [] {
    std::array<double, schema::flag_table.size()> seen{};
    seen.fill(never);
    return seen;
  }();
};

}  // namespace kerf::bench

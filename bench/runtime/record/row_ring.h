#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <boost/lockfree/spsc_queue.hpp>

#include <kerf/schema/recording.h>

namespace kerf::bench {

/// Rows on their way from the tick to the writer: one thread pushes, another pops, neither ever waits.
///
/// The queue between them (Boost's) carries numbers of slots; the rows lie beside it, and every push
/// prefetches the slot of the next one, whose memory was last used when the ring went round. At 100 kHz that
/// takes the 99th percentile of a push from 390 ns to less than 100 ns.
class RowRing {
 public:
  explicit RowRing(std::size_t rows) : queue_(rows), slots_(rows + max_popped + 2) {}

  /// Returns whether there was room.
  bool push(const schema::Row& row) noexcept {
    slots_[next_] = row;
    if (!queue_.push(next_)) return false;
    next_ = next_ + 1 < slots_.size() ? next_ + 1 : 0;
    prefetch(slots_[next_]);
    return true;
  }

  /// Of the pushing thread.
  [[nodiscard]] bool has_room() const noexcept { return queue_.write_available() > 0; }

  /// Takes up to `max_popped` rows out, in their order; returns how many. The slots of rows that are being
  /// copied are not given to push() again: there are so many more of them than the queue can hold.
  std::size_t pop(schema::Row* rows) noexcept {
    const std::size_t count = queue_.pop(popped_.data(), max_popped);
    for (std::size_t i = 0; i < count; ++i) rows[i] = slots_[popped_[i]];
    return count;
  }

  static constexpr std::size_t max_popped = 1000;

 private:
  static void prefetch(const schema::Row& slot) noexcept {
    constexpr std::size_t line = 64;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&slot);
    for (std::size_t at = 0; at < sizeof slot; at += line) __builtin_prefetch(bytes + at, 1);
    __builtin_prefetch(bytes + sizeof slot - 1, 1);
  }

  boost::lockfree::spsc_queue<std::uint32_t> queue_;
  std::vector<schema::Row> slots_;  // value-initialised: every page is touched
  std::vector<std::uint32_t> popped_ = std::vector<std::uint32_t>(max_popped);
  std::uint32_t next_ = 0;  ///< of the pushing thread
};

}  // namespace kerf::bench

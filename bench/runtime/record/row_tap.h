#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include <kerf/schema/recording.h>

#include "record/row_ring.h"

namespace kerf::bench {

/// Rows out of the tick, for one other thread: a RowRing that tells of what it lost. push() never waits. A
/// row that finds no room is lost and counted, and the next that finds room carries the flag rows_lost.
class RowTap {
 public:
  explicit RowTap(std::size_t rows) : ring_(rows) {}

  void push(const schema::Row& row) noexcept {
    if (lost_here_) return push_after_loss(row);
    if (!ring_.push(row)) lose();
  }

  /// Whether the next row finds room; of the pushing thread.
  [[nodiscard]] bool has_room() const noexcept { return ring_.has_room(); }

  /// Takes up to RowRing::max_popped rows out, in their order; returns how many.
  std::size_t pop(schema::Row* rows) noexcept { return ring_.pop(rows); }

  /// Rows that found no room.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  void push_after_loss(schema::Row row) noexcept {
    row.flags |= schema::flag_rows_lost;
    lost_here_ = !ring_.push(row);
    if (lost_here_) lose();
  }
  void lose() noexcept {
    lost_here_ = true;
    lost_.fetch_add(1, std::memory_order_relaxed);
  }

  RowRing ring_;
  bool lost_here_ = false;  ///< of the pushing thread: rows were lost since the last one that found room
  std::atomic<std::uint64_t> lost_{0};
};

}  // namespace kerf::bench

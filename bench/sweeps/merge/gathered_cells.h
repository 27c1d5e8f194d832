#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "files/mapped_file.h"
#include "plan/plan_file.h"
#include "run/cell_records.h"
#include "run/shard_file.h"
#include "run/shard_lock.h"

namespace kerf::bench {

/// A shard's file that was found.
struct FoundShard {
  std::filesystem::path file;
  ShardContent content;
  bool complete = false;
  std::uint64_t computed = 0;  ///< cells
  std::uint64_t failed = 0;
  LockHolder holder;  ///< who computes it; without a host: nobody
};

/// The files of shards in a folder, and in its folders of a thousand each, in the order of their names.
[[nodiscard]] std::vector<std::filesystem::path> shard_files_in(const std::filesystem::path& folder);

/// All that shards of a plan know of its cells, whatever their number, order and restarts: of each cell where
/// its record stands. Files stay mapped, and records are read where they are asked for.
class GatheredCells {
 public:
  /// @throws std::invalid_argument for a folder that is not there, or a shard of another plan or that is
  ///         damaged.
  GatheredCells(const PlanFile& plan, const std::filesystem::path& folder);

  [[nodiscard]] const std::vector<FoundShard>& shards() const noexcept { return shards_; }
  /// Of every shard, each once.
  [[nodiscard]] const std::set<std::string>& software() const noexcept { return software_; }
  [[nodiscard]] const std::map<std::uint64_t, CellLayout>& layouts() const noexcept { return layouts_; }
  [[nodiscard]] std::uint64_t cells() const noexcept { return places_.size(); }
  [[nodiscard]] bool has(std::uint64_t cell) const noexcept { return places_[cell].file != nowhere; }
  /// ComputedCell or FailedCell.
  [[nodiscard]] CellRecord record(std::uint64_t cell) const;
  [[nodiscard]] std::uint64_t computed() const noexcept { return computed_; }
  [[nodiscard]] std::uint64_t failed() const noexcept { return failed_; }
  [[nodiscard]] std::uint64_t missing() const noexcept { return cells() - computed_ - failed_; }
  /// Cells that two shards computed to other numbers, as processors of two kinds may.
  [[nodiscard]] const std::set<std::uint64_t>& different() const noexcept { return different_; }
  /// The largest share of a number by which they differ; infinite where they do in what is known.
  [[nodiscard]] double largest_difference() const noexcept { return largest_difference_; }

 private:
  static constexpr std::uint32_t nowhere = 0xffffffffU;
  struct RecordPlace {
    std::uint64_t at = 0;
    std::uint32_t file = nowhere;
    bool computed = false;
  };

  /// The bytes of a shard. One that is not complete is read at once: who goes on with it may cut off its end.
  class Bytes {
   public:
    Bytes(const std::filesystem::path& file, bool complete);
    [[nodiscard]] std::string_view text() const noexcept { return mapped_ ? mapped_->text() : read_; }

   private:
    std::unique_ptr<MappedFile> mapped_;
    std::string read_;
  };

  void take(const PlanFile& plan, FoundShard shard);
  void take_cell(std::uint64_t cell, const RecordPlace& place, const CellRecord& record);
  void note_difference(std::uint64_t cell, const ComputedCell& one, const ComputedCell& other);
  [[nodiscard]] CellRecord record_at(const RecordPlace& place) const;

  std::vector<FoundShard> shards_;
  std::deque<Bytes> files_;
  std::set<std::string> software_;
  std::map<std::uint64_t, CellLayout> layouts_;
  std::vector<RecordPlace> places_;
  std::uint64_t computed_ = 0;
  std::uint64_t failed_ = 0;
  std::set<std::uint64_t> different_;
  double largest_difference_ = 0.0;
};

/// "3,7,12-14": numbers in order, as arrays of a queue are asked for.
[[nodiscard]] std::string as_ranges(const std::vector<std::uint64_t>& numbers);

}  // namespace kerf::bench

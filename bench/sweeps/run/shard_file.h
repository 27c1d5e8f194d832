#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/processes/helper.h>

#include "plan/plan_file.h"
#include "run/cell_records.h"

namespace kerf::bench {

/// Which part of a sweep: the one that begins at shard / shards of its cells.
struct ShardName {
  std::uint64_t shard = 0;
  std::uint64_t shards = 1;

  /// "3-of-100.shard". Where there are more than a thousand, they stand in folders of a thousand each.
  [[nodiscard]] std::filesystem::path place_in(const std::filesystem::path& folder) const;
  /// "shard 3 of 100"
  [[nodiscard]] std::string in_words() const;
};

/// Its name while cells are missing: NAME.partial.
[[nodiscard]] std::filesystem::path partial_shard(std::filesystem::path place);

/// What stands in a shard's file.
struct ShardContent {
  std::string plan_sha256;
  std::string software;
  ShardName name;
  std::uintmax_t whole_bytes = 0;  ///< up to the end of the last whole frame
  std::uintmax_t bytes = 0;        ///< of the file
};

/// Goes through the records in the bytes of a shard's file. `at`: where the frame of one begins.
/// @throws std::invalid_argument, with the name of the file, if its beginning is that of no shard.
ShardContent read_shard(std::string_view bytes, const std::filesystem::path& file,
                        const std::function<void(const CellRecord&, std::uintmax_t at)>& take);
/// The same of a file that nobody changes meanwhile; records look into memory that is there for the call
/// alone.
ShardContent read_shard(const std::filesystem::path& file,
                        const std::function<void(const CellRecord&, std::uintmax_t at)>& take);

/// A shard's file that grows. It takes its final name once all its cells are in it.
class ShardWriter {
 public:
  /// Begins the file, or goes on with one that a run before left: what is not whole at its end is cut off.
  /// `take` is told its records.
  /// @throws std::invalid_argument for a file of another plan, shard or version; std::system_error.
  ShardWriter(const PlanFile& plan, const ShardName& name, const std::filesystem::path& place,
              const std::function<void(const CellRecord&)>& take);

  /// Frames of cells, in one write. @throws std::system_error: then the file ends where it ended before.
  void append(std::string_view frames);
  /// A layout, where it is not yet in the file.
  void require_layout(std::uint64_t layout, std::string_view text);
  /// Waits until all is on the disk. @throws std::system_error
  void synchronise();
  /// Synchronises and gives the file its final name. @throws std::system_error
  void finish();
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  void begin(const PlanFile& plan, const ShardName& name);
  void go_on(const PlanFile& plan, const ShardName& name, const std::function<void(const CellRecord&)>& take);

  std::filesystem::path place_;
  std::filesystem::path path_;
  processes::Descriptor descriptor_;
  std::uintmax_t bytes_ = 0;
  std::set<std::uint64_t> layouts_;
  bool synchronised_ = true;
};

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>

#include "atlas/sweep_atlas.h"

namespace kerf::bench {

/// The sweeps that are looked at: two at most, the one that was not asked for for longest goes. One that was
/// merged anew is opened again. For any thread.
class OpenSweeps {
 public:
  static constexpr std::size_t most = 2;

  /// @param verbs that they may be of
  explicit OpenSweeps(SweepVerbs verbs) : verbs_(verbs) {}

  /// @throws as SweepAtlas.
  [[nodiscard]] std::shared_ptr<SweepAtlas> opened(const std::filesystem::path& file);

 private:
  struct Open {
    std::filesystem::path file;
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type modified;
    std::shared_ptr<SweepAtlas> atlas;
  };

  SweepVerbs verbs_;
  std::mutex mutex_;
  std::list<Open> open_;  ///< the one asked for last comes first
};

}  // namespace kerf::bench

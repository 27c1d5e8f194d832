#include "sweeps/open_sweeps.h"

#include <algorithm>

namespace kerf::bench {

std::shared_ptr<SweepAtlas> OpenSweeps::opened(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  const std::uintmax_t bytes = std::filesystem::file_size(file);
  const auto modified = std::filesystem::last_write_time(file);
  const auto found = std::ranges::find(open_, file, &Open::file);
  if (found != open_.end() && found->bytes == bytes && found->modified == modified) {
    open_.splice(open_.begin(), open_, found);
    return open_.front().atlas;
  }
  if (found != open_.end()) open_.erase(found);
  open_.push_front({.file = file,
                    .bytes = bytes,
                    .modified = modified,
                    .atlas = std::make_shared<SweepAtlas>(file, verbs_)});
  if (open_.size() > most) open_.pop_back();
  return open_.front().atlas;
}

}  // namespace kerf::bench

#include "views/recording_views.h"

#include <algorithm>
#include <utility>

namespace kerf::bench {

RecordingViews::RecordingViews(ViewCache cache, std::size_t max_bytes)
    : cache_(std::move(cache)), max_bytes_(max_bytes) {}

std::shared_ptr<RecordingView> RecordingViews::current(const std::filesystem::path& file) {
  return find(file, false);
}

std::shared_ptr<RecordingView> RecordingViews::opened(const std::filesystem::path& file) {
  return find(file, true);
}

std::shared_ptr<RecordingView> RecordingViews::find(const std::filesystem::path& file, bool may_be_older) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(open_.begin(), open_.end(), [&](const Open& it) { return it.file == file; });
  if (found != open_.end()) {
    const FileFacts& then = found->view->facts();
    const FileFacts now = FileFacts::of(file);
    if (then == now || (may_be_older && found->view->file().is_live() && then.inode == now.inode)) {
      open_.splice(open_.begin(), open_, found);
      close_oldest();
      return open_.front().view;
    }
    open_.erase(found);
  }
  open_.push_front({.file = file, .view = std::make_shared<RecordingView>(file, cache_)});
  close_oldest();
  return open_.front().view;
}

void RecordingViews::close_oldest() {
  std::size_t bytes = 0;
  std::size_t count = 0;
  for (auto it = open_.begin(); it != open_.end(); ++it) {
    bytes += it->view->bytes();
    if (++count == 1 || (count <= max_open && bytes <= max_bytes_)) continue;
    open_.erase(it, open_.end());
    return;
  }
}

}  // namespace kerf::bench

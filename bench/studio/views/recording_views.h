#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>

#include "views/recording_view.h"

namespace kerf::bench {

/// The recordings that are looked at: at most 8, and at most so much memory for their pyramids; the one that
/// was not asked for for longest goes. May be used by several threads.
class RecordingViews {
 public:
  static constexpr std::size_t max_open = 8;

  explicit RecordingViews(ViewCache cache = ViewCache(ViewCache::usual_folder()),
                          std::size_t max_bytes = std::size_t{256} << 20U);

  /// As the file is now: opened again if it has changed. @throws as RecordingView.
  [[nodiscard]] std::shared_ptr<RecordingView> current(const std::filesystem::path& file);
  /// As current(), but a recording that is still written stays as it was when it was opened, so that its
  /// rows and times stay what they were told to be.
  [[nodiscard]] std::shared_ptr<RecordingView> opened(const std::filesystem::path& file);

 private:
  struct Open {
    std::filesystem::path file;
    std::shared_ptr<RecordingView> view;
  };

  std::shared_ptr<RecordingView> find(const std::filesystem::path& file, bool may_be_older);
  void close_oldest();

  ViewCache cache_;
  std::size_t max_bytes_;
  std::mutex mutex_;
  std::list<Open> open_;  ///< the one asked for last comes first
};

}  // namespace kerf::bench

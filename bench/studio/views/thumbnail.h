#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>

#include "views/rows/view_cache.h"

namespace kerf::bench {

/// Recordings in small, for a list: the measured force (else the commanded one, else the position) along the
/// axis of the cycles, in at most 64 columns. Of a column the first 8,192 rows are looked at, so that a file
/// of any length takes no longer than one of half a million rows, which is seen whole; of a longer one peaks
/// may be missed: it is a picture to know a recording by, not to judge it. Beside it how many cycles the file
/// has, and how many of them it says are not good.
class Thumbnails {
 public:
  static constexpr std::size_t columns = 64;
  static constexpr std::size_t rows_a_column = 8192;

  /// As JSON; kept until the file changes. May be asked by several threads. @throws as schema::RecordingFile.
  [[nodiscard]] std::string of(const std::filesystem::path& file);

 private:
  struct Kept {
    FileFacts facts;
    std::string json;
  };
  std::mutex mutex_;
  std::map<std::filesystem::path, Kept> kept_;
};

}  // namespace kerf::bench

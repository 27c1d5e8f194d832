#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <kerf/processes/helper.h>

namespace kerf::bench {

/// Who has a shard.
struct LockHolder {
  std::string host;
  std::string boot;  ///< of its machine, and the name space of its processes
  long process = 0;
  std::string started;     ///< of that process, as the kernel counts
  std::string job;         ///< of Slurm; empty: none
  unsigned long beat = 0;  ///< grows while it lives

  [[nodiscard]] std::string as_text() const;
  [[nodiscard]] static LockHolder from_text(const std::string& text);
  /// "process 1234 on node7 (job 55_3)"
  [[nodiscard]] std::string in_words() const;
};

/// That nobody else computes a shard: NAME.lock beside it, which says who has it.
///
/// File systems of clusters have locks that are emulated, slow or switched off, so this needs none: the file
/// comes by link(), which is one step everywhere. Its holder writes a count into it every `beat`. It is stale
/// if its process is seen to be gone from this machine; on another machine, if the count stood still for
/// `silence` by the clock of who looks, so that clocks of machines need not agree. Where the system has locks
/// of files, the shard's file is locked too, and that decides at once.
class ShardLock {
 public:
  struct Options {
    std::chrono::milliseconds silence{60'000};
    std::chrono::milliseconds beat{15'000};
    std::function<bool()> stopped = [] { return false; };  ///< asked while it is waited
    std::function<void(const std::string& line)> tell = [](const std::string&) {};
  };

  /// `guarded`: the shard's file while it grows, which is made here if it is not there.
  /// @throws std::invalid_argument if somebody has it, saying who; std::system_error, also if it was stopped.
  ShardLock(const std::filesystem::path& place, const std::filesystem::path& guarded, Options options);
  ShardLock(const ShardLock&) = delete;
  ShardLock& operator=(const ShardLock&) = delete;
  ~ShardLock();

  /// To be called often; writes when it is time to.
  /// @throws std::system_error if somebody took it for stale.
  void keep();

  [[nodiscard]] static std::filesystem::path path_of(std::filesystem::path place);
  /// Who has a shard; without a host: nobody.
  [[nodiscard]] static LockHolder holder_of(const std::filesystem::path& place);

 private:
  enum class Guarded : std::uint8_t { existing, made };
  bool guard(const std::filesystem::path& guarded, Guarded how);
  void give_back() const noexcept;
  [[nodiscard]] bool take();
  void wait_until_stale(const std::string& seen);
  void remove_stale(const std::string& seen) const;
  [[noreturn]] void refuse(const LockHolder& holder) const;
  [[nodiscard]] bool is_ours() const noexcept;

  std::filesystem::path path_;
  Options options_;
  LockHolder self_;
  processes::Descriptor guard_;
  processes::Descriptor file_;
  std::chrono::steady_clock::time_point last_beat_;
};

}  // namespace kerf::bench

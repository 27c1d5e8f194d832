#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// Writes texts to file descriptors, in their order, from a thread of its own. Whoever prints beside a loop
/// neither waits for a terminal whose output is stopped nor fails with it: that holds up this thread alone.
/// Where there is no thread to be had it writes at once.
class AsideWriter {
 public:
  AsideWriter();
  AsideWriter(const AsideWriter&) = delete;
  AsideWriter& operator=(const AsideWriter&) = delete;
  /// Waits for nothing, and drops what waits: a thread that hangs in a write is left to the end of the
  /// process.
  ~AsideWriter();

  void write(int descriptor, std::string_view text) noexcept;
  /// As write(), but a text that would have to wait is dropped, and nobody misses it: for what is drawn
  /// again.
  void draw(int descriptor, std::string_view text) noexcept;
  /// Waits until everything is written or has failed. @returns false if that takes longer than `at_most`.
  [[nodiscard]] bool wait(std::chrono::milliseconds at_most);
  void wait() noexcept;

  /// errno of the first write to a descriptor that failed; 0: none did.
  [[nodiscard]] int failure(int descriptor) const noexcept;
  /// The texts of write() to a descriptor that failed or still wait.
  [[nodiscard]] std::vector<std::string> unwritten(int descriptor) const;

 private:
  struct State;
  std::shared_ptr<State> state_;  ///< also the thread's, which may outlive this
};

}  // namespace kerf::bench

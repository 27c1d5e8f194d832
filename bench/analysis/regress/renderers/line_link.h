#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

#include "regress/renderers/child_program.h"

namespace kerf::bench {

/// Lines of text to a program and back, while what else it says is kept from filling up.
class LineLink {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Outcome {
    done,
    late,     ///< nothing until the deadline
    ended,    ///< the program has, whoever else may hold the other end
    closed,   ///< the program goes on, and will not answer any more
    endless,  ///< more than `longest_line` bytes without an end of line
  };
  static constexpr std::size_t longest_line = 65536;

  /// Descriptors of the caller's, which are made non-blocking.
  LineLink(ChildProgram& program, int reads, int writes);

  [[nodiscard]] Outcome send(std::string_view text, Clock::time_point deadline);
  /// The next line without its end; it stands until the next call.
  [[nodiscard]] Outcome receive(std::string_view& line, Clock::time_point deadline);
  /// Whether something came behind the last line that was received.
  [[nodiscard]] bool more_came() const noexcept { return buffer_.size() > taken_; }
  /// Waits until the program has ended.
  [[nodiscard]] Outcome wait_for_end(Clock::time_point deadline);

 private:
  enum class Waited { nothing, text, room, end };
  Waited wait(bool for_room, Clock::time_point deadline);
  [[nodiscard]] Outcome gone();

  ChildProgram& program_;
  int reads_;
  int writes_;
  std::string buffer_;
  std::size_t taken_ = 0;
  bool closed_ = false;
};

}  // namespace kerf::bench

#pragma once

#include <chrono>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <poll.h>
#include <sys/types.h>

#include <kerf/processes/program.h>

namespace kerf::bench {

/// What a renderer did wrong, in one line, and what it said besides.
class RendererError : public std::invalid_argument {
 public:
  RendererError(const std::string& what, std::string said)
      : std::invalid_argument(what), said_(std::move(said)) {}
  /// The last lines of its standard error, as last_lines() gives them.
  [[nodiscard]] const std::string& said() const noexcept { return said_; }

 private:
  std::string said_;
};

using processes::Descriptor;

/// A pipe, of this process alone until an end is handed on. @throws std::system_error.
struct Pipe {
  Pipe();
  Descriptor reads;
  Descriptor writes;
};

/// What a program says on one of its streams, of which the end is kept.
class SaidStream {
 public:
  SaidStream();
  /// Takes what is there; false at its end.
  bool take();
  /// What is still in the pipe, and no more: whoever holds the other end may go on writing.
  void take_rest();
  [[nodiscard]] const std::string& said() const noexcept { return said_; }
  [[nodiscard]] Pipe& pipe() noexcept { return pipe_; }

 private:
  Pipe pipe_;
  std::string said_;
};

/// A program of somebody else while it runs, in a process group of its own, which is killed at the end of its
/// scope at the latest. A process that leaves the group (setsid) is not found; nobody waits for it.
class ChildProgram {
 public:
  struct Start {
    std::vector<std::string> command;  ///< the program, also one found along PATH, and its arguments
    std::filesystem::path folder;      ///< where it runs; empty: here
    int input = -1;                    ///< its standard input; -1: /dev/null
    int output = -1;                   ///< its standard output; -1: said on `output`
  };
  /// @throws std::invalid_argument if it cannot be started; std::system_error.
  explicit ChildProgram(const Start& start);
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;
  ~ChildProgram();

  /// Keeps what it says until one of the others is ready, it has ended or the deadline is over.
  /// @param others at most two; their `revents` are set
  /// @returns whether the program has ended; its group may go on
  bool wait(std::span<pollfd> others, std::chrono::steady_clock::time_point deadline);
  /// Kills the group, takes what was said last. @returns the program's status as of waitpid().
  int kill_group() noexcept;
  /// The last line that it said, as the end of a message.
  [[nodiscard]] std::string last_words() const;

  SaidStream output;
  SaidStream errors;

 private:
  pid_t process_;
  Descriptor ended_;
  bool reaped_ = false;
  int status_ = 0;
};

/// The last lines that a program said: at most 20, each as in_print() has it.
[[nodiscard]] std::string last_lines(std::string_view said);

/// The begin of what a program said, for a message: on one line, in UTF-8, without control characters.
[[nodiscard]] std::string in_print(std::string_view said);

/// "ended with status 3", "was ended by signal 11 (SIGSEGV)".
[[nodiscard]] std::string end_in_words(int status);

}  // namespace kerf::bench

#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include <sys/ioctl.h>
#include <termios.h>

#include "host/aside_writer.h"
#include "subject/subject.h"
#include "subject/subject_keys.h"

namespace kerf::bench {

/// The subject at a terminal: a screen of its own and single keys (SubjectKeys). The terminal is as it was
/// before when this ends.
///
/// Where input or output is no terminal, or TERM is "dumb" (scripts, screen readers, braille lines), the
/// screens come as plain lines and the actions as lines, command_of(). A line that comes before anything may
/// be done waits for its time; the end of the input is "quit".
class TerminalSubject final : public Subject {
 public:
  explicit TerminalSubject(int input = 0, int output = 1);
  TerminalSubject(const TerminalSubject&) = delete;
  TerminalSubject& operator=(const TerminalSubject&) = delete;
  ~TerminalSubject() override;

  void show(const SubjectView& view) override;
  [[nodiscard]] std::optional<SubjectAction> next() override;

 private:
  void take_input();
  std::optional<SubjectAction> next_key();
  std::optional<char> key_of(char byte);
  std::optional<SubjectAction> next_line();
  bool turns_page(char key);
  [[nodiscard]] winsize size() const;
  [[nodiscard]] bool is_resized() const;
  void draw();
  void write_out(const std::string& text);

  enum class Sequence { none, begun, in_brackets, one_more };  ///< of an escape sequence, such as an arrow's

  int input_;
  int output_;
  std::optional<termios> before_;  ///< of the terminal; none: by lines
  bool shown_ = false;
  bool ended_ = false;
  AsideWriter screen_;  ///< a terminal that has stopped must not stop whoever shows something
  winsize drawn_{};
  std::size_t page_ = 0;  ///< of a text that is longer than the screen
  std::size_t pages_ = 1;
  SubjectView view_;
  SubjectKeys keys_;
  std::deque<char> typed_;
  Sequence sequence_ = Sequence::none;
  std::chrono::steady_clock::time_point escape_at_{};
};

}  // namespace kerf::bench

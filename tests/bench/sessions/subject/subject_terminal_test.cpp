#include "subject/subject_terminal.h"

#include <array>
#include <chrono>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include "subject/subject_keys.h"
#include "views.h"

namespace kerf::bench {
namespace {

using test::in_words;

/// A pseudo terminal with the subject at one end and the test at the other.
class SubjectTerminal : public testing::Test {
 protected:
  SubjectTerminal() {
    setenv("TERM", "xterm", 1);
    winsize size{.ws_row = 24, .ws_col = 60, .ws_xpixel = 0, .ws_ypixel = 0};
    if (openpty(&keyboard_, &terminal_, nullptr, nullptr, &size) != 0)
      throw std::runtime_error("no pseudo terminal");
    fcntl(keyboard_, F_SETFL, O_NONBLOCK);
  }
  ~SubjectTerminal() override {
    close(keyboard_);
    close(terminal_);
  }

  void type(const std::string& keys) const {
    ASSERT_EQ(write(keyboard_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  /// Until the keys have come through the terminal, which takes the system a moment.
  void wait_for_keys() const {
    pollfd polled{.fd = terminal_, .events = POLLIN, .revents = 0};
    ASSERT_EQ(poll(&polled, 1, 10'000), 1);
  }
  std::string action(Subject& subject) {
    for (const auto end = later(); std::chrono::steady_clock::now() < end;) {
      if (const auto it = subject.next()) return in_words(it);
      read_screen();
    }
    return "nothing";
  }
  std::string action_after(Subject& subject, const std::string& keys) {
    type(keys);
    return action(subject);
  }
  /// Lets the subject poll until the screen has the text; no action may come of it.
  bool shows(Subject& subject, const std::string& text) {
    for (const auto end = later(); std::chrono::steady_clock::now() < end;) {
      EXPECT_EQ(in_words(subject.next()), "nothing");
      read_screen();
      if (screen_.find(text) != std::string::npos) {
        screen_.clear();
        return true;
      }
    }
    return false;
  }
  /// The same where nobody polls.
  bool receives(const std::string& text) {
    for (const auto end = later();
         std::chrono::steady_clock::now() < end && screen_.find(text) == std::string::npos;) {
      read_screen();
    }
    return screen_.find(text) != std::string::npos;
  }
  void read_screen() {
    std::array<char, 4096> buffer{};
    for (ssize_t count = 0; (count = read(keyboard_, buffer.data(), buffer.size())) > 0;) {
      screen_.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }
  [[nodiscard]] termios settings() const {
    termios now{};
    tcgetattr(terminal_, &now);
    return now;
  }
  static std::chrono::steady_clock::time_point later() {
    return std::chrono::steady_clock::now() + std::chrono::seconds(10);
  }

  int keyboard_ = -1;
  int terminal_ = -1;
  std::string screen_;
};

TEST_F(SubjectTerminal, IsGivenBackAsItWas) {
  const termios before = settings();
  {
    const TerminalSubject subject(terminal_, terminal_);
    EXPECT_EQ(settings().c_lflag & static_cast<tcflag_t>(ICANON | ECHO), 0U);
    EXPECT_TRUE(receives("\x1b[?1049h"));
  }
  const termios after = settings();
  EXPECT_EQ(after.c_lflag, before.c_lflag);
  EXPECT_EQ(after.c_iflag, before.c_iflag);
  EXPECT_TRUE(receives("\x1b[?25h\x1b[?1049l"));
}

TEST_F(SubjectTerminal, FeelsByLabelsAndNumbersAndAnswersAfterEnter) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::free_trial(5));
  EXPECT_TRUE(shows(subject, "A, B or X: feel it. Enter: answer. Q: stop."));
  EXPECT_EQ(action_after(subject, "b"), "play 1");
  EXPECT_EQ(action_after(subject, "X"), "play 2");
  EXPECT_EQ(action_after(subject, "1"), "play 0");
  type("\r");
  EXPECT_TRUE(shows(subject, "Answer: which? A or B. Escape: not yet."));
  type("x");
  EXPECT_TRUE(shows(subject, "The answer is one of A or B."));
  EXPECT_EQ(action_after(subject, "B"), "answer 1");
}

TEST_F(SubjectTerminal, TakesNoArrowForAnAnswer) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::free_trial(5));
  type("\r");
  EXPECT_TRUE(shows(subject, "Answer: which?"));
  EXPECT_EQ(action_after(subject, "\x1b[A\x1bOB\x1b[1;5Ab"), "answer 1");
}

TEST_F(SubjectTerminal, LetsEscapeTakeEnterBack) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::free_trial(5));
  type("\r");
  EXPECT_TRUE(shows(subject, "Answer: which?"));
  type("\x1b");
  EXPECT_TRUE(shows(subject, "Enter: answer."));
  EXPECT_EQ(action_after(subject, "a"), "play 0");
}

TEST_F(SubjectTerminal, AnswersByTheLabelWhereEachSlotComesByItself) {
  TerminalSubject subject(terminal_, terminal_);
  SubjectView view = test::sequence_trial(5);
  view.may_answer = false;
  subject.show(view);
  type("2");
  EXPECT_TRUE(shows(subject, "You cannot answer yet."));
  view.may_answer = true;
  subject.show(view);
  EXPECT_TRUE(shows(subject, "1, 2 or 3: your answer."));
  EXPECT_EQ(action_after(subject, "3"), "answer 2");
}

TEST_F(SubjectTerminal, DoesNotTakeFeelingForAnsweringWhenTheTimeIsOver) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::free_trial(5));
  SubjectView over = test::free_trial(5);
  over.may_switch = false;
  subject.show(over);
  type("a");
  EXPECT_TRUE(shows(subject, "The time to feel is over. Press Enter to answer."));
  EXPECT_EQ(action_after(subject, "\ra"), "answer 0");
}

TEST_F(SubjectTerminal, ForgetsWhatWasTypedAtAnotherScreen) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::sequence_trial(5));
  type("1");
  wait_for_keys();
  subject.show(test::sequence_trial(6));
  EXPECT_EQ(in_words(subject.next()), "nothing");
  EXPECT_EQ(action_after(subject, "2"), "answer 1");
}

TEST_F(SubjectTerminal, AsksBeforeItStops) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::free_trial(5));
  type("q");
  EXPECT_TRUE(shows(subject, "Stop the session?"));
  EXPECT_EQ(action_after(subject, "n1"), "play 0");
  EXPECT_EQ(action_after(subject, "qy"), "quit");
}

TEST_F(SubjectTerminal, ShowsEveryStageWithItsKeys) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::text_view(SessionStage::welcome, "Sit comfortably."));
  EXPECT_TRUE(shows(subject, "Space: go on."));
  EXPECT_EQ(action_after(subject, " "), "go on");
  subject.show(test::text_view(SessionStage::consent, "You may stop at any time."));
  EXPECT_TRUE(shows(subject, "Space: I agree. D: I do not agree."));
  EXPECT_EQ(action_after(subject, "\rd"), "decline") << "Enter agrees to nothing";
  subject.show(test::text_view(SessionStage::instructions, "Close it slowly."));
  EXPECT_TRUE(shows(subject, "What you will do"));
  EXPECT_EQ(action_after(subject, "\r"), "go on");
  subject.show(test::text_view(SessionStage::feedback, "It was B."));
  EXPECT_TRUE(shows(subject, "It was B."));
  SubjectView rest = test::text_view(SessionStage::pause, "");
  rest.may_go_on = false;
  rest.wait_s = 30.0;
  subject.show(rest);
  EXPECT_TRUE(shows(subject, "You can go on after 30 s."));
  type(" ");
  EXPECT_TRUE(shows(subject, "Not yet."));
  subject.show({.stage = SessionStage::finished});
  EXPECT_TRUE(shows(subject, "Thank you."));
}

TEST_F(SubjectTerminal, HasALongConsentReadToItsEnd) {
  TerminalSubject subject(terminal_, terminal_);
  std::string text;
  for (int line = 0; line < 30; ++line) text += fmt::format("Line {}\n", line);
  subject.show(test::text_view(SessionStage::consent, text));
  type(" ");
  EXPECT_TRUE(shows(subject, "Line 29"));
  EXPECT_EQ(action_after(subject, " "), "go on");
}

TEST_F(SubjectTerminal, DrawsAgainForAnotherWidth) {
  TerminalSubject subject(terminal_, terminal_);
  subject.show(test::text_view(SessionStage::welcome, "one two three four five"));
  EXPECT_TRUE(shows(subject, "one two three four five"));
  winsize narrow{.ws_row = 24, .ws_col = 12, .ws_xpixel = 0, .ws_ypixel = 0};
  ioctl(terminal_, TIOCSWINSZ, &narrow);
  EXPECT_TRUE(shows(subject, "three four\x1b[K"));
}

/// Pipes in place of a terminal.
class SubjectLines : public testing::Test {
 protected:
  SubjectLines() {
    if (pipe2(in_.data(), O_CLOEXEC) != 0 || pipe2(out_.data(), O_CLOEXEC | O_NONBLOCK) != 0) {
      throw std::runtime_error("no pipe");
    }
  }
  ~SubjectLines() override {
    end_input();
    close(in_[0]);
    close(out_[0]);
    close(out_[1]);
  }
  void type(const std::string& text) const {
    ASSERT_EQ(write(in_[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void end_input() {
    if (in_[1] >= 0) close(in_[1]);
    in_[1] = -1;
  }
  /// What is printed is printed by another thread.
  void expect_said(const std::string& expected) const {
    std::string said;
    pollfd readable{.fd = out_[0], .events = POLLIN, .revents = 0};
    constexpr int patience_ms = 20'000;
    while (said.size() < expected.size() && poll(&readable, 1, patience_ms) > 0) {
      std::array<char, 4096> buffer{};
      const ssize_t count = read(out_[0], buffer.data(), buffer.size());
      if (count <= 0) break;
      said.append(buffer.data(), static_cast<std::size_t>(count));
    }
    EXPECT_EQ(said, expected);
  }
  std::array<int, 2> in_{};
  std::array<int, 2> out_{};
};

const std::string free_trial_in_words =
    "Liver\nTrial 5 of 24\nWhich is softer?\nYou feel A now.\nCommands: play A, B or X; answer A or B; "
    "quit.\n";

TEST_F(SubjectLines, AreReadAsCommands) {
  TerminalSubject subject(in_[0], out_[1]);
  subject.show(test::free_trial(5));
  expect_said(free_trial_in_words);
  type("play B\n  PLAY   x\r\nanswer 2\nquit\n");
  for (const char* expected : {"play 1", "play 2", "answer 1", "quit"})
    EXPECT_EQ(in_words(subject.next()), expected);
  subject.show(test::text_view(SessionStage::consent, "You may stop at any time."));
  expect_said("\nYour consent\nYou may stop at any time.\nCommands: agree; decline; quit.\n");
  type("agree\ndecline\ngo on\n");
  for (const char* expected : {"go on", "decline", "go on"}) EXPECT_EQ(in_words(subject.next()), expected);
}

TEST_F(SubjectLines, ThatAreNoCommandAreRefusedInWords) {
  TerminalSubject subject(in_[0], out_[1]);
  subject.show(test::free_trial(5));
  expect_said(free_trial_in_words);
  type("answer X\njump\n\nplay Z\n");
  for (int i = 0; i < 4; ++i) EXPECT_EQ(in_words(subject.next()), "nothing");
  expect_said("Not now.\nNo such command: jump\nNo such command: play Z\n");
}

TEST_F(SubjectLines, WaitForTheirTime) {
  TerminalSubject subject(in_[0], out_[1]);
  SubjectView view = test::sequence_trial(5);
  view.may_answer = false;
  subject.show(view);
  type("answer 3\n");
  EXPECT_EQ(in_words(subject.next()), "nothing");
  view.may_answer = true;
  subject.show(view);
  EXPECT_EQ(in_words(subject.next()), "answer 2");
}

TEST_F(SubjectLines, EndWithQuit) {
  TerminalSubject subject(in_[0], out_[1]);
  subject.show(test::free_trial(5));
  type("play B");
  EXPECT_EQ(in_words(subject.next()), "nothing");
  end_input();
  EXPECT_EQ(in_words(subject.next()), "play 1");
  EXPECT_EQ(in_words(subject.next()), "quit");
}

TEST(SubjectWords, HaveNumbersForKeys) {
  SubjectKeys keys;
  keys.show(test::words_trial(1));
  EXPECT_NE(keys.what_keys_do().find("1 (no, sure), 2 (no, guessing), 3 (yes, guessing) or 4 (yes, sure)"),
            std::string::npos);
  EXPECT_EQ(in_words(keys.press('a')), "nothing") << "a slot is no answer";
  EXPECT_EQ(in_words(keys.press('5')), "nothing");
  EXPECT_EQ(in_words(keys.press('4')), "answer 3");
}

TEST(SubjectWords, AreAnsweredAfterEnterWhereTheSubjectSwitches) {
  SubjectView view = test::words_trial(1);
  view.may_switch = true;
  SubjectKeys keys;
  keys.show(view);
  EXPECT_EQ(in_words(keys.press('1')), "play 0");
  EXPECT_EQ(in_words(keys.press('\r')), "nothing");
  EXPECT_EQ(in_words(keys.press('3')), "answer 2");
}

TEST(SubjectWords, AreTypedInLines) {
  const SubjectView view = test::words_trial(1);
  EXPECT_EQ(in_words(command_of(view, "answer yes, sure")), "answer 3");
  EXPECT_EQ(in_words(command_of(view, "answer 2")), "answer 1");
  EXPECT_EQ(in_words(command_of(view, "play A")), "play 0");
  EXPECT_EQ(in_words(command_of(view, "answer maybe")), "nothing");
}

}  // namespace
}  // namespace kerf::bench

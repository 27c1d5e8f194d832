#include "subject/subject_terminal.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "subject/subject_rules.h"
#include "subject/subject_screen.h"

namespace kerf::bench {
namespace {

using namespace std::chrono_literals;

constexpr auto longest_to_be_drawn = 1000ms;    // by a terminal that has not stopped
constexpr auto longest_within_sequence = 50ms;  // between the bytes of an escape sequence

bool is_dumb() {
  const char* name = std::getenv("TERM");
  return name != nullptr && std::string_view(name) == "dumb";
}

std::string first_line(std::string_view text) {
  const std::vector<std::string> lines = wrapped(text, 200);
  return lines.empty() ? std::string() : lines.front();
}

}  // namespace

TerminalSubject::TerminalSubject(int input, int output) : input_(input), output_(output) {
  termios settings{};
  if (isatty(output) == 0 || is_dumb() || tcgetattr(input, &settings) != 0) return;
  before_ = settings;
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  settings.c_iflag &= ~static_cast<tcflag_t>(IXON);  // Ctrl-S would make the next draw() wait.
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  tcsetattr(input, TCSAFLUSH, &settings);
  write_out("\x1b[?1049h\x1b[?25l\x1b[H\x1b[2J");  // another screen, without cursor
}

TerminalSubject::~TerminalSubject() {
  if (before_) write_out("\x1b[?25h\x1b[?1049l");
  static_cast<void>(screen_.wait(longest_to_be_drawn));
  if (before_) tcsetattr(input_, TCSAFLUSH, &*before_);
}

void TerminalSubject::show(const SubjectView& view) {
  const bool fresh = !shown_ || is_new_screen(view_, view);
  if (before_) {
    if (fresh) {
      page_ = 0;
      // What was typed at another screen is not meant for this one.
      tcflush(input_, TCIFLUSH);
      typed_.clear();
    }
    keys_.show(view);
  } else {
    SubjectView before = view_;
    if (!shown_) before.trial = view.trial + 1;  // of no screen yet
    std::string text = fresh && shown_ ? "\n" : "";
    if (!shown_ && !view.study.empty()) text += fmt::format("{}\n", first_line(view.study));
    for (const std::string& line : said_of(before, view)) text += fmt::format("{}\n", line);
    write_out(text);
  }
  view_ = view;
  shown_ = true;
  if (before_) draw();
}

std::optional<SubjectAction> TerminalSubject::next() {
  take_input();
  if (!before_) return next_line();
  if (shown_ && is_resized()) draw();
  return next_key();
}

void TerminalSubject::take_input() {
  std::array<char, 256> buffer{};
  pollfd polled{.fd = input_, .events = POLLIN, .revents = 0};
  while (!ended_ && typed_.size() < 4096 && poll(&polled, 1, 0) > 0) {
    const ssize_t count = read(input_, buffer.data(), buffer.size());
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
    ended_ = count <= 0;
    if (count > 0) typed_.insert(typed_.end(), buffer.begin(), buffer.begin() + count);
  }
}

std::optional<SubjectAction> TerminalSubject::next_key() {
  while (!typed_.empty()) {
    const char byte = typed_.front();
    typed_.pop_front();
    const std::optional<char> key = key_of(byte);
    if (!key || turns_page(*key)) continue;
    const std::optional<SubjectAction> action = keys_.press(*key);
    draw();
    if (action) return action;
  }
  if (sequence_ == Sequence::begun &&
      std::chrono::steady_clock::now() - escape_at_ > longest_within_sequence) {
    sequence_ = Sequence::none;
    const std::optional<SubjectAction> action = keys_.press(SubjectKeys::escape);
    draw();
    return action;
  }
  if (ended_) return SubjectAction{.kind = SubjectAction::Kind::quit};
  return std::nullopt;
}

/// A key of its own, and nothing of what arrows and function keys send: their last byte may be an 'A'.
std::optional<char> TerminalSubject::key_of(char byte) {
  switch (sequence_) {
    case Sequence::none:
      break;
    case Sequence::begun:
      sequence_ = byte == '[' ? Sequence::in_brackets : byte == 'O' ? Sequence::one_more : Sequence::none;
      return std::nullopt;
    case Sequence::in_brackets:
      if (byte >= '@' && byte <= '~') sequence_ = Sequence::none;
      return std::nullopt;
    case Sequence::one_more:
      sequence_ = Sequence::none;
      return std::nullopt;
  }
  if (byte != SubjectKeys::escape) return byte;
  sequence_ = Sequence::begun;
  escape_at_ = std::chrono::steady_clock::now();
  return std::nullopt;
}

std::optional<SubjectAction> TerminalSubject::next_line() {
  const auto end = std::find(typed_.begin(), typed_.end(), '\n');
  if (end == typed_.end() && !ended_) return std::nullopt;
  if (typed_.empty()) return SubjectAction{.kind = SubjectAction::Kind::quit};

  const std::string line(typed_.begin(), end);
  const std::optional<SubjectAction> action = command_of(view_, line);
  const bool leaves = action && action->kind == SubjectAction::Kind::quit;
  const bool anything = view_.may_switch || view_.may_answer || view_.may_go_on || view_.may_slip;
  if (!anything && !leaves) return std::nullopt;
  typed_.erase(typed_.begin(), end == typed_.end() ? end : end + 1);
  if (action && permits(view_, *action)) return action;
  if (action) {
    write_out((*view_.texts)("refused_now") + '\n');
  } else if (line.find_first_not_of(" \t\r") != std::string::npos) {
    write_out((*view_.texts)("command_unknown", {{"command", first_line(line)}}) + '\n');
  }
  return std::nullopt;
}

/// A text that is longer than the screen is read to its end before anything is agreed to or left.
bool TerminalSubject::turns_page(char key) {
  const bool on = key == ' ' && page_ + 1 < pages_;
  const bool back = (key == 'p' || key == 'P') && page_ > 0;
  if (on) ++page_;
  if (back) --page_;
  if (on || back) draw();
  return on || back;
}

bool TerminalSubject::is_resized() const {
  const winsize now = size();
  return now.ws_col != drawn_.ws_col || now.ws_row != drawn_.ws_row;
}

winsize TerminalSubject::size() const {
  winsize size{};
  const bool known = ioctl(output_, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 && size.ws_row > 1;
  if (!known) size = {.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
  return size;
}

/// Line over line, and all at once, so that nothing flickers.
void TerminalSubject::draw() {
  drawn_ = size();
  // A column less: a character in the last one would go to the next line on some terminals.
  const SubjectScreen screen =
      screen_of(view_, keys_.what_keys_do(), keys_.hint(), std::min<std::size_t>(drawn_.ws_col, 80) - 1);
  const SubjectScreenPage page = page_of(screen, page_, drawn_.ws_row);
  pages_ = page.pages;
  page_ = std::min(page_, pages_ - 1);
  std::string text = "\x1b[H";
  for (const std::string& line : page.lines)
    text += fmt::format("{}{}\x1b[K", &line == page.lines.data() ? "" : "\r\n", line);
  text += "\x1b[J";
  write_out(text);
}

void TerminalSubject::write_out(const std::string& text) { screen_.write(output_, text); }

}  // namespace kerf::bench

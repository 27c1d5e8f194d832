#include "program/standard_streams.h"

#include <chrono>
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <unistd.h>

#include "host/aside_writer.h"

namespace kerf::bench {
namespace {

using namespace std::chrono_literals;

constexpr auto while_a_line_is_written = 200ms;

AsideWriter& writer() {
  static AsideWriter writer;
  return writer;
}

}  // namespace

void keep_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) < 0) static_cast<void>(open("/dev/null", O_RDWR));  // takes the lowest number
  }
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
  writer();  // now: a loop that has locked its memory is no place to begin a thread
}

void write_output_text(std::string_view text) noexcept { writer().write(STDOUT_FILENO, text); }

void write_error_text(std::string_view text) noexcept { writer().write(STDERR_FILENO, text); }

void draw_error_text(std::string_view text) noexcept { writer().draw(STDERR_FILENO, text); }

void let_lines_out() noexcept { static_cast<void>(writer().wait(while_a_line_is_written)); }

std::vector<std::string> unprinted_errors() {
  let_lines_out();
  std::vector<std::string> lines = writer().unwritten(STDERR_FILENO);
  for (std::string& line : lines) {
    if (line.ends_with('\n')) line.pop_back();
  }
  return lines;
}

int finish_standard_streams() noexcept {
  writer().wait();
  return writer().failure(STDOUT_FILENO);
}

void end_by_closed_pipe() {
  static_cast<void>(std::signal(SIGPIPE, SIG_DFL));
  static_cast<void>(std::raise(SIGPIPE));
  std::_Exit(128 + SIGPIPE);  // where the signal is blocked
}

}  // namespace kerf::bench

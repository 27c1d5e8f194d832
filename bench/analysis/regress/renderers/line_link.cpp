#include "regress/renderers/line_link.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

constexpr std::chrono::milliseconds from_close_to_end{200};  ///< a program that ends closes first

}  // namespace

LineLink::LineLink(ChildProgram& program, int reads, int writes)
    : program_(program), reads_(reads), writes_(writes) {
  fcntl(reads, F_SETFL, O_NONBLOCK);
  fcntl(writes, F_SETFL, O_NONBLOCK);
}

/// What comes first; text of the program is taken into the buffer before its end is told.
LineLink::Waited LineLink::wait(bool for_room, Clock::time_point deadline) {
  const bool for_text = !closed_ && buffer_.size() <= longest_line;
  std::array<pollfd, 2> waited{{{.fd = for_text ? reads_ : -1, .events = POLLIN, .revents = 0},
                                {.fd = for_room ? writes_ : -1, .events = POLLOUT, .revents = 0}}};
  const bool has_ended = program_.wait(waited, deadline);
  if (waited[0].revents != 0) {
    std::array<char, 16384> bytes{};
    const ssize_t count = read(reads_, bytes.data(), bytes.size());
    if (count > 0) buffer_.append(bytes.data(), static_cast<std::size_t>(count));
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) closed_ = true;
    return Waited::text;
  }
  if (waited[1].revents != 0) return Waited::room;
  return has_ended ? Waited::end : Waited::nothing;
}

LineLink::Outcome LineLink::gone() {
  return wait_for_end(Clock::now() + from_close_to_end) == Outcome::done ? Outcome::ended : Outcome::closed;
}

LineLink::Outcome LineLink::send(std::string_view text, Clock::time_point deadline) {
  while (!text.empty()) {
    const ssize_t count = write(writes_, text.data(), text.size());
    if (count > 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) return gone();
    const Waited waited = wait(true, deadline);
    if (waited == Waited::nothing) return Outcome::late;
    if (waited == Waited::end) return Outcome::ended;
    if (buffer_.size() - taken_ > longest_line) return Outcome::endless;
  }
  return Outcome::done;
}

LineLink::Outcome LineLink::receive(std::string_view& line, Clock::time_point deadline) {
  buffer_.erase(0, taken_);
  taken_ = 0;
  for (std::size_t searched = 0;;) {
    const std::size_t end = buffer_.find('\n', searched);
    if (end != std::string::npos) {
      taken_ = end + 1;
      line = std::string_view(buffer_).substr(0, end);
      if (line.ends_with('\r')) line.remove_suffix(1);
      return Outcome::done;
    }
    searched = buffer_.size();
    if (searched > longest_line) return Outcome::endless;
    if (closed_) return gone();
    const Waited waited = wait(false, deadline);
    if (waited == Waited::nothing) return Outcome::late;
    if (waited == Waited::end) return Outcome::ended;
  }
}

LineLink::Outcome LineLink::wait_for_end(Clock::time_point deadline) {
  for (;;) {
    const Waited waited = wait(false, deadline);
    if (waited == Waited::nothing) return Outcome::late;
    if (waited == Waited::end) return Outcome::done;
    if (buffer_.size() - taken_ > longest_line) return Outcome::endless;
  }
}

}  // namespace kerf::bench

#include "apart/pieces.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <sys/socket.h>

namespace kerf::schema::apart {

std::span<std::byte> PieceSink::half() const { return window_.subspan(sent_ % 2 * half_bytes, half_bytes); }

void PieceSink::put(const void* bytes, std::size_t count) {
  const auto* from = static_cast<const std::byte*>(bytes);
  while (count > 0) {
    const auto to = room(1);
    const std::size_t now = std::min(count, to.size());
    std::memcpy(to.data(), from, now);
    filled(now);
    from += now;
    count -= now;
  }
}

std::span<std::byte> PieceSink::room(std::size_t least) {
  if (half_bytes - used_ < least) send(Kind::more, 0);
  while (used_ == 0 && sent_ - copied_ >= 2) wait_for_copy();
  return half().subspan(used_);
}

void PieceSink::end(Kind kind, int error_number) {
  send(kind, error_number);
  while (copied_ < sent_) wait_for_copy();
}

void PieceSink::send(Kind kind, int error_number) {
  const Piece piece{.kind = kind, .bytes = static_cast<std::uint32_t>(used_), .error_number = error_number};
  if (::send(socket_, &piece, sizeof piece, MSG_NOSIGNAL) != sizeof piece) {
    throw std::system_error(errno, std::generic_category(), "nobody listens");
  }
  ++sent_;
  used_ = 0;
}

void PieceSink::wait_for_copy() {
  char said = 0;
  if (::recv(socket_, &said, sizeof said, 0) != sizeof said || said != piece_is_copied) {
    throw std::system_error(ECONNRESET, std::generic_category(), "nobody listens");
  }
  ++copied_;
}

}  // namespace kerf::schema::apart

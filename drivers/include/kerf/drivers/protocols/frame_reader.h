#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace kerf::drivers {

/// Finds the frames of a protocol in a stream of bytes, of which some may be lost, turned or none of a frame.
/// The protocol says, of the first `head` bytes, how long a frame is that begins so, and of all of them
/// whether their sum is right:
///
///     static constexpr std::size_t head, longest;
///     static std::optional<std::size_t> size_of(std::span<const std::uint8_t> head) noexcept;   // nothing:
///     none static bool is_sound(std::span<const std::uint8_t> frame) noexcept;
///
/// What begins like a frame and is none costs a byte, so that a frame behind it is found. No allocation.
template <typename Protocol>
class FrameReader {
 public:
  /// Calls `frame(bytes)` for each, and `wrong()` once where frames that followed each other are followed by
  /// what is none.
  template <typename Frame, typename Wrong>
  void take(std::span<const std::uint8_t> bytes, Frame&& frame, Wrong&& wrong) {
    while (!bytes.empty()) {
      const std::size_t room = std::min(bytes.size(), buffer_.size() - size_);
      std::ranges::copy(bytes.first(room), buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
      size_ += room;
      bytes = bytes.subspan(room);
      while (take_one(frame, wrong)) {
      }
    }
  }

 private:
  /// False where more bytes are needed.
  template <typename Frame, typename Wrong>
  bool take_one(Frame& frame, Wrong& wrong) {
    if (size_ < Protocol::head) return false;
    const std::span<const std::uint8_t> all(buffer_.data(), size_);
    const std::optional<std::size_t> wanted = Protocol::size_of(all.first(Protocol::head));
    if (wanted && size_ < *wanted) return false;
    if (wanted && Protocol::is_sound(all.first(*wanted))) {
      frame(all.first(*wanted));
      in_step_ = true;
      drop(*wanted);
      return true;
    }
    if (in_step_) wrong();
    in_step_ = false;
    drop(1);
    return true;
  }
  void drop(std::size_t count) noexcept {
    std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(count),
              buffer_.begin() + static_cast<std::ptrdiff_t>(size_), buffer_.begin());
    size_ -= count;
  }

  std::array<std::uint8_t, 4 * Protocol::longest> buffer_{};
  std::size_t size_ = 0;
  bool in_step_ = false;
};

}  // namespace kerf::drivers

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace kerf::drivers {

/// The commands of one axis between the write and the moment at which they act. A later one never overtakes
/// an earlier one; where more are on the way than there is room for, the last one gives way to the newest.
class CommandsOnTheWay {
 public:
  static constexpr std::size_t room = 512;

  void send(double arrives_s, double force) noexcept {
    if (count_ > 0) arrives_s = std::max(arrives_s, at(count_ - 1).arrives_s);
    if (count_ < room) ++count_;
    at(count_ - 1) = {.arrives_s = arrives_s, .force = force};
  }
  [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
  [[nodiscard]] double next_s() const noexcept { return line_[first_].arrives_s; }
  /// The first of them, which is on the way no more.
  double take() noexcept {
    const double force = line_[first_].force;
    first_ = (first_ + 1) % room;
    --count_;
    return force;
  }
  void forget() noexcept { count_ = 0; }

 private:
  struct Command {
    double arrives_s = 0.0;
    double force = 0.0;
  };
  Command& at(std::size_t i) noexcept { return line_[(first_ + i) % room]; }

  std::array<Command, room> line_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace kerf::drivers

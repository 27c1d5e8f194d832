#pragma once

#include <chrono>
#include <cstddef>
#include <deque>

namespace kerf::bench {

/// Counts failures: `most` may be within `window`, and no more are worth an answer until the oldest is out of
/// it. Not for several threads.
class AttemptLimit {
 public:
  using Clock = std::chrono::steady_clock;
  AttemptLimit(std::size_t most, Clock::duration window) : most_(most), window_(window) {}

  void note_failure(Clock::time_point now) {
    forget(now);
    failures_.push_back(now);
    if (failures_.size() > most_) failures_.pop_front();
  }
  /// How long it takes until one more may be tried; zero: now.
  [[nodiscard]] Clock::duration wait(Clock::time_point now) {
    forget(now);
    return failures_.size() < most_ ? Clock::duration::zero() : failures_.front() + window_ - now;
  }

 private:
  void forget(Clock::time_point now) {
    while (!failures_.empty() && failures_.front() + window_ <= now) failures_.pop_front();
  }

  std::size_t most_;
  Clock::duration window_;
  std::deque<Clock::time_point> failures_;  ///< oldest first
};

}  // namespace kerf::bench

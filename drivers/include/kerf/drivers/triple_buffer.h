#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace kerf::drivers {

/// The latest value that one thread has for another: three buffers that change hands by one atomic exchange.
/// put() and take() wait for nobody, allocate nothing, and never let a half-written value through. One thread
/// puts, one takes.
template <typename T>
class TripleBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  void put(const T& value) noexcept {
    slots_[mine_] = value;
    mine_ = shared_.exchange(static_cast<std::uint8_t>(mine_ | fresh), std::memory_order_acq_rel) & slot;
  }
  /// Copies the value out; false, and no change, if there is none since the last time.
  bool take(T& value) noexcept {
    if ((shared_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    theirs_ = shared_.exchange(theirs_, std::memory_order_acq_rel) & slot;
    value = slots_[theirs_];
    return true;
  }

 private:
  static constexpr std::uint8_t fresh = 4;
  static constexpr std::uint8_t slot = 3;
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);

  std::array<T, 3> slots_{};
  std::atomic<std::uint8_t> shared_{1};
  alignas(64) std::uint8_t mine_ = 0;    ///< of the thread that puts
  alignas(64) std::uint8_t theirs_ = 2;  ///< of the thread that takes
};

}  // namespace kerf::drivers

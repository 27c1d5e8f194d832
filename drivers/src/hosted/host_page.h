#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <kerf/device.h>
#include <kerf/processes/helper.h>

/// What a program and the host of its device agree upon (kerf-device-host, docs/own-device.md).
namespace kerf::drivers::hosted {

/// Values that one process has for another, the last `slots` of them. put() and get() wait for nobody. A slot
/// is written again only `slots` values later, and a value that was overwritten while it was copied is none.
template <typename T, std::size_t slots>
class SharedRing {
  static_assert(std::is_trivially_copyable_v<T> && (slots & (slots - 1)) == 0);

 public:
  void put(const T& value) noexcept {
    const std::uint64_t number = count_.load(std::memory_order_relaxed) + 1;
    Slot& slot = slots_[number % slots];
    slot.number.store(0, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    std::memcpy(&slot.value, &value, sizeof value);
    slot.number.store(number, std::memory_order_release);
    count_.store(number, std::memory_order_release);
  }
  /// How many have been put.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }
  /// Of `count` the last that are none any more.
  [[nodiscard]] static constexpr std::uint64_t overwritten(std::uint64_t count) noexcept {
    return count > slots ? count - slots : 0;
  }
  /// The one of that number, from 1; false where it is not there any more.
  [[nodiscard]] bool get(std::uint64_t number, T& value) const noexcept {
    const Slot& slot = slots_[number % slots];
    if (number == 0 || slot.number.load(std::memory_order_acquire) != number) return false;
    std::memcpy(&value, &slot.value, sizeof value);
    std::atomic_thread_fence(std::memory_order_acquire);
    return slot.number.load(std::memory_order_relaxed) == number;
  }

 private:
  struct alignas(64) Slot {
    std::atomic<std::uint64_t> number{0};
    T value{};
  };
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
  alignas(64) std::atomic<std::uint64_t> count_{0};
  std::array<Slot, slots> slots_{};
};

/// A reading as it came back from the plug-in.
struct Reading {
  kerf_device_reading_v1 told{};
  std::int64_t arrived_ns = 0;
  /// Of its own count since the last reading, with KERF_COUNTS_READINGS; else 1.
  std::int64_t step = 1;
};

/// A force that the loop gave.
struct Command {
  std::array<double, KERF_DEVICE_AXES> force{};
  std::int64_t at_ns = 0;
};

/// Where the host is in the plug-in.
enum class Stage : std::uint32_t {
  elsewhere,
  loading,
  opening,
  describing,
  reading,
  writing,
  releasing,
  closing
};

constexpr const char* in_words(Stage stage) noexcept {
  switch (stage) {
    case Stage::elsewhere:
      return "outside of it";
    case Stage::loading:
      return "while it was loaded";
    case Stage::opening:
      return "in open()";
    case Stage::describing:
      return "in describe()";
    case Stage::reading:
      return "in read()";
    case Stage::writing:
      return "in write()";
    case Stage::releasing:
      return "in release()";
    case Stage::closing:
      return "in close()";
  }
  return "somewhere";
}

/// Where a thread of the host is in the plug-in, and since when.
struct Whereabouts {
  std::atomic<Stage> stage{Stage::elsewhere};
  std::atomic<std::int64_t> since_ns{0};
};

/// The page that program, host and stand-by see. What the plug-in's process wrote is looked at as a
/// stranger's.
struct Page {
  // Of the program.
  SharedRing<Command, 4> commands;
  std::atomic<std::int64_t> let_go_ns{0};  ///< commands up to then are none

  // Of the host.
  kerf_device_facts_v1 facts{};  ///< once it has said that it is ready
  SharedRing<Reading, 512> readings;
  std::atomic<std::uint32_t> has_write{0};
  Whereabouts reader;                       ///< of the thread that sets up, reads, and closes
  Whereabouts writer;                       ///< of the one beside it, with KERF_WRITES_ANY_TIME
  std::atomic<std::uint32_t> lost{0};       ///< the plug-in said so
  std::atomic<std::uint64_t> missing{0};    ///< readings, by its own count
  std::atomic<std::uint64_t> repeated{0};   ///< likewise, that came twice or late
  std::atomic<std::uint64_t> not_taken{0};  ///< forces
  std::atomic<std::uint32_t> unguarded{0};  ///< nobody stands by any more: no force is given
  /// When the stand-by lets the device go unless a later time stands here by then; 0: nothing is held.
  std::atomic<std::int64_t> until_ns{0};
  std::atomic<std::uint32_t> standby_may_go{0};

  // Of the stand-by.
  std::atomic<std::uint32_t> let_go_instead{0};  ///< times that it let the device go
  std::atomic<std::uint32_t> host_ended{0};      ///< without having said that it would
};

/// The descriptors with which a host begins.
inline constexpr int host_to_program =
    processes::first_descriptor;  ///< SOCK_SEQPACKET; its end is the program's
inline constexpr int host_of_page = host_to_program + 1;
inline constexpr int host_of_wakes = host_to_program + 2;     ///< eventfd: a command has come
inline constexpr int host_of_readings = host_to_program + 3;  ///< eventfd: a reading has come

/// The first byte of what the host says.
inline constexpr char says_look = 'l';  ///< name, about, options, each with a zero behind it; asked for alone
inline constexpr char says_opening = 'o';  ///< open() takes at most so many milliseconds, in digits
inline constexpr char says_ready = 'r';
inline constexpr char says_refused = 'x';  ///< and why
inline constexpr char says_lost = 'g';     ///< and why the device is
inline constexpr std::size_t longest_message = 8192;

/// The first byte of what it is asked, before the path and then names and values of options, each with a zero
/// behind it.
inline constexpr char ask_to_look = 'l';
inline constexpr char ask_to_open = 'o';

}  // namespace kerf::drivers::hosted

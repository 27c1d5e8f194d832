#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include <boost/lockfree/spsc_queue.hpp>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "loop/command.h"

namespace kerf::bench {

/// Something that a person did to what is rendered, as the tick saw it.
struct LiveChange {
  enum class Kind : std::uint8_t { law, zero, resume };
  std::uint64_t tick = 0;  ///< the first in which it shows
  double time_s = 0.0;     ///< loop time of that tick
  Kind kind = Kind::law;
  std::uint64_t law = 0;  ///< which offer() it was, from 1; 0: nothing is rendered. Of every kind
};

/// What a loop renders while a person changes the law at will, or takes the force away.
///
/// From law to law it goes as LawSwitch does, for `ramp_s`; no law at all is a rendering too. What is offered
/// during a blend waits for its end, and gives way to what is offered after it. release() makes the force
/// zero from the next tick on and holds it there, past slew limit and ramp (Safety does that); after resume()
/// it comes back along Safety's soft start. The laws are computed meanwhile as if they were felt, so that
/// they know the path of the tool.
///
/// operator() and record() are the tick's: they allocate, lock and free nothing. Renderings that are no
/// longer used wait in a list, to be freed by collect(). offer(), collect() and take_change() are for one
/// other thread at a time each; release(), resume() and what may be read, for any.
class LiveRendering {
 public:
  explicit LiveRendering(double ramp_s) : ramp_s_(ramp_s) {}
  LiveRendering(const LiveRendering&) = delete;
  LiveRendering& operator=(const LiveRendering&) = delete;
  ~LiveRendering() { forget(); }

  /// Ready for another loop, with nothing to render. A force that was released stays so. Only while no loop
  /// is running.
  void restart(double ramp_s) {
    forget();
    changes_.reset();
    ramp_s_ = ramp_s;
    current_ = coming_ = nullptr;
    started_ = is_released_now_ = told_released_ = false;
    told_law_ = 0;
    begun_s_ = now_s_ = 0.0;
    blending_.store(false, std::memory_order_relaxed);
  }

  /// Hands over what is to be rendered next, made ready beforehand; none: nothing. Returns its number.
  std::uint64_t offer(std::unique_ptr<LawRendering> rendering) {
    auto offered = std::make_unique<Offer>();
    offered->rendering = std::move(rendering);
    const std::uint64_t number = offered->number = ++offers_;
    const std::unique_ptr<Offer> untaken(offered_.exchange(offered.release(), std::memory_order_acq_rel));
    return number;
  }

  /// Frees what is no longer rendered; returns how many there were.
  std::size_t collect() noexcept {
    std::size_t count = 0;
    for (Offer* next = retired_.exchange(nullptr, std::memory_order_acquire); next != nullptr; ++count) {
      const std::unique_ptr<Offer> gone(next);
      next = gone->next_retired;
    }
    return count;
  }

  void release() noexcept { released_.store(true, std::memory_order_release); }
  void resume() noexcept { released_.store(false, std::memory_order_release); }
  [[nodiscard]] bool is_released() const noexcept { return released_.load(std::memory_order_acquire); }
  [[nodiscard]] bool is_blending() const noexcept { return blending_.load(std::memory_order_acquire); }

  /// The next change that the tick has seen, oldest first. It is there before its row can be.
  [[nodiscard]] bool take_change(LiveChange& change) noexcept { return changes_.pop(change); }

  [[nodiscard]] Command operator()(const drivers::Sample& sample, double period_s) noexcept {
    if (started_) now_s_ += period_s;
    started_ = true;
    Command command = forces_of(current_, sample, period_s);
    if (coming_ == current_) begin_blend();
    if (coming_ != current_) blend(sample, period_s, command);
    command.is_released = is_released_now_ = is_released();
    if (is_released_now_) command.force = {};
    return command;
  }

  /// The row of the tick, before it is handed on.
  void record(const schema::Row& row) noexcept {
    LiveChange change{.tick = row.tick, .time_s = row.time_s, .law = number_of(coming_)};
    if (change.law != told_law_ && changes_.push(change)) told_law_ = change.law;
    change.kind = is_released_now_ ? LiveChange::Kind::zero : LiveChange::Kind::resume;
    if (is_released_now_ != told_released_ && changes_.push(change)) told_released_ = is_released_now_;
  }

 private:
  struct Offer {
    std::unique_ptr<LawRendering> rendering;
    std::uint64_t number = 0;
    Offer* next_retired = nullptr;
  };
  static constexpr std::size_t max_changes = 256;

  [[nodiscard]] static std::uint64_t number_of(const Offer* offer) noexcept {
    return offer != nullptr && offer->rendering ? offer->number : 0;
  }
  [[nodiscard]] static Command forces_of(const Offer* offer, const drivers::Sample& sample,
                                         double period_s) noexcept {
    return offer != nullptr && offer->rendering ? (*offer->rendering)(sample, period_s) : Command{};
  }

  void begin_blend() noexcept {
    if (offered_.load(std::memory_order_relaxed) == nullptr) return;
    coming_ = offered_.exchange(nullptr, std::memory_order_acq_rel);
    begun_s_ = now_s_;
    blending_.store(true, std::memory_order_release);
  }

  void blend(const drivers::Sample& sample, double period_s, Command& command) noexcept {
    const Command coming = forces_of(coming_, sample, period_s);
    const double share = ramp_s_ > 0.0 ? std::min(1.0, (now_s_ - begun_s_) / ramp_s_) : 1.0;
    blend_into(command, coming, share);
    if (share < 1.0) return;
    retire(current_);
    current_ = coming_;
    blending_.store(false, std::memory_order_release);
  }

  /// Only the tick adds to the list and only collect() empties it, all at once: the exchange fails once at
  /// most.
  void retire(Offer* offer) noexcept {
    if (offer == nullptr) return;
    offer->next_retired = retired_.load(std::memory_order_relaxed);
    while (!retired_.compare_exchange_weak(offer->next_retired, offer, std::memory_order_release,
                                           std::memory_order_relaxed)) {
    }
  }

  void forget() noexcept {
    (void)collect();
    const std::unique_ptr<Offer> untaken(offered_.exchange(nullptr));
    const std::unique_ptr<Offer> coming(coming_ != current_ ? coming_ : nullptr);
    const std::unique_ptr<Offer> current(current_);
  }

  std::atomic<Offer*> offered_{nullptr};
  std::atomic<Offer*> retired_{nullptr};
  std::atomic<bool> released_{false};
  std::atomic<bool> blending_{false};
  static_assert(std::atomic<Offer*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);
  boost::lockfree::spsc_queue<LiveChange, boost::lockfree::capacity<max_changes>> changes_;
  std::uint64_t offers_ = 0;  ///< of the offering thread
  // The tick's own.
  double ramp_s_;
  Offer* current_ = nullptr;
  Offer* coming_ = nullptr;
  double now_s_ = 0.0;
  double begun_s_ = 0.0;
  bool started_ = false;
  bool is_released_now_ = false;
  bool told_released_ = false;
  std::uint64_t told_law_ = 0;
};

}  // namespace kerf::bench

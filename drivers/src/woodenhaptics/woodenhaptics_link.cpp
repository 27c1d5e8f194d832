#include "woodenhaptics/woodenhaptics_link.h"

#include <algorithm>
#include <utility>

#include "age_limits.h"

namespace kerf::drivers {
namespace {

using usb::now_ns;
using woodenhaptics::Generation;
using woodenhaptics::Report;
using End = usb::Transfer::End;

constexpr std::int64_t millisecond = 1'000'000;
constexpr std::int64_t keep_alive_ns = 50 * millisecond;  // a tenth of the device's own watchdog
constexpr std::int64_t answer_wait_ns = 10 * millisecond;
constexpr std::int64_t idle_ns =
    2 * millisecond;  // V2 and V3 without a tick: so often a position all the same
constexpr std::int64_t prompt_ns = 3 * millisecond;  // an answer that takes longer was held up on its way
constexpr std::int64_t refused_ns = 20 * millisecond;
constexpr std::int64_t max_final_zero_ns = 20 * millisecond;
constexpr unsigned final_zero_reports = 3;  // the order that waits, this one, and the turn that applies it
constexpr unsigned many_refusals = 3;
constexpr unsigned max_bad = 20;
// Of a stylus with a switch, which its firmware adds to the counter of the first gimbal encoder.
constexpr int switch_threshold = 5000;
constexpr int switch_offset = 10000;
constexpr WoodenHapticsLink::Currents zero{};

}  // namespace

WoodenHapticsLink::WoodenHapticsLink(usb::UsbDevice& device, usb::IoThread& thread, usb::Guard& guard,
                                     Generation generation, const Plausible& plausible)
    : device_(device),
      thread_(thread),
      guard_(guard),
      generation_(generation),
      plausible_(plausible),
      endpoints_(device.endpoints()),
      out_(device, endpoints_.out, woodenhaptics::report_size(generation),
           [this](End end, std::span<const std::uint8_t>) { sent(end); }) {
  for (std::size_t which = 0; which < receiving; ++which) {
    in_[which] = std::make_unique<usb::Transfer>(
        device, endpoints_.in, woodenhaptics::max_report_size,
        [this, which](End end, std::span<const std::uint8_t> bytes) { received(which, end, bytes); });
  }
}

void WoodenHapticsLink::begin(const Report& report) noexcept {
  counters_.start(report.encoder);
  hear(report, now_ns());
}

void WoodenHapticsLink::command(const Currents& current_ma) noexcept {
  commanded_.put(
      {.current_ma = current_ma, .releases = releases_.load(std::memory_order_acquire), .at_ns = now_ns()});
  thread_.wake();
}

void WoodenHapticsLink::release() noexcept {
  releases_.fetch_add(1, std::memory_order_release);
  thread_.wake();
}

void WoodenHapticsLink::run(const std::stop_token& stop) noexcept {
  for (const auto& transfer : in_) {
    if (!transfer->submit()) lost_.store(true);
  }
  while (!stop.stop_requested() && !lost()) {
    recover();
    const std::int64_t now = now_ns();
    speak(now);
    tell_guard();
    if (device_.handle_events(next_turn_ns(now), thread_.wake_descriptor())) thread_.take_wakes();
    hear();
  }
  if (!lost()) let_go();
  ending_ = true;  // what still ends is not submitted again
}

std::int64_t WoodenHapticsLink::next_turn_ns(std::int64_t now) const noexcept {
  // The end of what is on its way wakes it.
  if (streams() || out_.pending()) return answer_wait_ns;
  return std::max<std::int64_t>(0, (answered_ ? heard_ns_ + idle_ns : taken_ns_ + answer_wait_ns) - now);
}

void WoodenHapticsLink::received(std::size_t which, End end, std::span<const std::uint8_t> bytes) noexcept {
  if (ending_) return;
  if (end != End::completed) {
    in_halted_ = in_halted_ || end == End::stalled;
    return ended_badly(end);
  }
  bad_in_a_row_ = 0;
  if (const auto report = woodenhaptics::parse_report(bytes, generation_)) {
    came_[std::min(came_count_++, came_.size() - 1)] = *report;
  } else {
    counts_.malformed.fetch_add(1, std::memory_order_relaxed);
    answered_ = true;
  }
  if (!in_[which]->submit()) lost_.store(true);
}

void WoodenHapticsLink::sent(End end) noexcept {
  taken_ns_ = now_ns();
  if (end == End::completed) {
    refused_in_a_row_ = 0;
    return refuses_.store(false, std::memory_order_relaxed);
  }
  fresh_ = true;
  if (end == End::cancelled) return;
  out_halted_ = out_halted_ || end == End::stalled;
  counts_.refused.fetch_add(1, std::memory_order_relaxed);
  if (++refused_in_a_row_ >= many_refusals) refuses_.store(true, std::memory_order_relaxed);
  ended_badly(end);
}

void WoodenHapticsLink::ended_badly(End end) noexcept {
  if (end == End::gone || ++bad_in_a_row_ > max_bad) lost_.store(true);
}

void WoodenHapticsLink::recover() noexcept {
  // Not from a handler: it waits for the device, and handlers must not.
  if (in_halted_) (void)device_.clear_halt(endpoints_.in);
  if (out_halted_) (void)device_.clear_halt(endpoints_.out);
  in_halted_ = out_halted_ = false;
  for (const auto& transfer : in_) {
    if (!lost() && !transfer->pending() && !transfer->submit()) lost_.store(true);
  }
}

/// Takes what has come since the last turn.
void WoodenHapticsLink::hear() noexcept {
  const std::size_t count = std::exchange(came_count_, 0);
  // All transfers had ended before one of them was looked at: nobody knows how long ago. A device that sends
  // by itself has the next one in a moment.
  if (streams() && count >= receiving) {
    counts_.stale.fetch_add(count, std::memory_order_relaxed);
    return;
  }
  const std::int64_t now = now_ns();
  for (std::size_t i = 0; i < std::min(count, came_.size()); ++i) hear(came_[i], now);
}

void WoodenHapticsLink::hear(const Report& report, std::int64_t now) noexcept {
  // Of several that came at once each may be a millisecond from the one before.
  const std::int64_t elapsed_ns = std::max(now - heard_ns_, millisecond);
  const double most = std::min(1e-9 * static_cast<double>(elapsed_ns) * plausible_.count_rate,
                               static_cast<double>(plausible_.count_step));
  answered_ = true;
  if (!counters_.take(report.encoder, static_cast<int>(most) + 2)) {
    counts_.implausible.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  heard_ns_ = now;
  const auto heard_before = counts_.reports.fetch_add(1, std::memory_order_relaxed);
  if (streams()) {
    const int lost = static_cast<std::uint16_t>(report.counter - last_counter_ - 1);
    if (heard_before > 0) counts_.gaps.fetch_add(static_cast<unsigned>(lost), std::memory_order_relaxed);
    last_counter_ = report.counter;
  }
  Reading reading{.count = counters_.count(), .button = report.button, .at_ns = now};
  // An answer was built when its order was taken.
  if (!streams() && taken_ns_ > 0 && now - taken_ns_ > prompt_ns) reading.at_ns = taken_ns_;
  std::copy_n(report.encoder.begin() + 3, reading.gimbal.size(), reading.gimbal.begin());
  if (reading.gimbal[0] > switch_threshold) {
    reading.gimbal[0] -= switch_offset;
    reading.button = true;
  }
  readings_.put(reading);
}

WoodenHapticsLink::Currents WoodenHapticsLink::wanted(std::int64_t now) const noexcept {
  const bool released = command_.releases != releases_.load(std::memory_order_acquire) || !guard_.lives();
  return released || now - command_.at_ns > max_command_age_ns ? zero : command_.current_ma;
}

bool WoodenHapticsLink::is_due(std::int64_t now, bool stops) noexcept {
  if (stops) return true;
  if (streams()) return fresh_ || now - sent_ns_ >= keep_alive_ns;
  if (answered_) return fresh_ || now - heard_ns_ >= idle_ns;
  if (now - taken_ns_ < answer_wait_ns) return false;
  counts_.resent.fetch_add(1, std::memory_order_relaxed);
  return true;
}

/// Sends what the tick wants, when it is time to.
void WoodenHapticsLink::speak(std::int64_t now) noexcept {
  if (commanded_.take(command_)) fresh_ = true;
  const Currents current_ma = wanted(now);
  const bool stops = current_ma == zero && sent_ma_ != zero;  // is not put off
  if (lost()) return;
  if (out_.pending()) {
    if (now - sent_ns_ > refused_ns) refuses_.store(true, std::memory_order_relaxed);
    // Whenever the device takes orders again, that one must not be the first.
    if (stops) out_.cancel();
    return;
  }
  if (is_due(now, stops)) send(current_ma, now);
}

void WoodenHapticsLink::send(const Currents& current_ma, std::int64_t now) noexcept {
  const auto order = woodenhaptics::set_currents(current_ma, generation_);
  std::ranges::copy(std::span(order.bytes).subspan(1, order.size - 1), out_.buffer().begin());
  // Of a force the guard knows before the device can have it, of zero once it is on its way.
  if (current_ma != zero) sent_ma_ = current_ma;
  tell_guard();
  if (!out_.submit()) return lost_.store(true);
  sent_ma_ = current_ma;
  tell_guard();
  sent_ns_ = now;
  answered_ = false;
  fresh_ = false;
  sent_.put(current_ma);
}

void WoodenHapticsLink::tell_guard() noexcept {
  guard_.hold_until(sent_ma_ == zero ? 0 : guarded_until_ns(now_ns(), command_.at_ns));
}

/// Zero, and some reports more: a device that nobody reads from any more does not come to its next order
/// either.
void WoodenHapticsLink::let_go() noexcept {
  const std::int64_t until_ns = now_ns() + max_final_zero_ns;
  const auto reports = [this] { return counts_.reports.load(std::memory_order_relaxed); };
  bool said = false;
  std::uint64_t enough = 0;
  while (now_ns() < until_ns && !lost() && !(said && !out_.pending() && reports() >= enough)) {
    if (!said && out_.pending() && sent_ma_ != zero) out_.cancel();
    if (!said && !out_.pending()) {
      send(zero, now_ns());
      said = true;
      enough = reports() + (streams() ? final_zero_reports : 1);
    }
    recover();
    device_.handle_events(millisecond);
    hear();
  }
}

}  // namespace kerf::drivers

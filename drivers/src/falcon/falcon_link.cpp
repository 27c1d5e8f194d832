#include "falcon/falcon_link.h"

#include <algorithm>

#include <Eigen/Core>

#include "age_limits.h"
#include "falcon/falcon_setup.h"
#include "kerf/mechanisms/falcon.h"

namespace kerf::drivers {
namespace {

using usb::now_ns;
using End = usb::Transfer::End;

constexpr std::int64_t millisecond = 1'000'000;
constexpr std::int64_t answer_ns = 5 * millisecond;   // it takes at most 1.3
constexpr std::int64_t prompt_ns = 3 * millisecond;   // what takes longer was held up on its way
constexpr std::int64_t unasked_ns = 2 * millisecond;  // a tick of 1 kHz, and as much again
constexpr std::int64_t final_zero_ns = 50 * millisecond;
constexpr unsigned max_bad = 20;
constexpr std::array<int, 3> zero{};
constexpr std::array<double, 3> middle{0.0, 0.0, 0.12};

Eigen::Vector3d vector_of(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

}  // namespace

FalconLink::FalconLink(usb::UsbDevice& device, usb::IoThread& thread, usb::Guard& guard, bool homing,
                       Falcon::Led led)
    : device_(device),
      thread_(thread),
      guard_(guard),
      homing_(homing),
      led_(led),
      nearby_(vector_of(middle)),
      out_(device, falcon_out, falcon::frame_size,
           [this](End end, std::span<const std::uint8_t>) { sent(end); }) {
  for (std::size_t which = 0; which < receiving; ++which) {
    in_[which] = std::make_unique<usb::Transfer>(
        device, falcon_in, 64,
        [this, which](End end, std::span<const std::uint8_t> bytes) { received(which, end, bytes); });
  }
}

void FalconLink::command(const std::array<int, 3>& motor) noexcept {
  if (ordered_ == 0) {
    counts_.reports_before.store(counts_.reports.load(std::memory_order_relaxed), std::memory_order_relaxed);
    counts_.first_command_ns.store(now_ns(), std::memory_order_relaxed);
  }
  ++ordered_;
  // Before it can be seen: a release at the same time then counts for it too.
  last_order_.store(ordered_);
  orders_.put({.motor = motor, .number = ordered_, .at_ns = now_ns()});
  thread_.wake();
}

void FalconLink::release() noexcept {
  released_.store(last_order_.load());
  thread_.wake();
}

void FalconLink::run(const std::stop_token& stop) noexcept {
  for (const auto& transfer : in_) {
    if (!transfer->submit()) lost_.store(true);
  }
  while (!stop.stop_requested() && !lost()) {
    recover();
    send_if_due();
    tell_guard();
    if (device_.handle_events(wait_ns(), thread_.wake_descriptor())) thread_.take_wakes();
  }
  if (!lost()) let_go();
  ending_ = true;  // what still ends is not submitted again
}

std::int64_t FalconLink::wait_ns() const noexcept {
  // The end of what is on its way wakes it. Not to wait at all would keep the kernel from sending it, on one
  // processor.
  if (out_.pending()) return answer_ns;
  return std::max<std::int64_t>(0, sent_ns_ + (unanswered_ > 0 ? answer_ns : unasked_ns) - now_ns());
}

void FalconLink::received(std::size_t which, End end, std::span<const std::uint8_t> bytes) noexcept {
  if (ending_) return;
  if (end != End::completed) return ended_badly(end, falcon_in);
  bad_in_a_row_ = 0;
  falcon::for_each_data_byte(bytes, [this](std::uint8_t byte) {
    const auto frame = reader_.take(byte);
    if (!frame) return;
    if (const auto report = falcon::parse_report(*frame)) take_report(*report);
  });
  counts_.dropped_bytes.store(reader_.dropped(), std::memory_order_relaxed);
  if (!in_[which]->submit()) lost_.store(true);
}

void FalconLink::sent(End end) noexcept {
  if (end == End::cancelled) {
    unanswered_ = 0;  // nothing was asked
  } else if (!ending_ && end != End::completed) {
    ended_badly(end, falcon_out);
  }
}

void FalconLink::ended_badly(End end, std::uint8_t endpoint) noexcept {
  counts_.malformed.fetch_add(1, std::memory_order_relaxed);
  if (end == End::gone || ++bad_in_a_row_ > max_bad) lost_.store(true);
  if (end == End::stalled) halted_ = endpoint;
}

void FalconLink::recover() noexcept {
  // Not from a handler: it waits for the device, and handlers must not.
  if (halted_ != 0) (void)device_.clear_halt(halted_);
  halted_ = 0;
  for (const auto& transfer : in_) {
    if (!transfer->pending() && !transfer->submit()) lost_.store(true);
  }
}

void FalconLink::take_report(const falcon::Report& report) noexcept {
  const auto shoulder = mechanisms::Falcon::shoulder_of(report.encoder);
  auto knob = mechanisms::Falcon::knob(shoulder, nearby_);
  // Homing moves the origin, perhaps too far for the travel from the last position.
  if (!knob) knob = mechanisms::Falcon::knob(shoulder, vector_of(middle));
  if (knob) nearby_ = *knob;
  const std::int64_t now = now_ns();
  readings_.put({.report = report,
                 .motor = sent_motor_,
                 .knob = {nearby_.x(), nearby_.y(), nearby_.z()},
                 .reachable = knob.has_value(),
                 .at_ns = now - sent_ns_ > prompt_ns ? sent_ns_ : now});
  homed_.store(std::ranges::all_of(report.homed, [](bool one) { return one; }), std::memory_order_relaxed);
  counts_.reports.fetch_add(1, std::memory_order_relaxed);
  if (unanswered_ > 0) --unanswered_;
}

void FalconLink::send_if_due() noexcept {
  (void)orders_.take(order_);
  if (lost()) return;
  const std::int64_t now = now_ns();
  const bool holds =
      order_.number > released_.load() && now - order_.at_ns <= max_command_age_ns && guard_.lives();
  const auto& motor = holds ? order_.motor : zero;
  const bool lets_go = !holds && sent_motor_ != zero;  // waits for no answer
  if (out_.pending()) {
    // Whenever the device takes frames again, that one must not be the first.
    if (lets_go) out_.cancel();
    return;
  }
  if (unanswered_ > 0 && !lets_go) {
    if (now - sent_ns_ < answer_ns) return;
    unanswered_ = 0;
    counts_.resent.fetch_add(1, std::memory_order_relaxed);
  } else if (!lets_go && order_.number == sent_order_ && now - sent_ns_ < unasked_ns) {
    return;
  }
  send(motor, homing_ && !homed() ? Falcon::Led::red : led_);
}

void FalconLink::send(const std::array<int, 3>& motor, Falcon::Led led) noexcept {
  const auto frame = falcon::encode(falcon::Command{.motor = motor,
                                                    .homing = homing_,
                                                    .green = led == Falcon::Led::green,
                                                    .blue = led == Falcon::Led::blue,
                                                    .red = led == Falcon::Led::red});
  std::ranges::copy(frame, out_.buffer().begin());
  // Of a force the guard knows before the device can have it, of zero once it is on its way.
  if (motor != zero) sent_motor_ = motor;
  tell_guard();
  if (!out_.submit()) {
    lost_.store(true);
    return;
  }
  sent_motor_ = motor;
  tell_guard();
  sent_order_ = order_.number;
  sent_ns_ = now_ns();
  ++unanswered_;
}

void FalconLink::tell_guard() noexcept {
  guard_.hold_until(sent_motor_ == zero ? 0 : guarded_until_ns(now_ns(), order_.at_ns));
}

void FalconLink::let_go() noexcept {
  const std::int64_t until_ns = now_ns() + final_zero_ns;
  bool said = false;
  // Its answer is waited for too: then the device has it.
  while (now_ns() < until_ns && !lost() && !(said && !out_.pending() && unanswered_ == 0)) {
    if (!said && out_.pending()) out_.cancel();
    if (!said && !out_.pending()) {
      unanswered_ = 0;
      send(zero, Falcon::Led::off);
      said = true;
    }
    recover();
    device_.handle_events(millisecond);
  }
}

}  // namespace kerf::drivers

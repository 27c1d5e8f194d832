#include "session.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <kerf/drivers/usb/io_thread.h>

namespace kerf::emulators {
namespace {

using drivers::usb::now_ns;

constexpr std::int32_t stalled = -EPIPE;
constexpr std::int64_t shortest_wait_ns = 20'000;
constexpr std::int64_t frame_ns = 1'000'000;
constexpr std::int64_t longest_wait_ns = 100'000'000;  // then it looks whether it is to stop

// Requests and descriptors of chapter 9 of USB 2.0, and of HID 1.11.
constexpr std::uint8_t get_status = 0;
constexpr std::uint8_t clear_feature = 1;
constexpr std::uint8_t set_feature = 3;
constexpr std::uint8_t get_descriptor = 6;
constexpr std::uint8_t get_configuration = 8;
constexpr std::uint8_t set_configuration = 9;
constexpr std::uint8_t set_interface = 11;
constexpr std::uint8_t descriptor_device = 1;
constexpr std::uint8_t descriptor_configuration = 2;
constexpr std::uint8_t descriptor_string = 3;
constexpr std::uint8_t descriptor_endpoint = 5;
constexpr std::uint8_t descriptor_report = 0x22;
constexpr std::uint8_t transfer_type = 0x03;
constexpr std::uint8_t interrupt = 0x03;
constexpr std::uint8_t direction_in = 0x80;
constexpr std::uint8_t type_mask = 0x60;  // standard, class, vendor
constexpr std::uint8_t hid_class_out = 0x21;
constexpr std::uint8_t hid_set_idle = 0x0A;
constexpr std::uint8_t hid_set_protocol = 0x0B;

std::int64_t next_frame(std::int64_t time_ns) { return (time_ns / frame_ns + 1) * frame_ns; }

}  // namespace

Setup Setup::parse(std::span<const std::uint8_t, 8> bytes) noexcept {
  const auto word = [&](std::size_t at) {
    return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
  };
  return {
      .request_type = bytes[0], .request = bytes[1], .value = word(2), .index = word(4), .length = word(6)};
}

Session::Session(int socket, EmulatedDevice& device, FaultPlan faults)
    : socket_(socket), device_(device), faults_(std::move(faults)), start_ns_(now_ns()) {
  find_intervals();
}

void Session::find_intervals() {
  const Bytes& all = device_.description().configuration;
  for (std::size_t at = 0; at + 7 <= all.size() && all[at] > 0; at += all[at]) {
    const std::uint8_t address = all[at + 2];
    if (all[at + 1] != descriptor_endpoint || (address & direction_in) != 0) continue;
    if ((all[at + 3] & transfer_type) != interrupt) continue;
    out_[address].interval_ns = frame_ns * std::bit_floor(std::max<unsigned>(1, all[at + 6]));
  }
}

Session::End Session::run(const std::atomic<bool>& stop, double seconds) {
  const auto unplugged_at_s = faults_.unplugged_at_s();
  while (true) {
    const std::int64_t now = now_ns();
    if (stop.load()) return End::stopped;
    if (unplugged_at_s && seconds_at(now) >= *unplugged_at_s) return End::unplugged;
    if (seconds > 0.0 && seconds_at(now) >= seconds) return End::time_over;
    device_.stick(faults_.sticks(seconds_at(now)));
    take_sent(now);
    send_late(now);
    serve_waiting(now);
    if (!open_) return End::host_left;
    const std::int64_t wait_ns = std::max<std::int64_t>(0, wait_until_ns(now, seconds) - now_ns());
    const timespec wait{.tv_sec = wait_ns / 1'000'000'000, .tv_nsec = wait_ns % 1'000'000'000};
    pollfd descriptor{.fd = socket_, .events = POLLIN, .revents = 0};
    if (ppoll(&descriptor, 1, &wait, nullptr) > 0 && !read_messages(now_ns())) return End::host_left;
  }
}

std::int64_t Session::wait_until_ns(std::int64_t now, double seconds) const {
  std::int64_t until = now + longest_wait_ns;
  const bool waited_for =
      std::ranges::any_of(endpoints_, [](const Endpoint& one) { return !one.waiting.empty(); });
  if (waited_for) {
    // A device that names a time gone by must not keep the processor from the host.
    if (const auto next = device_.next_event_ns(now))
      until = std::min(until, std::max(*next, now + shortest_wait_ns));
  }
  until = std::min(until, next_sent_ns(now));
  if (!late_.empty()) until = std::min(until, late_.front().due_ns);
  if (const auto at_s = faults_.unplugged_at_s()) {
    until = std::min(until, start_ns_ + static_cast<std::int64_t>(1e9 * *at_s));
  }
  if (seconds > 0.0) until = std::min(until, start_ns_ + static_cast<std::int64_t>(1e9 * seconds));
  return until;
}

bool Session::read_messages(std::int64_t now) {
  while (true) {
    const std::size_t before = received_.size();
    received_.resize(before + 4096);
    const ssize_t got = recv(socket_, received_.data() + before, 4096, MSG_DONTWAIT);
    received_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0 || (got < 0 && errno == ECONNRESET)) return false;
    if (got < 4096) break;  // that was all, or nothing
  }
  std::span<const std::uint8_t> rest = received_;
  while (rest.size() >= usbip::header_size) {
    const auto request = usbip::parse_request(rest.first<usbip::header_size>());
    if (!request) throw std::runtime_error("the host sent what is no USB/IP request");
    const bool has_data = request->kind == usbip::Request::Kind::submit && !request->in;
    const std::size_t size = usbip::header_size + (has_data ? request->length : 0);
    if (rest.size() < size) break;
    take(*request, rest.subspan(usbip::header_size, size - usbip::header_size), now);
    rest = rest.subspan(size);
  }
  received_.erase(received_.begin(), received_.end() - static_cast<std::ptrdiff_t>(rest.size()));
  return open_;
}

void Session::take(const usbip::Request& request, std::span<const std::uint8_t> data, std::int64_t now) {
  if (request.kind == usbip::Request::Kind::unlink) return unlink(request);
  if (request.endpoint == 0) return take_control(request, data, now);
  if (faults_.stalls(seconds_at(now))) return reply(request.sequence, stalled, {}, 0);
  if (request.in) {
    endpoints_[request.endpoint].waiting.push_back({request.sequence, request.length, now});
    return;
  }
  OutEndpoint& out = out_[request.endpoint];
  // Where nothing holds it up it is taken before the host says the next.
  if (out.waiting.empty() && now >= out.due_ns && !faults_.refuses_until_s(seconds_at(now))) {
    out.due_ns = out.interval_ns == 0 ? 0 : next_frame(now);
  }
  out.waiting.push_back({request.sequence, Bytes(data.begin(), data.end())});
  take_sent(now);
}

void Session::take_sent(std::int64_t now) {
  if (faults_.refuses_until_s(seconds_at(now))) return;
  for (std::size_t number = 1; number < out_.size(); ++number) {
    OutEndpoint& out = out_[number];
    while (!out.waiting.empty() && now >= out.due_ns) {
      const Sent sent = std::move(out.waiting.front());
      out.waiting.pop_front();
      if (out.interval_ns > 0) out.due_ns = (now / frame_ns) * frame_ns + out.interval_ns;
      device_.receive(static_cast<std::uint8_t>(number), sent.data, now);
      reply(sent.sequence, 0, {}, sent.data.size());
    }
  }
}

/// When something that the host has sent can be taken.
std::int64_t Session::next_sent_ns(std::int64_t now) const {
  std::int64_t next = std::numeric_limits<std::int64_t>::max();
  for (const OutEndpoint& out : out_) {
    if (!out.waiting.empty()) next = std::min(next, out.due_ns);
  }
  const auto refused_s = faults_.refuses_until_s(seconds_at(now));
  if (!refused_s || next == std::numeric_limits<std::int64_t>::max()) return next;
  return std::max(next, start_ns_ + static_cast<std::int64_t>(1e9 * *refused_s) + 1);
}

void Session::take_control(const usbip::Request& request, std::span<const std::uint8_t> data,
                           std::int64_t now) {
  const auto sent_back = answer(Setup::parse(request.setup), data, now);
  if (!sent_back) return reply(request.sequence, stalled, {}, 0);
  if (!request.in) return reply(request.sequence, 0, {}, data.size());
  reply_in(request.sequence,
           std::span(*sent_back).first(std::min<std::size_t>(sent_back->size(), request.length)));
}

std::optional<Bytes> Session::answer(const Setup& setup, std::span<const std::uint8_t> data,
                                     std::int64_t now) {
  if (setup.request_type == hid_class_out &&
      (setup.request == hid_set_idle || setup.request == hid_set_protocol)) {
    return Bytes{};
  }
  if ((setup.request_type & type_mask) != 0) return device_.control(setup, data, now);
  switch (setup.request) {
    case get_descriptor:
      return descriptor(setup);
    case get_status:
      return Bytes{0, 0};
    case get_configuration:
      return Bytes{1};
    case clear_feature:
    case set_feature:
    case set_configuration:
    case set_interface:
      return Bytes{};
    default:
      return std::nullopt;
  }
}

std::optional<Bytes> Session::descriptor(const Setup& setup) const {
  const Description& device = device_.description();
  const std::uint8_t index = setup.value & 0xFFU;
  switch (setup.value >> 8U) {
    case descriptor_device:
      return device.device;
    case descriptor_configuration:
      return index == 0 ? std::optional(device.configuration) : std::nullopt;
    case descriptor_string: {
      if (index == 0) return Bytes{4, descriptor_string, 0x09, 0x04};  // English, of the United States
      if (index > device.strings.size()) return std::nullopt;
      const std::string& text = device.strings[index - 1U];
      Bytes bytes{static_cast<std::uint8_t>(2 + 2 * text.size()), descriptor_string};
      for (const char letter : text) {
        bytes.push_back(static_cast<std::uint8_t>(letter));
        bytes.push_back(0);
      }
      return bytes;
    }
    case descriptor_report:
      return setup.index < device.reports.size() ? std::optional(device.reports[setup.index]) : std::nullopt;
    default:
      return std::nullopt;
  }
}

void Session::unlink(const usbip::Request& request) {
  for (OutEndpoint& out : out_) {
    if (std::erase_if(out.waiting, [&](const Sent& one) { return one.sequence == request.unlinked; }) > 0) {
      return write_all(usbip::unlink_reply(request.sequence, -ECONNRESET));
    }
  }
  if (std::erase_if(late_, [&](const Late& one) { return one.sequence == request.unlinked; }) > 0) {
    return write_all(usbip::unlink_reply(request.sequence, -ECONNRESET));
  }
  for (Endpoint& endpoint : endpoints_) {
    const auto found = std::ranges::find(endpoint.waiting, request.unlinked, &Waiting::sequence);
    if (found == endpoint.waiting.end()) continue;
    endpoint.waiting.erase(found);
    return write_all(usbip::unlink_reply(request.sequence, -ECONNRESET));
  }
  write_all(usbip::unlink_reply(request.sequence, 0));
}

void Session::serve_waiting(std::int64_t now) {
  for (std::size_t number = 1; number < endpoints_.size(); ++number) {
    Endpoint& endpoint = endpoints_[number];
    while (!endpoint.waiting.empty()) {
      const Waiting oldest = endpoint.waiting.front();
      const auto size = fetch(static_cast<std::uint8_t>(number), oldest, now);
      if (!size) break;
      endpoint.waiting.pop_front();
      endpoint.last_end_ns = now;
      const auto data = std::span(answer_).first(*size);
      const auto delay_ns = static_cast<std::int64_t>(1e9 * faults_.delay_s(seconds_at(now)));
      if (delay_ns > 0 || !late_.empty()) {
        const std::int64_t after_ns = late_.empty() ? 0 : late_.back().due_ns;
        late_.push_back(
            {std::max(now + delay_ns, after_ns), oldest.sequence, Bytes(data.begin(), data.end())});
      } else {
        reply_in(oldest.sequence, data);
      }
    }
  }
}

/// What the device has for a waiting transfer, into answer_, disturbed as the faults ask.
std::optional<std::size_t> Session::fetch(std::uint8_t number, const Waiting& oldest, std::int64_t now) {
  Endpoint& endpoint = endpoints_[number];
  answer_.resize(oldest.length);
  if (!endpoint.again.empty()) {
    const Bytes again = std::exchange(endpoint.again, {});
    const std::size_t size = std::min(again.size(), answer_.size());
    std::copy_n(again.begin(), size, answer_.begin());
    return size;
  }
  const Disturbance asked = faults_.due(seconds_at(now));
  Disturbance left = asked;
  const auto size = device_.send(number, answer_, std::max(oldest.since_ns, endpoint.last_end_ns), now, left);
  if (left != asked) faults_.done(asked, seconds_at(now));
  const std::size_t preamble = device_.preamble();
  if (!size || *size <= preamble) return size;
  if (const auto bit = faults_.flips(seconds_at(now))) {
    answer_[preamble + (*bit >> 3U) % (*size - preamble)] ^= static_cast<std::uint8_t>(1U << (*bit & 7U));
  }
  if (faults_.duplicates(seconds_at(now))) {
    endpoint.again.assign(answer_.begin(), answer_.begin() + static_cast<std::ptrdiff_t>(*size));
  }
  return size;
}

void Session::send_late(std::int64_t now) {
  while (!late_.empty() && late_.front().due_ns <= now) {
    const Late late = std::move(late_.front());
    late_.pop_front();
    reply_in(late.sequence, late.data);
  }
}

void Session::reply(std::uint32_t sequence, std::int32_t status, std::span<const std::uint8_t> data,
                    std::size_t actual) {
  const auto header = usbip::submit_reply(sequence, status, static_cast<std::uint32_t>(actual));
  Bytes message(header.begin(), header.end());
  message.insert(message.end(), data.begin(), data.end());
  write_all(message);
}

void Session::write_all(std::span<const std::uint8_t> bytes) {
  while (open_ && !bytes.empty()) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (errno != EINTR) {
      open_ = false;  // the host has left
    }
  }
}

}  // namespace kerf::emulators

#include "usbip.h"

#include <algorithm>
#include <string_view>

namespace kerf::emulators::usbip {
namespace {

constexpr std::uint16_t version = 0x0111;
constexpr std::uint32_t max_length = 1U << 20U;
constexpr std::size_t path_size = 256;
enum Command : std::uint32_t { cmd_submit = 1, cmd_unlink = 2, ret_submit = 3, ret_unlink = 4 };

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return static_cast<std::uint32_t>(bytes[at]) << 24U | static_cast<std::uint32_t>(bytes[at + 1]) << 16U |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8U | static_cast<std::uint32_t>(bytes[at + 3]);
}

void put_word(std::span<std::uint8_t> bytes, std::size_t at, std::uint32_t word) noexcept {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(word >> (24U - 8U * i));
}

void append16(Bytes& bytes, std::uint16_t number) {
  bytes.push_back(static_cast<std::uint8_t>(number >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(number));
}
void append32(Bytes& bytes, std::uint32_t number) {
  append16(bytes, static_cast<std::uint16_t>(number >> 16U));
  append16(bytes, static_cast<std::uint16_t>(number));
}
void append_text(Bytes& bytes, std::string_view text, std::size_t size) {
  const std::size_t begin = bytes.size();
  bytes.resize(begin + size);
  std::ranges::copy(text.substr(0, size - 1), bytes.begin() + static_cast<std::ptrdiff_t>(begin));
}

void append_operation(Bytes& bytes, std::uint16_t code, bool well) {
  append16(bytes, version);
  append16(bytes, code);
  append32(bytes, well ? 0 : 1);
}

void append_device(Bytes& bytes, const Description& device) {
  append_text(bytes, "/kerf-emulate/1-1", path_size);
  append_text(bytes, bus_id, bus_id_size);
  append32(bytes, 1);  // bus
  append32(bytes, 1);  // number on it; together they are what a request names as its device
  append32(bytes, static_cast<std::uint32_t>(device.speed));
  append16(bytes, device.vendor());
  append16(bytes, device.product());
  append16(bytes, static_cast<std::uint16_t>(device.device[12] | device.device[13] << 8));
  bytes.insert(bytes.end(), device.device.begin() + 4,
               device.device.begin() + 7);  // class, subclass, protocol
  bytes.push_back(device.configuration[5]);
  bytes.push_back(device.device[17]);
  bytes.push_back(device.configuration[4]);
}

}  // namespace

std::optional<Request> parse_request(std::span<const std::uint8_t, header_size> header) noexcept {
  const std::uint32_t command = word_at(header, 0);
  Request request{
      .sequence = word_at(header, 4), .device = word_at(header, 8), .in = word_at(header, 12) != 0};
  const std::uint32_t endpoint = word_at(header, 16);
  if (endpoint > 15) return std::nullopt;
  request.endpoint = static_cast<std::uint8_t>(endpoint);
  if (command == cmd_unlink) {
    request.kind = Request::Kind::unlink;
    request.unlinked = word_at(header, 20);
    return request;
  }
  request.length = word_at(header, 24);
  if (command != cmd_submit || request.length > max_length) return std::nullopt;
  std::copy(header.begin() + 40, header.end(), request.setup.begin());
  return request;
}

std::array<std::uint8_t, header_size> encode(const Request& request) noexcept {
  std::array<std::uint8_t, header_size> header{};
  const bool submit = request.kind == Request::Kind::submit;
  put_word(header, 0, submit ? cmd_submit : cmd_unlink);
  put_word(header, 4, request.sequence);
  put_word(header, 8, request.device);
  put_word(header, 12, request.in ? 1 : 0);
  put_word(header, 16, request.endpoint);
  if (!submit) {
    put_word(header, 20, request.unlinked);
    return header;
  }
  put_word(header, 24, request.length);
  std::ranges::copy(request.setup, header.begin() + 40);
  return header;
}

std::array<std::uint8_t, header_size> submit_reply(std::uint32_t sequence, std::int32_t status,
                                                   std::uint32_t actual) noexcept {
  std::array<std::uint8_t, header_size> header{};
  put_word(header, 0, ret_submit);
  put_word(header, 4, sequence);
  put_word(header, 20, static_cast<std::uint32_t>(status));
  put_word(header, 24, actual);
  return header;
}

std::array<std::uint8_t, header_size> unlink_reply(std::uint32_t sequence, std::int32_t status) noexcept {
  std::array<std::uint8_t, header_size> header{};
  put_word(header, 0, ret_unlink);
  put_word(header, 4, sequence);
  put_word(header, 20, static_cast<std::uint32_t>(status));
  return header;
}

std::optional<Operation> parse_operation(std::span<const std::uint8_t, operation_size> bytes) noexcept {
  const auto code = static_cast<std::uint16_t>(word_at(bytes, 0));
  if (code == static_cast<std::uint16_t>(Operation::list)) return Operation::list;
  if (code == static_cast<std::uint16_t>(Operation::import)) return Operation::import;
  return std::nullopt;
}

Bytes list_reply(const Description& device) {
  Bytes bytes;
  append_operation(bytes, 0x0005, true);
  append32(bytes, 1);
  append_device(bytes, device);
  // Class, subclass and protocol of each interface, and a byte of padding.
  const Bytes& all = device.configuration;
  for (std::size_t at = 0; at + 9 <= all.size() && all[at] > 0; at += all[at]) {
    if (all[at + 1] != 4) continue;
    bytes.insert(bytes.end(), {all[at + 5], all[at + 6], all[at + 7], 0});
  }
  return bytes;
}

Bytes import_reply(const Description& device, bool granted) {
  Bytes bytes;
  append_operation(bytes, 0x0003, granted);
  if (granted) append_device(bytes, device);
  return bytes;
}

}  // namespace kerf::emulators::usbip

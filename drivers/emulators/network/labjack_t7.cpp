#include "network/labjack_t7.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <kerf/drivers/usb/io_thread.h>

#include "devices/labjack_u6.h"

namespace kerf::emulators {
namespace {

using drivers::usb::now_ns;

constexpr unsigned stream_enable = 4990;
constexpr unsigned flash_at = 61810;
constexpr unsigned flash_from = 61812;
constexpr std::uint32_t constants_at = 0x003C4000;
constexpr std::uint16_t said_recovered = 2941;
constexpr std::int64_t longest_pause_ns = 2'000'000;
constexpr unsigned registers_of_inputs = 24;  // AIN0 to AIN11
constexpr std::uint8_t illegal_function = 1;  // of Modbus
constexpr std::uint8_t device_failure = 4;

void put16(Bytes& bytes, unsigned value) {
  bytes.push_back(static_cast<std::uint8_t>(value >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

unsigned get16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<unsigned>(bytes[at] << 8 | bytes[at + 1]);
}

/// Of a number in two registers: the upper half at the even address.
std::uint16_t half_of(std::uint32_t number, unsigned address) {
  return static_cast<std::uint16_t>(address % 2 == 0 ? number >> 16U : number);
}

}  // namespace

EmulatedT7::Options EmulatedT7::parse_options(drivers::Uri uri) {
  drivers::UriOptions given(std::move(uri));
  Options options;
  const auto port = [&](const char* name, double standard) {
    return static_cast<std::uint16_t>(given.number(name, {"1", standard, 0.0, 65535.0}));
  };
  options.address = given.text("address").value_or(options.address);
  options.port = port("port", 502.0);
  options.stream_port = port("stream_port", 702.0);
  options.wrench.force_n = given.number("force", {"N", options.wrench.force_n, 0.0, 1e4});
  options.wrench.torque_n_m = given.number("torque", {"Nm", options.wrench.torque_n_m, 0.0, 1e3});
  options.noise_codes = given.number("noise", {"1", 0.0, 0.0, 1e4});
  options.trim_ppm = given.number("trim", {"ppm", 0.0, -1e5, 1e5});
  options.drift_ppm = given.number("drift", {"ppm", 0.0, -500.0, 500.0});
  options.serial = static_cast<std::uint32_t>(given.count("serial", options.serial));
  options.trace = given.text("trace").value_or("");
  given.refuse_others();
  return options;
}

EmulatedT7::EmulatedT7(const Options& options, std::vector<Fault> faults)
    : options_(options),
      faults_(std::move(faults)),
      own_(open_port(Transport::connections, options.address, options.port)),
      own_stream_(open_port(Transport::connections, options.address, options.stream_port)),
      to_volts_(example_transducer().matrix.inverse()),
      noise_(1),
      began_ns_(now_ns()) {
  const double trim = 1.0 + 1e-6 * options_.trim_ppm;
  constants_ = {3.1580578e-4 * trim, -3.1580580e-4 * trim, 33523.0, -10.586956522};
  if (!options_.trace.empty()) {
    trace_.open(options_.trace);
    trace_ << "number,host_ns,fx,fy,fz,tx,ty,tz,left\n";
  }
  begin_anew();
}

void EmulatedT7::drop_clients() noexcept {
  clients_.clear();
  stream_client_.reset();
}

void EmulatedT7::begin_anew() {
  registers_.clear();
  set_word(55100, 0x00112233);
  set_number(60000, 7.0F);
  set_number(60002, 1.35F);
  set_number(60004, 1.0300F);
  set_word(60028, options_.serial);
  streaming_ = false;
  transaction_ = 0;
}

std::uint32_t EmulatedT7::word(unsigned address) const {
  const auto at = [&](unsigned one) {
    const auto found = registers_.find(one);
    return std::uint32_t{found == registers_.end() ? std::uint16_t{0} : found->second};
  };
  return at(address) << 16U | at(address + 1);
}

float EmulatedT7::number(unsigned address) const { return std::bit_cast<float>(word(address)); }

void EmulatedT7::set_word(unsigned address, std::uint32_t value) {
  registers_[address] = static_cast<std::uint16_t>(value >> 16U);
  registers_[address + 1] = static_cast<std::uint16_t>(value);
}

void EmulatedT7::set_number(unsigned address, float value) {
  set_word(address, std::bit_cast<std::uint32_t>(value));
}

std::uint16_t EmulatedT7::read_register(unsigned address) const {
  if (address < registers_of_inputs) {
    const float volts = address / 2 % 2 == 0 ? input_v_.at(address / 4) : 0.0F;
    return half_of(std::bit_cast<std::uint32_t>(volts), address);
  }
  if (address >= flash_from && address < flash_from + 64) {
    const std::size_t at = (word(flash_at) - constants_at) / 4 + (address - flash_from) / 2;
    return half_of(std::bit_cast<std::uint32_t>(at < 4 ? static_cast<float>(constants_.at(at)) : 0.0F),
                   address - flash_from);
  }
  const auto found = registers_.find(address);
  return found == registers_.end() ? std::uint16_t{0} : found->second;
}

bool EmulatedT7::read_registers(unsigned first, unsigned count, Bytes& into) const {
  // A stream has the inputs for itself; the rest can be asked for meanwhile.
  if (streaming_ && first < registers_of_inputs) return false;
  for (unsigned i = 0; i < count; ++i) put16(into, read_register(first + i));
  return true;
}

bool EmulatedT7::write_registers(unsigned first, std::span<const std::uint8_t> values) {
  bool taken = true;
  for (std::size_t i = 0; 2 * i < values.size(); ++i) {
    const auto value = static_cast<std::uint16_t>(get16(values, 2 * i));
    taken = write_register(first + static_cast<unsigned>(i), value) && taken;
  }
  return taken;
}

bool EmulatedT7::write_register(unsigned address, std::uint16_t value) {
  registers_[address] = value;
  if (address != stream_enable + 1) return true;
  if (value == 0) {
    if (!streaming_) return false;  // as a real one says: not running
    streaming_ = false;
    return true;
  }
  if (streaming_ || !(number(4002) > 0.0F) || word(4004) == 0) return false;
  streaming_ = true;
  stream_start_ns_ = now_ns();
  if (!world_start_ns_) world_start_ns_ = stream_start_ns_;
  scans_of_stream_ = 0;
  left_out_ = 0;
  return true;
}

void EmulatedT7::accept_clients() {
  const auto next_of = [](const OwnPort& own) {
    return processes::Descriptor(
        accept4(own.socket.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  };
  for (processes::Descriptor client = next_of(own_); client.number() >= 0; client = next_of(own_))
    clients_.push_back({.socket = std::move(client), .heard = {}});
  processes::Descriptor stream = next_of(own_stream_);
  if (stream.number() < 0) return;
  constexpr int on = 1;
  setsockopt(stream.number(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  stream_client_ = std::move(stream);
}

void EmulatedT7::listen_to(Client& client) {
  Bytes bytes(1024);
  const ssize_t size = recv(client.socket.number(), bytes.data(), bytes.size(), 0);
  if (size == 0 || (size < 0 && errno != EAGAIN)) {
    client.socket.reset();
    return;
  }
  if (size > 0) client.heard.insert(client.heard.end(), bytes.begin(), bytes.begin() + size);
  while (client.heard.size() >= 8) {
    const std::size_t length = 6 + get16(client.heard, 4);
    if (length < 8 || length > 1024) {
      client.socket.reset();  // no Modbus
      return;
    }
    if (client.heard.size() < length) return;
    const Bytes reply = reply_to(std::span(client.heard).first(length));
    (void)::send(client.socket.number(), reply.data(), reply.size(), MSG_NOSIGNAL);
    client.heard.erase(client.heard.begin(), client.heard.begin() + static_cast<std::ptrdiff_t>(length));
  }
}

Bytes EmulatedT7::reply_to(std::span<const std::uint8_t> request) {
  const std::uint8_t function = request[7];
  const auto asked = request.subspan(8);
  const unsigned first = asked.size() >= 4 ? get16(asked, 0) : 0;
  const unsigned second = asked.size() >= 4 ? get16(asked, 2) : 0;
  measure_inputs();
  Bytes data;
  std::uint8_t error = 0;
  if ((function == 3 || function == 4) && asked.size() >= 4) {  // to a T7 the same
    data.push_back(static_cast<std::uint8_t>(2 * second));
    if (!read_registers(first, second, data)) error = device_failure;
  } else if (function == 6 && asked.size() >= 4) {
    if (!write_register(first, static_cast<std::uint16_t>(second))) error = device_failure;
    data.assign(asked.begin(), asked.begin() + 4);
  } else if (function == 16 && asked.size() >= 5 && asked.size() >= 5 + 2 * std::size_t{second}) {
    if (!write_registers(first, asked.subspan(5, 2 * std::size_t{second}))) error = device_failure;
    data.assign(asked.begin(), asked.begin() + 4);
  } else if (function == 76) {
    if (!feedback(asked, data)) error = device_failure;
  } else {
    error = illegal_function;
  }
  if (error != 0) data = {error};
  Bytes reply(request.begin(), request.begin() + 4);
  put16(reply, static_cast<unsigned>(2 + data.size()));
  reply.push_back(request[6]);
  reply.push_back(error == 0 ? function : static_cast<std::uint8_t>(function | 0x80U));
  reply.insert(reply.end(), data.begin(), data.end());
  return reply;
}

/// Several accesses at once: 0 reads, 1 writes; address, how many registers.
bool EmulatedT7::feedback(std::span<const std::uint8_t> accesses, Bytes& data) {
  while (accesses.size() >= 4) {
    const bool writes = accesses[0] == 1;
    const unsigned first = get16(accesses, 1);
    const unsigned count = accesses[3];
    const std::size_t size = writes ? 2 * std::size_t{count} : 0;
    accesses = accesses.subspan(4);
    if (accesses.size() < size) return false;
    if (!(writes ? write_registers(first, accesses.first(size)) : read_registers(first, count, data)))
      return false;
    accesses = accesses.subspan(size);
  }
  return true;
}

double EmulatedT7::world_s(std::int64_t at_ns) const noexcept {
  return world_start_ns_ ? 1e-9 * static_cast<double>(at_ns - *world_start_ns_) : 0.0;
}

std::int64_t EmulatedT7::scan_ns(std::uint64_t scan) const noexcept {
  const double period_ns = 1e9 / static_cast<double>(number(4002)) * (1.0 + 1e-6 * options_.drift_ppm);
  return stream_start_ns_ + std::llround(period_ns * static_cast<double>(scan));
}

void EmulatedT7::run(const std::atomic<bool>& stop, double seconds) {
  const auto unplugged_at_s = faults_.unplugged_at_s();
  while (!stop.load()) {
    const std::int64_t now = now_ns();
    if (seconds > 0.0 && 1e-9 * static_cast<double>(now - began_ns_) >= seconds) return;
    if (unplugged_at_s && world_start_ns_ && world_s(now) >= *unplugged_at_s) return drop_clients();
    const bool without = world_start_ns_ && faults_.is_without_power(world_s(now));
    if (without && !without_power_) {
      drop_clients();
      begin_anew();
    }
    without_power_ = without;
    if (!without) {
      accept_clients();
      for (Client& client : clients_) listen_to(client);
      std::erase_if(clients_, [](const Client& client) { return client.socket.number() < 0; });
      send_due(now);
    }
    std::int64_t next = now + longest_pause_ns;
    if (streaming_) next = std::min(next, scan_ns(scans_of_stream_ + 1));
    // A request is answered at once, not after the pause.
    std::vector<pollfd> wanted{{.fd = own_.socket.number(), .events = POLLIN, .revents = 0}};
    for (const Client& client : clients_)
      wanted.push_back({.fd = client.socket.number(), .events = POLLIN, .revents = 0});
    const timespec wait{.tv_sec = 0, .tv_nsec = std::max<std::int64_t>(0, next - now_ns())};
    ppoll(wanted.data(), without ? 0 : wanted.size(), &wait, nullptr);
  }
}

EmulatedT7::Vector EmulatedT7::volts_of(const std::array<double, 6>& wrench) const {
  return to_volts_ * Eigen::Map<const Vector>(wrench.data()) + example_transducer().bias_v;
}

void EmulatedT7::measure_inputs() {
  const Vector volts = volts_of(options_.wrench.at(world_s(now_ns())));
  std::ranges::transform(volts, input_v_.begin(), [](double one) { return static_cast<float>(one); });
}

void EmulatedT7::send_due(std::int64_t at_ns) {
  while (streaming_ && scan_ns(scans_of_stream_ + 1) <= at_ns) send_scan(scan_ns(++scans_of_stream_));
}

void EmulatedT7::send_scan(std::int64_t taken_ns) {
  const double time_s = world_s(taken_ns);
  const auto acting = options_.wrench.at(time_s);
  const bool dropped = faults_.due(time_s) == Disturbance::drop;
  if (dropped) faults_.done(Disturbance::drop, time_s);
  const bool leaves = !dropped && !faults_.is_silent(time_s) && stream_client_.number() >= 0;
  if (trace_.is_open())
    trace_ << fmt::format("{},{},{},{}\n", scans_of_stream_, taken_ns, fmt::join(acting, ","),
                          leaves ? 1 : 0);
  ++(leaves ? sent_ : lost_);
  if (!leaves) {
    ++left_out_;
    return;
  }
  const Vector volts = volts_of(acting);
  Bytes packet;
  put16(packet, ++transaction_);
  put16(packet, 0);
  const unsigned samples = std::min<unsigned>(word(4004), 128);
  put16(packet, 10 + 2 * samples);
  packet.push_back(1);
  packet.push_back(76);
  put16(packet, 16);
  put16(packet, 0);
  put16(packet, left_out_ > 0 ? said_recovered : 0U);
  put16(packet, std::exchange(left_out_, 0));
  for (unsigned i = 0; i < samples; ++i) {
    const std::size_t input = std::min<std::size_t>(word(4100 + 2 * i) / 4, 5);
    const double above = volts[static_cast<Eigen::Index>(input)];
    const double slope = above < 0.0 ? -constants_[1] : constants_[0];
    const double code = constants_[2] + above / slope + options_.noise_codes * noise_();
    put16(packet, static_cast<unsigned>(std::lround(std::clamp(code, 0.0, 65535.0))));
  }
  (void)::send(stream_client_.number(), packet.data(), packet.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

std::string EmulatedT7::tell() const { return fmt::format("{} scans sent, {} left out", sent_, lost_); }

}  // namespace kerf::emulators

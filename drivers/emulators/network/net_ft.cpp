#include "network/net_ft.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <kerf/drivers/usb/io_thread.h>

#include "network/net_ft_pages.h"

namespace kerf::emulators {
namespace {

using drivers::usb::now_ns;

constexpr double ati_readings_hz = 7000.0;
constexpr double onrobot_readings_hz = 1000.0;
constexpr double onrobot_first_rate_hz = 100.0;
constexpr std::uint64_t onrobot_first_filter = 4;
constexpr double torque_share_of_noise = 0.05;
constexpr std::int64_t between_pages_ns = 5'000'000;  // then it looks after its pages

double first_rate_hz(const EmulatedNetFt::Options& options) {
  return options.is_ati ? options.rate_hz : onrobot_first_rate_hz;
}

void append(Bytes& bytes, std::uint32_t word) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

/// N, or N·m, of what a unit of its page is; the names that boxes have.
double si_of(std::string unit) {
  std::erase(unit, '-');
  constexpr double pound = 4.4482216152605;
  if (unit == "lbf") return pound;
  if (unit == "lbfin") return pound * 0.0254;
  if (unit == "Nmm") return 1e-3;
  if (unit == "kN" || unit == "kNm") return 1e3;
  return 1.0;
}

}  // namespace

EmulatedNetFt::Options EmulatedNetFt::parse_options(drivers::Uri uri) {
  const bool is_ati = uri.name == "net-ft";
  drivers::UriOptions given(std::move(uri));
  Options options{.is_ati = is_ati};
  const auto port = [&](const char* name, double standard) {
    return static_cast<std::uint16_t>(given.number(name, {"1", standard, 0.0, 65535.0}));
  };
  options.address = given.text("address").value_or(options.address);
  options.port = port("port", 49152.0);
  if (is_ati) options.http_port = port("http", 80.0);
  if (is_ati) options.rate_hz = given.number("rate", {"Hz", 1000.0, 1.0, 7000.0});
  options.wrench.force_n = given.number("force", {"N", options.wrench.force_n, 0.0, 1e4});
  options.wrench.torque_n_m = given.number("torque", {"Nm", options.wrench.torque_n_m, 0.0, 1e3});
  options.noise_n = given.number("noise", {"N", 0.0, 0.0, 1e3});
  options.counts_per_force = given.number("counts_per_force", {"1", is_ati ? 1e6 : 1e4, 0.0, 1e9});
  options.counts_per_torque = given.number("counts_per_torque", {"1", is_ati ? 1e6 : 1e5, 0.0, 1e9});
  options.force_unit = given.text("force_unit").value_or(options.force_unit);
  options.torque_unit = given.text("torque_unit").value_or(options.torque_unit);
  options.drift_ppm = given.number("drift", {"ppm", 0.0, -500.0, 500.0});
  options.delay_s = given.number("delay", {"s", 0.0, 0.0, 1.0});
  options.loss = given.number("loss", {"1", 0.0, 0.0, 1.0});
  options.seed = given.count("seed", 1);
  options.boot_s = given.number("boot", {"s", 0.0, 0.0, 1e3});
  options.stops_at_bias = given.flag("stops_at_bias", false);
  options.trace = given.text("trace").value_or("");
  given.refuse_others();
  return options;
}

EmulatedNetFt::EmulatedNetFt(const Options& options, std::vector<Fault> faults)
    : options_(options),
      faults_(std::move(faults)),
      own_(open_port(Transport::datagrams, options.address, options.port)),
      noise_(options.seed),
      losses_(options.seed),
      began_ns_(now_ns()),
      filter_(options.is_ati ? 0 : onrobot_first_filter) {
  options_.rate_hz = first_rate_hz(options_);
  if (options_.is_ati) {
    pages_ = std::make_unique<Pages>(options_.address, options_.http_port);
    pages_->serve("/netftapi2.xml", [this] { return page(); });
    pages_->serve("/netftcalapi.xml", [this] { return calibration_page(); });
    pages_->take_settings([this](const std::string& name, const std::string& value) { set(name, value); });
  }
  if (!options_.trace.empty()) {
    trace_.open(options_.trace);
    trace_ << "rdt_sequence,ft_sequence,host_ns,fx,fy,fz,tx,ty,tz,left\n";
  }
}

EmulatedNetFt::~EmulatedNetFt() = default;

std::uint16_t EmulatedNetFt::http_port() const noexcept { return pages_ ? pages_->port() : std::uint16_t{0}; }

double EmulatedNetFt::world_s(std::int64_t at_ns) const noexcept {
  return world_start_ns_ ? 1e-9 * static_cast<double>(at_ns - *world_start_ns_) : 0.0;
}

std::int64_t EmulatedNetFt::record_ns(std::uint64_t record) const noexcept {
  const double period_ns = 1e9 / options_.rate_hz * (1.0 + 1e-6 * options_.drift_ppm);
  return stream_start_ns_ + std::llround(period_ns * static_cast<double>(record));
}

std::int64_t EmulatedNetFt::next_event_ns(std::int64_t now_ns) const noexcept {
  std::int64_t next = now_ns + between_pages_ns;
  if (streaming_) next = std::min(next, record_ns(sent_of_stream_ + 1));
  if (!late_.empty()) next = std::min(next, late_.front().due_ns);
  return next;
}

void EmulatedNetFt::run(const std::atomic<bool>& stop, double seconds) {
  const auto unplugged_at_s = faults_.unplugged_at_s();
  while (!stop.load()) {
    const std::int64_t now = now_ns();
    const double since_s = 1e-9 * static_cast<double>(now - began_ns_);
    if (seconds > 0.0 && since_s >= seconds) return;
    if (unplugged_at_s && world_start_ns_ && world_s(now) >= *unplugged_at_s) return;
    const bool without = world_start_ns_ && faults_.is_without_power(world_s(now));
    if (without && !without_power_) lose_power();
    if (!without && without_power_) powered_ns_ = now;
    without_power_ = without;
    if (since_s >= options_.boot_s && !without) {
      take_requests(now);
      send_due(now);
      send_late(now);
      if (pages_) pages_->look_after();
    }
    const std::int64_t left = std::max<std::int64_t>(0, next_event_ns(now) - now_ns());
    pollfd wanted{
        .fd = own_.socket.number(), .events = static_cast<short>(without ? 0 : POLLIN), .revents = 0};
    const timespec most{.tv_sec = 0, .tv_nsec = left};
    ppoll(&wanted, 1, &most, nullptr);
  }
}

void EmulatedNetFt::lose_power() {
  streaming_ = false;
  late_.clear();
  held_back_.clear();
  options_.rate_hz = options_.is_ati ? options_.rate_hz : onrobot_first_rate_hz;
  filter_ = options_.is_ati ? filter_ : onrobot_first_filter;
  offsets_ = {};
  // What was asked meanwhile finds nobody.
  Bytes unread(64);
  while (recv(own_.socket.number(), unread.data(), unread.size(), 0) >= 0) {
  }
}

void EmulatedNetFt::take_requests(std::int64_t now_ns) {
  std::array<std::uint8_t, 64> bytes{};
  while (true) {
    sockaddr_in from{};
    socklen_t length = sizeof from;
    const ssize_t size =
        recvfrom(own_.socket.number(), bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from),
                 &length);  // NOLINT(*-reinterpret-cast)
    if (size < 0) return;
    const bool marked = size == 8 && bytes[0] == 0x12 && bytes[1] == 0x34;
    if (!marked) {
      ++seen_.wrong_requests;  // a box says nothing to that
      continue;
    }
    const auto command = static_cast<std::uint16_t>(bytes[2] << 8U | bytes[3]);
    std::uint32_t count = 0;
    for (std::size_t i = 4; i < 8; ++i) count = count << 8U | bytes[i];
    if (command == 0x0002) host_ = from;
    obey(command, count, now_ns);
  }
}

void EmulatedNetFt::obey(std::uint16_t command, std::uint32_t count, std::int64_t now_ns) {
  switch (command) {
    case 0x0000:
      streaming_ = false;
      break;
    case 0x0002:
      start(count, now_ns);
      break;
    case 0x0041:
      break;  // no threshold is ever latched
    case 0x0042:
      set_bias(options_.is_ati || count == 255, now_ns);
      break;
    case 0x0081:
      if (!options_.is_ati && count <= 6) filter_ = count;
      break;
    case 0x0082:
      if (options_.is_ati) break;
      if (count == 0) streaming_ = false;
      if (count > 0 && count <= 255) {
        options_.rate_hz = 1e3 / count;
        stream_start_ns_ = now_ns;
        sent_of_stream_ = 0;
      }
      break;
    default:
      ++seen_.wrong_requests;
  }
}

void EmulatedNetFt::start(std::uint32_t count, std::int64_t now_ns) {
  ++seen_.starts;
  if (!world_start_ns_) world_start_ns_ = now_ns;
  streaming_ = true;
  wanted_ = count;
  stream_start_ns_ = now_ns;
  sent_of_stream_ = 0;
  rdt_sequence_ = 0;
}

void EmulatedNetFt::set_bias(bool on, std::int64_t now_ns) {
  ++seen_.biases;
  offsets_ = {};
  if (on) {
    const auto now = options_.wrench.at(world_s(now_ns));
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double per = i < 3 ? options_.counts_per_force / si_of(options_.force_unit)
                               : options_.counts_per_torque / si_of(options_.torque_unit);
      offsets_[i] = static_cast<std::int32_t>(std::lround(per * now[i]));
    }
  }
  if (options_.stops_at_bias) streaming_ = false;
}

void EmulatedNetFt::send_due(std::int64_t now_ns) {
  while (streaming_ && record_ns(sent_of_stream_ + 1) <= now_ns) {
    ++sent_of_stream_;
    send_record(record_ns(sent_of_stream_));
    if (wanted_ > 0 && sent_of_stream_ >= wanted_) streaming_ = false;
  }
}

Bytes EmulatedNetFt::record_at(double time_s, double faulty_s) {
  const double readings_hz = options_.is_ati ? ati_readings_hz : onrobot_readings_hz;
  const double powered_s = powered_ns_ ? time_s - world_s(*powered_ns_) : time_s;
  auto reading = static_cast<std::uint32_t>(std::llround(std::max(0.0, powered_s) * readings_hz));
  if (faults_.sticks(faulty_s)) {
    reading = stuck_at_.value_or(reading);
    stuck_at_ = reading;
  } else {
    stuck_at_.reset();
  }
  std::uint32_t status = 0;
  if (faults_.is_overloaded(faulty_s)) status = options_.is_ati ? 0x80020000U : 0x0010U;
  Bytes bytes;
  append(bytes, ++rdt_sequence_);
  append(bytes, reading);
  append(bytes, status);
  const auto acting = options_.wrench.at(time_s);
  for (std::size_t i = 0; i < acting.size(); ++i) {
    const bool force = i < 3;
    const double per = force ? options_.counts_per_force / si_of(options_.force_unit)
                             : options_.counts_per_torque / si_of(options_.torque_unit);
    const double noise = options_.noise_n * (force ? 1.0 : torque_share_of_noise) * noise_();
    const double counts = std::clamp(per * (acting[i] + noise) - offsets_[i], -2147483648.0, 2147483647.0);
    append(bytes, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(counts))));
  }
  return bytes;
}

void EmulatedNetFt::send_record(std::int64_t taken_ns) {
  const double time_s = world_s(taken_ns);
  Bytes bytes = record_at(time_s, time_s);
  const bool drawn = static_cast<double>(losses_() >> 11U) * 0x1p-53 < options_.loss;
  const bool dropped = faults_.due(time_s) == Disturbance::drop;
  if (dropped) faults_.done(Disturbance::drop, time_s);
  const bool leaves = !drawn && !dropped && !faults_.is_silent(time_s);
  if (trace_.is_open()) {
    const auto acting = options_.wrench.at(time_s);
    trace_ << fmt::format("{},{},{},{},{}\n", rdt_sequence_,
                          std::uint32_t{bytes[4]} << 24U | std::uint32_t{bytes[5]} << 16U |
                              std::uint32_t{bytes[6]} << 8U | std::uint32_t{bytes[7]},
                          taken_ns, fmt::join(acting, ","), leaves ? 1 : 0);
  }
  ++(leaves ? seen_.records : seen_.dropped);
  if (!leaves) return;
  if (faults_.due(time_s) == Disturbance::corrupt) {
    faults_.done(Disturbance::corrupt, time_s);
    bytes.resize(rdt_sequence_ % 2 == 0 ? bytes.size() + 1 : bytes.size() - 1);
  }
  const std::int64_t due_ns = taken_ns + std::llround(1e9 * (options_.delay_s + faults_.delay_s(time_s)));
  if (held_back_.empty() && faults_.swaps(time_s)) {
    held_back_ = std::move(bytes);
    return;
  }
  leave(bytes, due_ns);
  if (faults_.duplicates(time_s)) leave(bytes, due_ns);
  if (!held_back_.empty()) leave(std::exchange(held_back_, {}), due_ns);
}

void EmulatedNetFt::leave(const Bytes& bytes, std::int64_t due_ns) {
  // What is late does not overtake, and is not overtaken.
  if (!late_.empty()) due_ns = std::max(due_ns, late_.back().due_ns);
  late_.push_back({.due_ns = due_ns, .bytes = bytes});
}

void EmulatedNetFt::send_late(std::int64_t now_ns) {
  while (!late_.empty() && late_.front().due_ns <= now_ns) {
    const Bytes& bytes = late_.front().bytes;
    // Who no longer listens is not known to a box.
    (void)sendto(own_.socket.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                 reinterpret_cast<const sockaddr*>(&host_),
                 sizeof host_);  // NOLINT(*-reinterpret-cast)
    late_.pop_front();
  }
}

std::string EmulatedNetFt::page() const {
  const auto now = options_.wrench.at(world_s(now_ns()));
  std::array<long, 6> counts{};
  for (std::size_t i = 0; i < now.size(); ++i)
    counts[i] = std::lround((i < 3 ? options_.counts_per_force : options_.counts_per_torque) * now[i]);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<netft>\n<prodname>Emulated Net "
      "F/T</prodname>\n<runstat>0x00000000</runstat>\n"
      "<runft>{}</runft>\n<setbias>{}</setbias>\n<setuserfilter>{}</setuserfilter>\n"
      "<cfgcalsn>FT00001</cfgcalsn>\n<scfgfu>{}</scfgfu>\n<scfgtu>{}</scfgtu>\n<cfgcpf>{}</cfgcpf>\n"
      "<cfgcpt>{}</cfgcpt>\n<cfgtfx>0;0;0;0;0;0</cfgtfx>\n<comrdte>Enabled</comrdte>\n"
      "<comrdtrate>{:.0f}</comrdtrate>\n<comrdtbsiz>1</comrdtbsiz>\n</netft>\n",
      fmt::join(counts, ";"), fmt::join(offsets_, ";"), filter_, options_.force_unit, options_.torque_unit,
      options_.counts_per_force, options_.counts_per_torque, options_.rate_hz);
}

std::string EmulatedNetFt::calibration_page() const {
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<netftCalibration>\n<calsn>FT00001</calsn>\n<calcpf>{}</calcpf>\n"
      "<calcpt>{}</calcpt>\n<scalfu>{}</scalfu>\n<scaltu>{}</scaltu>\n</netftCalibration>\n",
      options_.counts_per_force, options_.counts_per_torque, options_.force_unit, options_.torque_unit);
}

void EmulatedNetFt::set(const std::string& name, const std::string& value) {
  const double number = std::strtod(value.c_str(), nullptr);
  if (name == "setuserfilter" && number >= 0.0 && number <= 8.0) filter_ = static_cast<std::uint64_t>(number);
  if (name == "comrdtrate" && number >= 1.0 && number <= ati_readings_hz) {
    options_.rate_hz = number;
    stream_start_ns_ = now_ns();
    sent_of_stream_ = 0;
  }
  if (name == "setbias0") offsets_ = {};  // all six stand in one request
}

std::string EmulatedNetFt::tell() const {
  return fmt::format("{} starts, {} records sent, {} left out, {} biases, {} requests that are none",
                     seen_.starts, seen_.records, seen_.dropped, seen_.biases, seen_.wrong_requests);
}

}  // namespace kerf::emulators

#include "force/net_ft_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "kerf/drivers/streaming_force_sensors.h"
#include "kerf/drivers/usb/io_thread.h"
#include "network/http_get.h"

namespace kerf::drivers {
namespace {

using net_ft::Box;
using net_ft::Command;

constexpr double ati_readings_hz = 7000.0;  // it sends every n-th of its own readings
constexpr std::int32_t most_out_of_order = 1000;
// OnRobot's manual, where its page is left at newtons.
constexpr double onrobot_counts_per_n = 10'000.0;
constexpr double onrobot_counts_per_n_m = 100'000.0;
constexpr double onrobot_rate_hz = 1000.0;
constexpr std::uint32_t onrobot_bias = 255;

std::uint16_t port_in(UriOptions& given, const std::string& name, std::uint16_t standard) {
  return static_cast<std::uint16_t>(given.number(name, {"1", static_cast<double>(standard), 1.0, 65535.0}));
}

NetFtOptions options_in(Box box, std::string_view host, UriOptions& given) {
  NetFtOptions options{.box = box, .host = std::string(host)};
  const bool is_ati = box == Box::ati;
  options.port = port_in(given, "port", net_ft::port);
  options.has_page = is_ati && given.flag("page", true);
  if (is_ati) options.http_port = port_in(given, "http", 80);
  options.counts_per_n = given.number("counts_per_n", {"1", is_ati ? 0.0 : onrobot_counts_per_n, 0.0, 1e12});
  options.counts_per_n_m =
      given.number("counts_per_nm", {"1", is_ati ? 0.0 : onrobot_counts_per_n_m, 0.0, 1e12});
  const double rate = given.number("rate", {"Hz", is_ati ? 0.0 : onrobot_rate_hz, 0.0, 7812.0});
  if (rate > 0.0) options.rate_hz = rate;
  if (!is_ati) {
    options.filter = given.number("filter", {"1", 0.0, 0.0, 6.0});
    const double period_ms = 1e3 / rate;
    if (!(rate > 0.0) || period_ms > 255.0 || std::abs(period_ms - std::round(period_ms)) > 1e-9 ||
        options.filter != std::floor(options.filter)) {
      throw DeviceError(
          fmt::format("onrobot:{}: it sends every whole number of milliseconds and has filters 0 to 6; "
                      "expected for example rate=1000Hz, rate=500Hz, filter=0",
                      host));
    }
  }
  options.bias = given.flag("bias", false);
  return options;
}

void check(const NetFtOptions& options) {
  if (options.has_page || (options.counts_per_n > 0.0 && options.counts_per_n_m > 0.0 && options.rate_hz))
    return;
  throw DeviceError(
      fmt::format("net-ft:{}: without its page nobody knows what a count is; give all of counts_per_n, "
                  "counts_per_nm and rate, as the page 'Configurations' of the box has them",
                  options.host));
}

}  // namespace

std::unique_ptr<Device> open_net_ft(std::string_view uri, Box box, std::string_view host, Uri parsed) {
  UriOptions given(std::move(parsed));
  const NetFtOptions options = options_in(box, host, given);
  const auto common = StreamingForceSensor::parse_options(given);
  given.refuse_others();
  check(options);
  return std::make_unique<StreamingForceSensor>(uri, std::make_unique<NetFtSource>(uri, options), common);
}

NetFtSource::NetFtSource(std::string_view uri, const NetFtOptions& options)
    : uri_(uri),
      options_(options),
      page_{.product = options.box == Box::ati ? "Net F/T" : "EtherDAQ",
            .counts_per_n = options.counts_per_n,
            .counts_per_n_m = options.counts_per_n_m,
            .rate_hz = options.rate_hz} {
  try {
    address_ = address_of(options_.host);
    sole_use_ = std::make_unique<SoleUse>(fmt::format("kerf-force-{}-{}", address_, options_.port));
    socket_ = std::make_unique<Datagrams>(address_, options_.port);
  } catch (const std::runtime_error& error) {
    refuse(error.what());
  }
  if (options_.has_page) read_page();
  socket_->send(net_ft::request(Command::stop, 0));
  if (options_.bias)
    socket_->send(net_ft::request(Command::bias, options_.box == Box::ati ? 0 : onrobot_bias));
}

void NetFtSource::refuse(const std::string& why) const {
  throw DeviceError(fmt::format("{}: {}", uri_, why));
}

void NetFtSource::read_page() {
  try {
    page_ = net_ft::parse_page(
        http_get({.address = address_, .port = options_.http_port, .target = "/netftapi2.xml"}));
  } catch (const std::exception& error) {
    refuse(fmt::format(
        "the page http://{}:{}/netftapi2.xml, in which a Net F/T says its units: {}; look whether that is "
        "its address, or say page=off&counts_per_n=...&counts_per_nm=...&rate=...",
        address_, options_.http_port, error.what()));
  }
  if (page_.enabled == false)
    refuse("its page says that RDT is off; switch it on there, under 'Communications'");
  if (options_.rate_hz) page_.rate_hz = options_.rate_hz;
}

void NetFtSource::ask() noexcept {
  if (options_.box == Box::onrobot) {
    // Both are forgotten when it is switched off.
    const auto period_ms = static_cast<std::uint32_t>(std::lround(1e3 / *options_.rate_hz));
    socket_->send(net_ft::request(Command::filter, static_cast<std::uint32_t>(options_.filter)));
    socket_->send(net_ft::request(Command::period, period_ms));
  }
  socket_->send(net_ft::request(Command::start, 0));
  asked_again_ = true;
}

void NetFtSource::take(ForceIntake& intake) noexcept {
  std::array<std::uint8_t, net_ft::record_size + 1> bytes{};
  while (const auto size = socket_->receive(bytes)) {
    const auto record =
        *size <= bytes.size() ? net_ft::parse_record(std::span(bytes).first(*size)) : std::nullopt;
    if (record) {
      intake.take(frame_of(*record));
    } else {
      last_wrong_size_ = *size;
      intake.take_wrong();
    }
  }
}

ForceFrame NetFtSource::frame_of(const net_ft::Record& record) noexcept {
  ForceFrame frame{.arrived_ns = usb::now_ns(), .health = net_ft::health_of(options_.box, record.status)};
  const bool asked_again = std::exchange(asked_again_, false);
  if (last_) {
    frame.step = static_cast<std::int32_t>(record.rdt_sequence - last_->rdt_sequence);
    frame.begins_anew = frame.step < -most_out_of_order || (asked_again && frame.step <= 0);
    // What OnRobot's count does at its fastest is not known.
    frame.stands = options_.box == Box::ati && record.ft_sequence == last_->ft_sequence;
  }
  if (frame.begins_anew || frame.step > 0) last_ = record;
  for (std::size_t i = 0; i < record.counts.size(); ++i)
    frame.wrench[i] = record.counts[i] / (i < 3 ? page_.counts_per_n : page_.counts_per_n_m);
  frame.extras[0] = record.ft_sequence;
  frame.extras[1] = record.status;
  return frame;
}

std::optional<double> NetFtSource::rate_near(double measured_hz) const {
  if (options_.rate_hz) return std::nullopt;  // somebody said it
  // It rounds what it was asked for to what its own rate divides into.
  return ati_readings_hz / std::max(1.0, std::round(ati_readings_hz / measured_hz));
}

std::string NetFtSource::silence(std::uint64_t wrong) const {
  if (wrong > 0) {
    return fmt::format(
        "what it sends has {} bytes, and a record has {}: another program at port {}, or one that sends "
        "several records at once",
        last_wrong_size_, net_ft::record_size, options_.port);
  }
  if (socket_->refused())
    return fmt::format("nobody listens at UDP port {} of {}; look whether that is its address", options_.port,
                       address_);
  return fmt::format(
      "it sends nothing from UDP port {} of {}; look whether it is on, whether RDT is enabled in its "
      "settings "
      "and whether a firewall stands between",
      options_.port, address_);
}

DeviceInfo NetFtSource::describe() const {
  const auto told = [](const std::optional<std::string>& text) {
    return text ? fmt::format("\"{}\"", *text) : std::string("\"unknown\"");
  };
  std::string filter = told(page_.filter);
  if (options_.box == Box::onrobot) {
    const double corner = *net_ft::onrobot_corner_hz(static_cast<std::uint64_t>(options_.filter));
    filter = corner > 0.0 ? fmt::format("\"{:g} Hz\"", corner) : std::string("\"none\"");
  }
  return {.model = page_.product,
          .about = std::string(options_.box == Box::ati ? about_net_ft : about_onrobot),
          .channels = {{.name = "force_counter", .unit = "1"}, {.name = "force_status", .unit = "1"}},
          .configuration = fmt::format(
              "address = \"{}\"\nport = {}\ncounts_per_n = {}\ncounts_per_nm = {}\n"
              "# Its own number where the corner is not known; the delay that it makes is in no time stamp.\n"
              "filter = {}\ngauge_bias = {} # as its page had it before\nbias_taken = {}\n"
              "tool_transform = {} # of the box, whose frame this is\n",
              address_, options_.port, page_.counts_per_n, page_.counts_per_n_m, filter, told(page_.bias),
              options_.bias, told(page_.tool)),
          .serial = page_.serial};
}

std::string NetFtSource::trouble() const {
  const std::uint32_t status = last_ ? last_->status : 0;
  return fmt::format("its status is 0x{:08x}, {}", status, net_ft::in_words(options_.box, status));
}

}  // namespace kerf::drivers

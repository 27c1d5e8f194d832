#include "kerf/drivers/protocols/inverse3.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include "built_in.h"
#include "kerf/drivers/uri.h"
#include "network/http_get.h"
#include "own_device.h"
#include "work.h"

namespace kerf::host {
namespace {

using namespace drivers;
using inverse3::State;
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds connect_patience{1000};
constexpr milliseconds inventory_patience{700};
constexpr milliseconds answer_patience{10};
constexpr milliseconds goodbye_patience{50};
constexpr std::int64_t ask_again_ns = 100'000'000;
constexpr std::int64_t absent_ns = 500'000'000;
constexpr double usual_force_n = 3.0;
constexpr double most_force_n = 5.0;
/// The maker's tutorials draw spheres of that radius in the workspace.
constexpr double reach_m = 0.1;
constexpr double reach_of_minverse_m = 0.04;

/// A connection to a service, each step of which a clock can end.
class Connection {
 public:
  Connection(const std::string& address, std::uint16_t port) : stream_(io_) {
    const tcp::endpoint there(asio::ip::make_address(address), port);
    bool done = false;
    error_code failed = asio::error::timed_out;
    beast::get_lowest_layer(stream_).async_connect(there, [&](error_code error) {
      failed = error;
      if (error) return void(done = true);
      beast::get_lowest_layer(stream_).expires_never();
      beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), failed);
      stream_.read_message_max(inverse3::longest_message);
      stream_.async_handshake(fmt::format("{}:{}", address, port), "/", [&](error_code shaken) {
        failed = shaken;
        done = true;
      });
    });
    run_until(connect_patience, done);
    if (!done) failed = asio::error::timed_out;
    if (failed) {
      close_socket();
      io_.poll();  // what it had begun ends with it
      throw std::runtime_error(failed.message());
    }
    read();
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() {
    try {
      say_goodbye();
    } catch (const std::exception&) {  // there is nobody to be told
    }
  }

  /// False where it is gone, or has not taken it in time.
  bool send(std::string text) {
    outgoing_ = std::move(text);
    bool done = false;
    stream_.text(true);
    stream_.async_write(asio::buffer(outgoing_), [&](error_code error, std::size_t) {
      done = true;
      if (error) gone_ = error;
    });
    run_until(answer_patience, done);
    if (!done) {
      gone_ = asio::error::timed_out;
      close_socket();
      run_until(answer_patience, done);
    }
    return !gone_;
  }

  /// The next message, if it comes in time.
  std::optional<std::string> receive(milliseconds patience) {
    run_until(patience, has_message_);
    if (!has_message_ || gone_) return std::nullopt;
    std::string text = beast::buffers_to_string(incoming_.data());
    incoming_.clear();
    has_message_ = false;
    read();
    return text;
  }

  [[nodiscard]] const error_code& gone() const noexcept { return gone_; }
  /// The service hears of it whoever has the connection too.
  void cut() noexcept {
    (void)::shutdown(beast::get_lowest_layer(stream_).socket().native_handle(), SHUT_RDWR);
  }

 private:
  void say_goodbye() {
    if (!gone_) {
      bool done = false;
      stream_.async_close(websocket::close_code::normal, [&](error_code) { done = true; });
      run_until(goodbye_patience, done);
      close_socket();
      run_until(goodbye_patience, done);
    }
    close_socket();
    io_.restart();
    io_.poll();
  }
  void read() {
    stream_.async_read(incoming_, [this](error_code error, std::size_t) {
      has_message_ = true;
      if (error) gone_ = error;
    });
  }
  void run_until(milliseconds patience, const bool& done) {
    const auto until = steady_clock::now() + patience;
    io_.restart();
    io_.poll();
    while (!done && steady_clock::now() < until) {
      io_.restart();
      io_.run_one_until(until);
    }
  }
  void close_socket() noexcept {
    error_code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
  }

  asio::io_context io_{1};
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer incoming_;
  std::string outgoing_;
  bool has_message_ = false;
  error_code gone_;
};

struct Place {
  std::string address;
  std::uint16_t port = inverse3::port;
};

/// An Inverse3 behind the service of its maker: one message, one state.
class Inverse3 {
 public:
  static constexpr const char* name = "inverse3";
  static constexpr std::array<const char*, 6> options{"address", "port",       "device",
                                                      "message", "most_force", nullptr};
  static std::unique_ptr<Inverse3> open(UriOptions& given) {
    Place place{.address = given.text("address").value_or("localhost")};
    if (place.address == "localhost") place.address = "127.0.0.1";
    place.port = static_cast<std::uint16_t>(given.number("port", {"1", inverse3::port, 1.0, 65535.0}));
    std::optional<inverse3::Naming> naming;
    if (const auto message = given.text("message")) {
      if (*message != "values" && *message != "vector")
        throw std::runtime_error(fmt::format("message={}: expected values or vector", *message));
      naming = *message == "values" ? inverse3::Naming::values : inverse3::Naming::vector;
    }
    const double most = given.number("most_force", {"N", usual_force_n, 0.1, most_force_n});
    return std::make_unique<Inverse3>(place, given.text("device").value_or(""), naming, most);
  }

  Inverse3(const Place& place, std::string device, std::optional<inverse3::Naming> naming, double most_n)
      : device_(std::move(device)), most_n_(most_n) {
    try {
      connection_ = std::make_unique<Connection>(place.address, place.port);
    } catch (const std::exception& error) {
      throw std::runtime_error(
          fmt::format("no Inverse Service answers at {}:{} ({}); 'systemctl status haply-inverse-service' "
                      "says whether it runs",
                      place.address, place.port, error.what()));
    }
    const auto inventory = connection_->receive(inventory_patience);
    if (!inventory)
      throw std::runtime_error("the service says nothing of its devices; is it an Inverse Service?");
    const auto state = inverse3::parse(*inventory, device_);
    if (!state) {
      throw std::runtime_error(device_.empty() ? "the service has no Inverse3; plug it in and switch it on"
                                               : fmt::format("the service has no Inverse3 '{}'", device_));
    }
    if (state->in_use.value_or(false))
      throw std::runtime_error(fmt::format("another program has the Inverse3 {}", state->device));
    if (!state->calibrated.value_or(true))
      throw std::runtime_error(
          fmt::format("the Inverse3 {} is not calibrated; do that with the maker's program", state->device));
    device_ = state->device;
    told_ = *state;
    naming_ = naming.value_or(version(place));
  }

  void describe(kerf_device_facts_v1& facts) const {
    facts.flags = KERF_ANSWERS_AT_ONCE | KERF_TELLS_VELOCITY;
    facts.rate_hz = 1000.0;
    facts.jitter_s = 1e-3;
    tell(facts.model, fmt::format("Haply {}", told_.type.empty() ? std::string("inverse3") : told_.type));
    tell(facts.about, "Haply Inverse3 behind its service, 3 axes with force; 1 kHz");
    tell(facts.serial, device_);
    const double reach = told_.type == "minverse" ? reach_of_minverse_m : reach_m;
    for (std::size_t i = 0; i < 3; ++i) {
      const double here = told_.position_m.at(i);
      add_axis(facts, {std::string_view("xyz").substr(i, 1), 0.0, here - reach, here + reach, most_n_});
    }
    for (const char* const force : {"told_force_x", "told_force_y", "told_force_z"})
      add_channel(facts, force, "N");
    add_channel(facts, "unchanged_for", "s");
    add_channel(facts, "button", "1", KERF_CHANNEL_BUTTON);
    const auto flag = [](std::optional<bool> one) { return !one ? "\"unknown\"" : *one ? "true" : "false"; };
    tell(facts.settings, fmt::format("device_id = \"{}\"\nmessage = \"{}\"\ngravity_compensation = {}\n",
                                     device_, naming_ == inverse3::Naming::values ? "values" : "vector",
                                     flag(told_.gravity_compensation)));
  }

  int read(kerf_device_reading_v1& reading) {
    if (!asked_ns_) {
      if (!send()) return -1;
      asked_ns_ = now_ns();
    }
    auto text = connection_->receive(answer_patience);
    const std::int64_t now = now_ns();
    if (connection_->gone()) return -1;
    if (!text) {
      // It answers each message. One that it has not answered by now it has lost.
      if (now - *asked_ns_ > ask_again_ns) asked_ns_.reset();
      return 0;
    }
    asked_ns_.reset();
    while (auto later = connection_->receive(milliseconds(0))) text = std::move(later);
    const auto state = inverse3::parse(*text, device_);
    if (state) {
      // The state has no count: a service that stalls looks like a hand that is still.
      if (state->position_m != told_.position_m || changed_ns_ == 0) changed_ns_ = now;
      told_ = *state;
      told_ns_ = now;
    } else {
      reading.flags |= KERF_DOUBTED;
      is_absent_ = now - told_ns_ > absent_ns;
      if (is_absent_) return -1;
    }
    std::copy(told_.position_m.begin(), told_.position_m.end(), reading.position);
    std::copy(told_.velocity_m_s.begin(), told_.velocity_m_s.end(), reading.velocity);
    for (std::size_t i = 0; i < 3; ++i)
      reading.channels[i] = told_.force_n ? told_.force_n->at(i) : std::nan("");
    reading.channels[3] = 1e-9 * static_cast<double>(now - changed_ns_);
    reading.channels[4] = told_.button ? 1.0 : 0.0;
    return 1;
  }

  [[nodiscard]] const char* trouble() {
    trouble_ = is_absent_
                   ? fmt::format("the service tells nothing of the Inverse3 {} any more", device_)
                   : fmt::format("the service closed its connection ({})", connection_->gone().message());
    return trouble_.c_str();
  }

  int write(const double* force) noexcept {
    std::copy_n(force, 3, force_n_.begin());
    return 0;
  }

  void release() {
    force_n_ = {};
    // In the copy of the process the connection is somebody else's to write to; without it the service lets
    // go.
    if (getpid() != opened_by_) return connection_->cut();
    if (send()) asked_ns_ = now_ns();
  }

 private:
  bool send() { return connection_->send(inverse3::order(device_, force_n_, naming_)); }

  [[nodiscard]] static inverse3::Naming version(const Place& place) {
    // Before 3.5 nothing answers there.
    try {
      const std::string told = http_get({.address = place.address,
                                         .port = place.port,
                                         .target = "/version",
                                         .most_bytes = 4096,
                                         .patience = milliseconds(300)});
      return inverse3::naming_of(told).value_or(inverse3::Naming::values);
    } catch (const std::exception&) {
      return inverse3::Naming::values;
    }
  }

  std::string device_;
  double most_n_;
  inverse3::Naming naming_ = inverse3::Naming::values;
  std::unique_ptr<Connection> connection_;
  State told_;
  std::array<double, 3> force_n_{};
  std::optional<std::int64_t> asked_ns_;  ///< while an answer is awaited
  std::int64_t told_ns_ = now_ns();
  std::int64_t changed_ns_ = 0;
  bool is_absent_ = false;
  std::string trouble_;
  pid_t opened_by_ = getpid();
};

}  // namespace

const kerf_device_v1 inverse3_device = as_plugin<Inverse3>("Haply Inverse3 behind its service");

}  // namespace kerf::host

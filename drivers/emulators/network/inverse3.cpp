#include "network/inverse3.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <kerf/drivers/usb/io_thread.h>

#include "devices/held_tip.h"
#include "network/own_port.h"
#include "trace.h"

namespace kerf::emulators {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using drivers::usb::now_ns;
using nlohmann::json;

constexpr std::chrono::microseconds between_steps{250};
constexpr std::size_t big_message = 10'000'000;
constexpr std::array<double, 3> centre{0.0, -0.12, 0.14};

json vector_of(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

/// {"x": ..., "y": ..., "z": ...}; what is none is zero.
Eigen::Vector3d vector_in(const json& object) {
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto part = object.find(std::string(1, "xyz"[i]));
    if (part != object.end() && part->is_number()) vector[i] = part->get<double>();
  }
  return vector;
}

HeldTip::Options tip_of(const EmulatedInverse3::Options& options) {
  return {.centre_m = Eigen::Vector3d(centre.data()),
          .sway_m = options.sway_m,
          .max_travel_m = 0.1,
          .free = options.free};
}

}  // namespace

class EmulatedInverse3::Service {
 public:
  Service(const Options& options, std::vector<Fault> faults)
      : options_(options),
        faults_(std::move(faults)),
        acceptor_(io_, tcp::v4(),
                  open_port(Transport::connections, options.address, options.port).socket.release()),
        tip_(tip_of(options)),
        trace_(open_trace(options.trace, "t_s,host_ns,event,fx,fy,fz,x,y,z")),
        began_ns_(now_ns()) {
    accept();
  }

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  [[nodiscard]] std::string tell() const {
    return fmt::format("{} states sent, {} left out, {} clients", sent_, left_out_, clients_);
  }

  void run(const std::atomic<bool>& stop, double seconds) {
    while (!stop.load() && !(seconds > 0.0 && 1e-9 * static_cast<double>(now_ns() - began_ns_) >= seconds)) {
      io_.restart();
      io_.run_one_for(between_steps);
      step();
    }
  }

 private:
  class Client;

  void accept();

  [[nodiscard]] double world_s() const noexcept {
    return world_start_ns_ ? 1e-9 * static_cast<double>(now_ns() - *world_start_ns_) : 0.0;
  }
  [[nodiscard]] bool is_down() const noexcept {
    return world_start_ns_ && faults_.is_without_power(world_s());
  }

  void step();

  void push(const Eigen::Vector3d& force_n, const char* event) {
    tip_.push(force_n);
    tip_.run_until(world_s());
    if (!trace_.is_open()) return;
    const Eigen::Vector3d at = tip_.position();
    trace_ << fmt::format("{:.6f},{},{},{},{},{},{:.9g},{:.9g},{:.9g}\n", world_s(), now_ns(), event,
                          force_n.x(), force_n.y(), force_n.z(), at.x(), at.y(), at.z());
    if (force_n.isZero()) trace_.flush();
  }

  /// What it knows of a message is done, the rest ignored.
  void take(const std::string& text) {
    const json message = json::parse(text, nullptr, false);
    const auto list = message.is_object() ? message.find("inverse3") : message.end();
    if (!message.is_object() || list == message.end() || !list->is_array()) return;
    for (const json& one : *list) {
      if (!one.is_object() || one.value("device_id", "") != options_.device || !one.contains("commands"))
        continue;
      const json& commands = one.at("commands");
      if (!commands.is_object() || !commands.contains("set_cursor_force")) continue;
      const json& command = commands.at("set_cursor_force");
      for (const char* const name : {"values", "vector"}) {
        const bool is_own = (std::string(name) == "vector") == speaks_3_5();
        if (!command.is_object() || !command.contains(name) || (options_.strict && !is_own)) continue;
        told_ns_ = now_ns();
        push(vector_in(command.at(name)), "force");
        return;
      }
    }
  }

  [[nodiscard]] bool speaks_3_5() const { return options_.version >= "3.5"; }

  [[nodiscard]] json device(bool whole, bool in_use) const {
    const Eigen::Vector3d at = tip_.position();
    const double step_s = std::max(1e-6, world_s() - last_s_);
    const Eigen::Vector3d speed =
        last_s_ > 0.0 ? Eigen::Vector3d((at - last_at_) / step_s) : Eigen::Vector3d::Zero();
    json one{{"device_id", options_.device},
             {"state",
              {{"cursor_position", vector_of(at)},
               {"cursor_velocity", vector_of(speed)},
               {"current_cursor_force", vector_of(tip_.force())},
               {"control_domain", "cartesian"}}}};
    if (!whole) return one;
    one["config"] = {{"type", "inverse3"},
                     {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 0.0}}},
                     {"filters", {{"force_gate", {{"gain", 0.3}}}}}};
    one["status"] = {
        {"calibrated", options_.calibrated}, {"in_use", in_use}, {"ready", true}, {"power_supply", true}};
    return one;
  }

  [[nodiscard]] std::string state(bool whole, bool in_use) {
    const double time_s = world_s();
    const auto unplugged = faults_.unplugged_at_s();
    json list = json::array();
    if (!unplugged || time_s < *unplugged) list.push_back(device(whole, in_use));
    json message{
        {"inverse3", list},
        {"verse_grip", json::array({{{"device_id", "61548"}, {"state", {{"button", false}, {"hall", 0}}}}})}};
    if (whole) message["session_id"] = ":0";
    if (options_.big_s && time_s >= *options_.big_s) {
      options_.big_s.reset();
      message["padding"] = std::string(big_message, 'x');
    }
    last_at_ = tip_.position();
    last_s_ = time_s;
    std::string text = message.dump();
    if (!whole && faults_.due(time_s) == Disturbance::corrupt) {
      faults_.done(Disturbance::corrupt, time_s);
      const auto at = text.find("\"x\":");
      text.replace(at + 4, text.find_first_of(",}", at) - at - 4, "NaN");
    }
    return text;
  }

  Options options_;
  FaultPlan faults_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  HeldTip tip_;
  std::ofstream trace_;
  std::int64_t began_ns_;
  std::optional<std::int64_t> world_start_ns_;  ///< its first client
  std::int64_t told_ns_ = 0;
  Eigen::Vector3d last_at_ = Eigen::Vector3d::Zero();
  double last_s_ = 0.0;
  Client* owner_ = nullptr;
  std::uint64_t sent_ = 0;
  std::uint64_t left_out_ = 0;
  std::uint64_t clients_ = 0;
};

/// A connection: one question by HTTP, or a session by WebSocket.
class EmulatedInverse3::Service::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Service& service, tcp::socket socket)
      : service_(service), stream_(std::move(socket)), later_(service.io_) {}
  ~Client() {
    if (service_.owner_ == this) service_.owner_ = nullptr;
  }

  void begin() {
    http::async_read(stream_.next_layer(), buffer_, request_,
                     [self = this->shared_from_this()](error_code error, auto) {
                       if (error) return;
                       if (websocket::is_upgrade(self->request_)) return self->welcome();
                       self->answer_by_http();
                     });
  }

  void end() {
    error_code ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
  }

 private:
  void answer_by_http() {
    const bool knows = service_.speaks_3_5() && request_.target() == "/version";
    response_.result(knows ? http::status::ok : http::status::not_found);
    response_.set(http::field::content_type, "application/json");
    response_.body() = knows ? json{{"ok", true}, {"data", {{"version", service_.options_.version}}}}.dump()
                             : json{{"ok", false}, {"error", "no such route"}}.dump();
    response_.prepare_payload();
    response_.keep_alive(false);
    http::async_write(stream_.next_layer(), response_,
                      [self = this->shared_from_this()](error_code, auto) { self->end(); });
  }

  void welcome() {
    stream_.async_accept(request_, [self = this->shared_from_this()](error_code error) {
      if (error) return;
      Service& service = self->service_;
      if (!service.world_start_ns_) service.world_start_ns_ = now_ns();
      const bool in_use = service.owner_ != nullptr;
      self->say(service.state(true, in_use));
      self->listen();
    });
  }

  void listen() {
    stream_.async_read(buffer_, [self = this->shared_from_this()](error_code error, auto) {
      if (error) {
        if (self->service_.owner_ == self.get()) self->service_.owner_ = nullptr;
        return;
      }
      const std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.clear();
      self->heard(text);
      self->listen();
    });
  }

  void heard(const std::string& text) {
    if (service_.is_down()) return end();
    if (service_.owner_ == nullptr) service_.owner_ = this;
    const double time_s = service_.world_s();
    if (service_.owner_ == this) service_.take(text);
    service_.tip_.run_until(service_.world_s());
    const bool dropped = service_.faults_.due(time_s) == Disturbance::drop;
    if (dropped) service_.faults_.done(Disturbance::drop, time_s);
    if (dropped || service_.faults_.is_silent(time_s)) {
      ++service_.left_out_;
      return;
    }
    const int times = service_.faults_.duplicates(time_s) ? 2 : 1;
    for (int i = 0; i < times; ++i) say(service_.state(false, false));
  }

  void say(std::string text) {
    ++service_.sent_;
    if (service_.options_.answer_s <= 0.0) return send(std::move(text));
    later_.expires_after(std::chrono::nanoseconds(std::llround(1e9 * service_.options_.answer_s)));
    later_.async_wait([self = this->shared_from_this(), text = std::move(text)](error_code error) mutable {
      if (!error) self->send(std::move(text));
    });
  }

  void send(std::string text) {
    waiting_.push_back(std::move(text));
    if (waiting_.size() == 1) send_next();
  }

  void send_next() {
    stream_.text(true);
    stream_.async_write(asio::buffer(waiting_.front()),
                        [self = this->shared_from_this()](error_code error, auto) {
                          self->waiting_.pop_front();
                          if (!error && !self->waiting_.empty()) self->send_next();
                        });
  }

  Service& service_;
  websocket::stream<beast::tcp_stream> stream_;
  asio::steady_timer later_;
  beast::flat_buffer buffer_;
  http::request<http::string_body> request_;
  http::response<http::string_body> response_;
  std::deque<std::string> waiting_;
};

void EmulatedInverse3::Service::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (error) return;
    if (!is_down()) {
      ++clients_;
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<Client>(*this, std::move(socket))->begin();
    }
    accept();
  });
}

void EmulatedInverse3::Service::step() {
  if (!world_start_ns_) return;
  if (is_down() && owner_ != nullptr) owner_->end();
  tip_.run_until(world_s());
  if (now_ns() - told_ns_ > std::llround(1e9 * options_.idle_s) && !tip_.force().isZero())
    push(Eigen::Vector3d::Zero(), "idle");
}

EmulatedInverse3::Options EmulatedInverse3::parse_options(drivers::Uri uri) {
  drivers::UriOptions given(std::move(uri));
  Options options;
  options.address = given.text("address").value_or(options.address);
  options.port = static_cast<std::uint16_t>(given.number("port", {"1", 10001.0, 0.0, 65535.0}));
  options.version = given.text("version").value_or(options.version);
  options.strict = given.flag("strict", false);
  options.device = given.text("device").value_or(options.device);
  options.calibrated = given.flag("calibrated", true);
  options.idle_s = given.number("idle", {"s", options.idle_s, 0.001, 1e6});
  options.answer_s = given.number("answer", {"s", 0.0, 0.0, 2.0});
  const double big_s = given.number("big", {"s", -1.0, -1.0, 1e6});
  if (big_s >= 0.0) options.big_s = big_s;
  options.sway_m = given.number("sway", {"m", options.sway_m, 0.0, 0.08});
  options.free = FreeTip::in(given);
  options.trace = given.text("trace").value_or("");
  given.refuse_others();
  return options;
}

EmulatedInverse3::EmulatedInverse3(const Options& options, std::vector<Fault> faults)
    : service_(std::make_unique<Service>(options, std::move(faults))) {}
EmulatedInverse3::~EmulatedInverse3() = default;
std::uint16_t EmulatedInverse3::port() const noexcept { return service_->port(); }
void EmulatedInverse3::run(const std::atomic<bool>& stop, double seconds) { service_->run(stop, seconds); }
std::string EmulatedInverse3::tell() const { return service_->tell(); }

}  // namespace kerf::emulators

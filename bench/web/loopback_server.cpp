#include "web/loopback_server.h"

#include <array>
#include <chrono>
#include <csignal>
#include <list>
#include <stdexcept>
#include <thread>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <fmt/format.h>

#include "web/http_messages.h"

namespace kerf::bench {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using namespace std::chrono_literals;

constexpr std::size_t most_connections = 256;
constexpr std::uint32_t most_head = 8192;
constexpr std::size_t most_body = 4096;
constexpr auto time_to_send = 5s;           // of a browser, for a request or for taking an answer
constexpr auto time_to_wait = 20s;          // of a request that was put off
constexpr auto time_to_hang_up = 1s;        // of a browser, after the answer
constexpr auto time_without_files = 100ms;  // before accepting again when the process has no descriptor left

}  // namespace

class LoopbackServer::State {
 public:
  explicit State(std::uint16_t port) : acceptor_(io_), pause_(io_), end_(io_) {
    const tcp::endpoint address(asio::ip::address_v4::loopback(), port);
    error_code error;
    acceptor_.open(address.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(address, error);
    if (!error) acceptor_.listen(64, error);
    if (error) {
      throw std::invalid_argument(fmt::format(
          "port {} of 127.0.0.1: {}; give another one, or 0 for any that is free", port, error.message()));
    }
    port_ = acceptor_.local_endpoint().port();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    asio::post(io_, [this] { stop(); });
    if (thread_.joinable()) thread_.join();
  }

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }

  void start(Handler handler) {
    handler_ = std::move(handler);
    accept();
    // Signals are for the threads that know what to do at the end of a run.
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { io_.run(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  void wake() {
    asio::post(io_, [this] { ask_again(); });
  }

 private:
  class Connection;
  using Connections = std::list<std::shared_ptr<Connection>>;

  void accept();
  void make_room();
  void ask_again();
  void stop();
  void forget(const Connection& connection);

  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  asio::steady_timer end_;
  std::uint16_t port_ = 0;
  Handler handler_;
  Connections connections_;  ///< oldest first
  bool stopping_ = false;
  std::thread thread_;
};

/// One request and its answer. It lives as long as an operation of it is under way.
class LoopbackServer::State::Connection : public std::enable_shared_from_this<Connection> {
 public:
  enum class Step { reading, waiting, writing, hanging_up };

  Connection(State& server, tcp::socket socket)
      : server_(server), stream_(std::move(socket)), overdue_(stream_.get_executor()) {
    parser_.header_limit(most_head);
    parser_.body_limit(most_body);
  }

  [[nodiscard]] Step step() const noexcept { return step_; }

  void read() {
    stream_.expires_after(time_to_send);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](error_code error, std::size_t) { self->take(error); });
  }

  /// Asks the handler, at first or once more.
  void ask(bool overdue) {
    if (const auto response = server_.handler_(request_, overdue)) {
      write(*response);
    } else if (step_ == Step::reading) {
      wait();
    }
  }

  void close() {
    error_code ignored;
    stream_.socket().close(ignored);
    overdue_.cancel();
  }

 private:
  void take(error_code error) {
    if (const int status = status_of(error)) return write(refusal(status));
    if (error) return done();
    auto request = taken_apart(parser_.get());
    if (!request) return write(refusal(400));
    request_ = std::move(*request);
    ask(false);
  }

  void wait() {
    step_ = Step::waiting;
    stream_.expires_never();
    overdue_.expires_after(time_to_wait);
    overdue_.async_wait([self = shared_from_this()](error_code error) {
      if (!error && self->step_ == Step::waiting) self->ask(true);
    });
    drop();
  }

  void write(const HttpResponse& response) {
    const bool is_listening = step_ == Step::waiting;
    step_ = Step::writing;
    overdue_.cancel();
    response_ = on_the_wire(response);
    stream_.expires_after(time_to_send);
    http::async_write(stream_, response_,
                      [self = shared_from_this(), is_listening](error_code error, std::size_t) {
                        if (error) return self->done();
                        // Closing while bytes are still coming in would take the answer back: wait for the
                        // browser to hang up.
                        error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                        self->step_ = Step::hanging_up;
                        self->stream_.expires_after(time_to_hang_up);
                        if (!is_listening) self->drop();
                      });
  }

  /// Reads what nobody asked for, until the browser hangs up.
  void drop() {
    stream_.async_read_some(asio::buffer(dropped_),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (error || self->step_ == Step::waiting) return self->done();
                              self->drop();
                            });
  }

  void done() {
    close();
    server_.forget(*this);
  }

  State& server_;
  beast::tcp_stream stream_;
  asio::steady_timer overdue_;
  Step step_ = Step::reading;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  HttpRequest request_;
  http::response<http::string_body> response_;
  std::array<char, 1024> dropped_{};
};

void LoopbackServer::State::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (stopping_) return;
    if (error) {
      pause_.expires_after(time_without_files);
      return pause_.async_wait([this](error_code) {
        if (!stopping_) accept();
      });
    }
    if (connections_.size() >= most_connections) make_room();
    connections_.push_back(std::make_shared<Connection>(*this, std::move(socket)));
    connections_.back()->read();
    accept();
  });
}

void LoopbackServer::State::make_room() {
  const auto idle = std::find_if(connections_.begin(), connections_.end(), [](const auto& it) {
    return it->step() == Connection::Step::reading || it->step() == Connection::Step::hanging_up;
  });
  const auto gives_way = idle != connections_.end() ? idle : connections_.begin();
  (*gives_way)->close();
  connections_.erase(gives_way);
}

void LoopbackServer::State::ask_again() {
  const Connections all = connections_;
  for (const auto& it : all) {
    if (it->step() == Connection::Step::waiting) it->ask(false);
  }
}

void LoopbackServer::State::stop() {
  stopping_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  pause_.cancel();
  const Connections all = connections_;
  for (const auto& it : all) {
    if (it->step() != Connection::Step::writing && it->step() != Connection::Step::hanging_up) it->close();
  }
  end_.expires_after(time_to_hang_up);
  end_.async_wait([this](error_code) { io_.stop(); });
  if (connections_.empty()) end_.cancel();
}

void LoopbackServer::State::forget(const Connection& connection) {
  std::erase_if(connections_, [&](const auto& it) { return it.get() == &connection; });
  if (stopping_ && connections_.empty()) end_.cancel();
}

LoopbackServer::LoopbackServer(std::uint16_t port) : state_(std::make_unique<State>(port)) {}
LoopbackServer::~LoopbackServer() = default;
std::uint16_t LoopbackServer::port() const noexcept { return state_->port(); }
void LoopbackServer::start(Handler handler) { state_->start(std::move(handler)); }
void LoopbackServer::wake() noexcept { state_->wake(); }

}  // namespace kerf::bench

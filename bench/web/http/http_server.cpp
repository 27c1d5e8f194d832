#include "http/http_server.h"

#include <array>
#include <chrono>
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

#include "http/http_messages.h"
#include "loop/without_signals.h"

namespace kerf::bench {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using namespace std::chrono_literals;

constexpr std::size_t max_connections = 256;
constexpr int max_waiting_to_be_accepted = 4096;  // a refused one tries again a second later
constexpr std::uint32_t max_head = 8192;
constexpr auto time_to_send = 5s;           // of a browser, for a request or for taking an answer
constexpr auto time_to_wait = 20s;          // of a request that was put off
constexpr auto time_to_hang_up = 1s;        // of a browser, after the answer
constexpr auto time_without_files = 100ms;  // before accepting again when the process has no descriptor left

}  // namespace

class HttpServer::State {
 public:
  explicit State(const ServerOptions& options)
      : max_body_(options.max_body), acceptor_(io_), pause_(io_), end_(io_) {
    error_code error;
    const tcp::endpoint address(asio::ip::make_address(options.address, error), options.port);
    if (!error && address.address().is_unspecified())
      throw std::invalid_argument(fmt::format(
          "{} stands for every address of this machine; give one of them, by which browsers call it",
          options.address));
    if (!error) acceptor_.open(address.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(address, error);
    if (!error) acceptor_.listen(max_waiting_to_be_accepted, error);
    if (error) {
      throw std::invalid_argument(
          fmt::format("port {} of {}: {}; give another one, or 0 for any that is free", options.port,
                      options.address, error.message()));
    }
    local_ = acceptor_.local_endpoint();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { end(); }

  [[nodiscard]] const tcp::endpoint& local() const noexcept { return local_; }

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

  void end() {
    if (!thread_.joinable()) return;
    asio::post(io_, [this] { stop(); });
    thread_.join();
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

  std::size_t max_body_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  asio::steady_timer end_;
  tcp::endpoint local_;
  std::uint64_t requests_ = 0;
  Handler handler_;
  Connections connections_;  ///< oldest first
  bool stopping_ = false;
  std::thread thread_;
};

/// One request and its answer. It lives as long as an operation of it is under way.
class HttpServer::State::Connection : public std::enable_shared_from_this<Connection> {
 public:
  enum class Step { reading, waiting, writing, streaming, hanging_up };

  Connection(State& server, tcp::socket socket)
      : server_(server), stream_(std::move(socket)), overdue_(stream_.get_executor()) {
    parser_.header_limit(max_head);
    parser_.body_limit(server.max_body_);
  }

  [[nodiscard]] Step step() const noexcept { return step_; }

  void read() {
    stream_.expires_after(time_to_send);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](error_code error, std::size_t) { self->take(error); });
  }

  /// Asks the handler, at first or once more.
  void ask(bool overdue) {
    if (const auto response = asked(overdue)) {
      write(*response);
    } else if (step_ == Step::reading) {
      wait();
    }
  }

  /// Sends what has come since, if the browser has taken the rest.
  void go_on() {
    if (step_ != Step::streaming || is_sending_) return;
    piece_ = more_();
    if (piece_.empty()) return;
    is_sending_ = true;
    stream_.expires_after(time_to_send);
    asio::async_write(stream_, asio::buffer(piece_),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        self->is_sending_ = false;
                        if (error) return self->done();
                        self->stream_.expires_never();
                        self->go_on();
                      });
  }

  /// A handler that throws all the same (no memory) must not end the program that renders forces.
  std::optional<HttpResponse> asked(bool overdue) {
    try {
      return server_.handler_(request_, overdue);
    } catch (const std::exception&) {
      return refusal(500);
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
    auto request = parse_http_request(parser_.get());
    if (!request) return write(refusal(400));
    request_ = std::move(*request);
    request_.number = ++server_.requests_;
    request_.asker = weak_from_this();
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
    response_ = serialise_response(response);
    more_ = response.more;
    stream_.expires_after(time_to_send);
    http::async_write(stream_, response_,
                      [self = shared_from_this(), is_listening](error_code error, std::size_t) {
                        if (error) return self->done();
                        if (self->more_) return self->stream(is_listening);
                        // Closing while bytes are still coming in would take the answer back: wait for the
                        // browser to hang up.
                        error_code ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                        self->step_ = Step::hanging_up;
                        self->hang_up_soon();
                        if (!is_listening) self->drop();
                      });
  }

  /// By a timer of our own: that of the stream does not reach a read that is under way.
  void hang_up_soon() {
    overdue_.expires_after(time_to_hang_up);
    overdue_.async_wait([self = shared_from_this()](error_code error) {
      if (!error) self->done();
    });
  }

  void stream(bool is_listening) {
    step_ = Step::streaming;
    stream_.expires_never();
    if (!is_listening) drop();
    go_on();
  }

  /// Reads what nobody asked for, until the browser hangs up.
  void drop() {
    stream_.async_read_some(
        asio::buffer(dropped_), [self = shared_from_this()](error_code error, std::size_t) {
          const bool is_over = self->step_ != Step::writing && self->step_ != Step::hanging_up;
          if (error || is_over) return self->done();
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
  std::function<std::string()> more_;
  std::string piece_;
  bool is_sending_ = false;
  std::array<char, 1024> dropped_{};
};

void HttpServer::State::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (stopping_) return;
    if (error) {
      pause_.expires_after(time_without_files);
      return pause_.async_wait([this](error_code) {
        if (!stopping_) accept();
      });
    }
    if (connections_.size() >= max_connections) make_room();
    connections_.push_back(std::make_shared<Connection>(*this, std::move(socket)));
    connections_.back()->read();
    accept();
  });
}

void HttpServer::State::make_room() {
  const auto idle = std::find_if(connections_.begin(), connections_.end(), [](const auto& it) {
    return it->step() == Connection::Step::reading || it->step() == Connection::Step::hanging_up;
  });
  const auto gives_way = idle != connections_.end() ? idle : connections_.begin();
  (*gives_way)->close();
  connections_.erase(gives_way);
}

void HttpServer::State::ask_again() {
  const Connections all = connections_;
  for (const auto& it : all) {
    if (it->step() == Connection::Step::waiting) it->ask(false);
    it->go_on();
  }
}

void HttpServer::State::stop() {
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

void HttpServer::State::forget(const Connection& connection) {
  std::erase_if(connections_, [&](const auto& it) { return it.get() == &connection; });
  if (stopping_ && connections_.empty()) end_.cancel();
}

HttpServer::HttpServer(const ServerOptions& options) : state_(std::make_unique<State>(options)) {}
HttpServer::~HttpServer() = default;
std::uint16_t HttpServer::port() const noexcept { return state_->local().port(); }
std::vector<std::string> HttpServer::hosts() const {
  const tcp::endpoint& local = state_->local();
  const std::string address = local.address().to_string();
  std::vector<std::string> names{
      fmt::format("{}:{}", local.address().is_v6() ? fmt::format("[{}]", address) : address, local.port())};
  if (local.address().is_loopback()) names.push_back(fmt::format("localhost:{}", local.port()));
  return names;
}
bool HttpServer::is_loopback() const noexcept { return state_->local().address().is_loopback(); }
void HttpServer::start(Handler handler) { state_->start(std::move(handler)); }
void HttpServer::wake() noexcept { state_->wake(); }
void HttpServer::stop() { state_->end(); }

}  // namespace kerf::bench

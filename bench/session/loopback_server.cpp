#include "session/loopback_server.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <list>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::size_t most_connections = 256;
constexpr auto time_to_send = 5s;           // of a browser, for a request or for taking an answer
constexpr auto time_to_wait = 20s;          // of a request that was put off
constexpr auto time_to_hang_up = 1s;        // of a browser, after the answer
constexpr auto time_without_files = 100ms;  // before accepting again when the process has no descriptor left

/// A descriptor that is closed at its end.
class Descriptor {
 public:
  explicit Descriptor(int number) noexcept : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  [[nodiscard]] int get() const noexcept { return number_; }

 private:
  int number_;
};

Descriptor listening_socket(std::uint16_t port) {
  Descriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (listener.get() < 0) throw std::system_error(errno, std::generic_category(), "the page of the session");
  const int yes = 1;
  setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener.get(), SOMAXCONN) != 0) {
    throw std::invalid_argument(fmt::format(
        "port {} of 127.0.0.1: {}; give another one, or 0 for any that is free", port, std::strerror(errno)));
  }
  return listener;
}

std::uint16_t port_of(const Descriptor& listener) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

struct Connection {
  enum class State { reading, waiting, writing, hanging_up, over };
  Descriptor socket;
  State state = State::reading;
  Clock::time_point until;
  std::string bytes{};  // as received, then as they are to be sent
  HttpRequest request{};
};

}  // namespace

class LoopbackServer::Loop {
 public:
  explicit Loop(std::uint16_t port)
      : listener_(listening_socket(port)),
        bell_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
        port_(port_of(listener_)) {
    if (bell_.get() < 0) throw std::system_error(errno, std::generic_category(), "the page of the session");
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  ~Loop() {
    stopping_ = true;
    ring();
    if (thread_.joinable()) thread_.join();
  }

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  void ring() const noexcept {
    const std::uint64_t once = 1;
    // It can only fail where the bell has been rung 2^64 times and nobody came.
    [[maybe_unused]] const ssize_t ignored = write(bell_.get(), &once, sizeof once);
  }

  void start(Handler handler) {
    handler_ = std::move(handler);
    // Signals are for the threads that know what to do at the end of a run.
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { run(); });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

 private:
  void run() {
    while (!stopping_) turn();
    const Clock::time_point end = Clock::now() + time_to_hang_up;
    const auto is_not_writing = [](const Connection& it) { return it.state != Connection::State::writing; };
    for (connections_.remove_if(is_not_writing); !connections_.empty() && Clock::now() < end;) {
      turn();
      connections_.remove_if(is_not_writing);
    }
  }

  /// Waits for whatever comes first and deals with all of it.
  void turn() {
    std::vector<pollfd> polled;
    const bool accepting = !stopping_ && Clock::now() >= accept_again_;
    polled.push_back({.fd = bell_.get(), .events = POLLIN, .revents = 0});
    polled.push_back({.fd = accepting ? listener_.get() : -1, .events = POLLIN, .revents = 0});
    for (const Connection& it : connections_) {
      const bool writes = it.state == Connection::State::writing;
      polled.push_back(
          {.fd = it.socket.get(), .events = static_cast<short>(writes ? POLLOUT : POLLIN), .revents = 0});
    }
    poll(polled.data(), polled.size(), milliseconds_to_wait());

    std::size_t index = 2;
    for (Connection& it : connections_) {
      if (polled[index++].revents != 0) serve(it);
    }
    if (polled[0].revents != 0) answer_the_bell();
    end_what_is_overdue();
    connections_.remove_if([](const Connection& it) { return it.state == Connection::State::over; });
    if (polled[1].revents != 0) accept_all();
  }

  [[nodiscard]] int milliseconds_to_wait() const {
    Clock::time_point next = Clock::now() + 1s;
    if (accept_again_ > Clock::now()) next = std::min(next, accept_again_);
    for (const Connection& it : connections_) next = std::min(next, it.until);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now());
    return static_cast<int>(std::max<std::chrono::milliseconds::rep>(0, left.count()));
  }

  void accept_all() {
    while (true) {
      Descriptor socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (socket.get() < 0) {
        if (errno == EMFILE || errno == ENFILE || errno == ENOMEM)
          accept_again_ = Clock::now() + time_without_files;
        return;
      }
      if (connections_.size() >= most_connections) make_room();
      connections_.push_back({.socket = std::move(socket), .until = Clock::now() + time_to_send});
    }
  }

  void make_room() {
    const auto idle = std::find_if(connections_.begin(), connections_.end(), [](const Connection& it) {
      return it.state == Connection::State::reading || it.state == Connection::State::hanging_up;
    });
    connections_.erase(idle != connections_.end() ? idle : connections_.begin());
  }

  void serve(Connection& it) {
    switch (it.state) {
      case Connection::State::reading:
        receive(it);
        break;
      case Connection::State::writing:
        send_more(it);
        break;
      case Connection::State::waiting:  // The browser hung up, or says what was not asked for.
      case Connection::State::hanging_up: {
        std::array<char, 4096> dropped;
        const ssize_t count = recv(it.socket.get(), dropped.data(), dropped.size(), 0);
        const bool gone = count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
        if (gone || it.state == Connection::State::waiting) it.state = Connection::State::over;
        break;
      }
      case Connection::State::over:
        break;
    }
  }

  void receive(Connection& it) {
    std::array<char, 4096> buffer;
    const ssize_t count = recv(it.socket.get(), buffer.data(), buffer.size(), 0);
    if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (count <= 0) {
      it.state = Connection::State::over;
      return;
    }
    it.bytes.append(buffer.data(), static_cast<std::size_t>(count));
    HttpReading reading = read_http_request(it.bytes);
    if (reading.refusal != 0) {
      answer(it, refusal(reading.refusal));
    } else if (reading.request) {
      it.request = std::move(*reading.request);
      it.bytes.clear();
      it.until = Clock::now() + time_to_wait;
      it.state = Connection::State::waiting;
      ask(it, false);
    }
  }

  void ask(Connection& it, bool overdue) {
    if (const std::optional<HttpResponse> response = handler_(it.request, overdue)) answer(it, *response);
  }

  static void answer(Connection& it, const HttpResponse& response) {
    it.bytes = on_the_wire(response);
    it.until = Clock::now() + time_to_send;
    it.state = Connection::State::writing;
    send_more(it);
  }

  static void send_more(Connection& it) {
    const ssize_t count = send(it.socket.get(), it.bytes.data(), it.bytes.size(), MSG_NOSIGNAL);
    if (count < 0) {
      if (errno != EAGAIN && errno != EINTR) it.state = Connection::State::over;
      return;
    }
    it.bytes.erase(0, static_cast<std::size_t>(count));
    if (!it.bytes.empty()) return;
    // Closing while bytes are still coming in would take the answer back; so it waits for the browser to hang
    // up.
    shutdown(it.socket.get(), SHUT_WR);
    it.until = Clock::now() + time_to_hang_up;
    it.state = Connection::State::hanging_up;
  }

  void answer_the_bell() {
    std::uint64_t rings = 0;
    [[maybe_unused]] const ssize_t ignored = read(bell_.get(), &rings, sizeof rings);
    for (Connection& it : connections_) {
      if (it.state == Connection::State::waiting) ask(it, false);
    }
  }

  void end_what_is_overdue() {
    const Clock::time_point now = Clock::now();
    for (Connection& it : connections_) {
      if (now < it.until) continue;
      if (it.state == Connection::State::waiting) {
        ask(it, true);
      } else {
        it.state = Connection::State::over;
      }
    }
  }

  Descriptor listener_;
  Descriptor bell_;
  std::uint16_t port_;
  Handler handler_;
  std::list<Connection> connections_;
  Clock::time_point accept_again_{};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

LoopbackServer::LoopbackServer(std::uint16_t port) : loop_(std::make_unique<Loop>(port)) {}
LoopbackServer::~LoopbackServer() = default;
std::uint16_t LoopbackServer::port() const noexcept { return loop_->port(); }
void LoopbackServer::start(Handler handler) { loop_->start(std::move(handler)); }
void LoopbackServer::wake() noexcept { loop_->ring(); }

}  // namespace kerf::bench

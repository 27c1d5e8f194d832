#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "session/http_request.h"
#include "session/http_response.h"

namespace kerf::bench {

/// A small HTTP server for browsers on this machine: 127.0.0.1 only, one thread that waits for all
/// connections at once. A connection that sends nothing costs a few hundred bytes and nobody's time; the
/// process beside it renders forces with its memory locked, so that a thread for each, or headers without
/// end, would not do.
///
/// At most 256 connections: the longest idle one gives way. A request has 5 s to arrive, an answer 5 s to be
/// taken.
class LoopbackServer {
 public:
  /// Answers a request, or puts it off by nothing: it is then called again after wake(), and in the end after
  /// 20 s with `overdue`, where it has to answer. Called from the server's thread; must not throw.
  using Handler = std::function<std::optional<HttpResponse>(const HttpRequest& request, bool overdue)>;

  /// Takes the port, 0 for any that is free. @throws std::invalid_argument: in use, or not permitted;
  /// std::system_error.
  explicit LoopbackServer(std::uint16_t port);
  LoopbackServer(const LoopbackServer&) = delete;
  LoopbackServer& operator=(const LoopbackServer&) = delete;
  ~LoopbackServer();  ///< What was put off is closed; answers on their way have up to a second.

  [[nodiscard]] std::uint16_t port() const noexcept;
  void start(Handler handler);
  void wake() noexcept;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace kerf::bench

#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// One request, parsed. Percent-sequences stay as they are: no address of ours needs one.
struct HttpRequest {
  std::uint64_t number = 0;                    ///< of this request, from 1; the same when it is asked again
  std::string method;                          ///< "GET"
  std::string path;                            ///< "/view"
  std::map<std::string, std::string> query;    ///< "after" = "12"
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
  std::weak_ptr<const void> asker;  ///< expired: nobody waits for the answer any more

  /// Value of a header, by its name in lower case; empty if there is none.
  [[nodiscard]] std::string_view header(const std::string& name) const;
};

/// What is answered to a request. Every answer closes its connection and is not to be stored, framed or
/// guessed at by the browser; nothing but the server's own files may be loaded by it.
struct HttpResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  /// A page of its own, such as a report from a file: may hold its styles and pictures, and loads and runs
  /// nothing, whatever else is in it.
  bool is_document = false;
  /// What comes after the body, such as server-sent events: asked for after every wake() once what came
  /// before has been taken; empty if there is nothing new. The connection stays open until the browser leaves
  /// or takes nothing for 5 s. None: the body is all. Called from the server's thread; must not throw.
  std::function<std::string()> more{};
};

/// A status with its name in the standard for a text.
[[nodiscard]] HttpResponse refusal(int status);

struct ServerOptions {
  std::string address = "127.0.0.1";  ///< to listen on
  std::uint16_t port = 0;             ///< 0: any that is free
  std::size_t max_body = 4096;        ///< of a request [bytes]
};

/// An HTTP server for browsers (Boost.Beast), one thread for all connections. A connection that sends nothing
/// costs a few hundred bytes and nobody's time; the process beside it renders forces with its memory locked,
/// so that a thread for each, or headers without end, would not do.
///
/// At most 256 connections: the longest idle one gives way. A request has 5 s to arrive, an answer 5 s to be
/// taken; its head has 8 kB at most. A header that comes twice is refused.
class HttpServer {
 public:
  /// Answers a request, or puts it off by nothing: it is then called again after wake(), and in the end after
  /// 20 s with `overdue`, where it has to answer. Called from the server's thread; must not throw.
  using Handler = std::function<std::optional<HttpResponse>(const HttpRequest& request, bool overdue)>;

  /// @throws std::invalid_argument: no such address, or one that stands for all (0.0.0.0); the port is in
  /// use,
  ///         or not permitted.
  explicit HttpServer(const ServerOptions& options);
  explicit HttpServer(std::uint16_t port = 0) : HttpServer(ServerOptions{.port = port}) {}
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  /// What was put off is closed; answers on their way have up to a second.
  ~HttpServer();

  [[nodiscard]] std::uint16_t port() const noexcept;
  /// How browsers name it: "127.0.0.1:8000", and "localhost:8000" where it listens on loopback.
  [[nodiscard]] std::vector<std::string> hosts() const;
  [[nodiscard]] bool is_loopback() const noexcept;
  void start(Handler handler);
  void wake() noexcept;
  /// Calls the handler no more: what it uses may go. As the destructor.
  void stop();

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace kerf::bench

#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "http/http_server.h"

namespace kerf::bench {

/// Why a request is refused: a status and a sentence for whoever reads the page.
struct RequestError : std::runtime_error {
  RequestError(int of_status, const std::string& why) : std::runtime_error(why), status(of_status) {}
  int status;
};

// What a request asks for; all throw RequestError with status 400 that names the parameter.
[[nodiscard]] std::string text_in_query(const HttpRequest& request, const std::string& name);
[[nodiscard]] double number_in_query(const HttpRequest& request, const std::string& name, double lower,
                                     double upper);
[[nodiscard]] std::size_t count_in_query(const HttpRequest& request, const std::string& name,
                                         std::size_t at_most);
/// "1,2,5"; at most 64 numbers, each at most `at_most`.
[[nodiscard]] std::vector<std::size_t> counts_in_query(const HttpRequest& request, const std::string& name,
                                                       std::size_t at_most);
/// The body as a JSON object. Status 415 where it is not declared as JSON.
[[nodiscard]] nlohmann::json json_in(const HttpRequest& request);
[[nodiscard]] std::string text_in(const nlohmann::json& object, const std::string& name);
[[nodiscard]] double number_in(const nlohmann::json& object, const std::string& name, double lower,
                               double upper);
// What may be left out.
[[nodiscard]] std::string text_or(const nlohmann::json& object, const std::string& name,
                                  const std::string& otherwise);
[[nodiscard]] double number_or(const nlohmann::json& object, const std::string& name, double otherwise,
                               double lower, double upper);
[[nodiscard]] bool flag_in(const nlohmann::json& object, const std::string& name, bool otherwise);
[[nodiscard]] std::vector<double> numbers_in(const nlohmann::json& object, const std::string& name,
                                             std::size_t at_most);

[[nodiscard]] HttpResponse json_response(const nlohmann::ordered_json& json);
/// Of JSON that is text already, fit for a page: json_for_page().
[[nodiscard]] HttpResponse json_text_response(std::string text);
[[nodiscard]] HttpResponse json_error(int status, std::string_view why);
[[nodiscard]] HttpResponse bytes_response(std::string bytes);

/// Which function answers which request. What is at_once is answered by the server's thread and must be done
/// in a millisecond; what is slow (files, fits) by a thread of its own, in order, off the loop's processor;
/// what acts on the device or a recording by another one, so that it waits for no file; what stops a job by a
/// third, so that it waits for no device that is being opened.
///
/// An exception becomes an answer with {"error": TEXT}: RequestError its status, std::invalid_argument and
/// schema::FormatError 400, drivers::DeviceError and std::system_error 500, anything else 500.
class Routes {
 public:
  enum class Pace : std::uint8_t { at_once, slow, action, stop };
  using Answer = std::function<HttpResponse(const HttpRequest&)>;

  Routes();
  Routes(const Routes&) = delete;
  Routes& operator=(const Routes&) = delete;
  ~Routes();  ///< waits for the slow answers at work

  void get(const std::string& path, Pace pace, Answer answer);
  void post(const std::string& path, Pace pace, Answer answer);

  /// As HttpServer::Handler; nothing while a slow answer is on its way. 404 for an unknown path, 405 for
  /// another method, 503 where 64 slow answers are waited for. What nobody waits for any more is not begun.
  [[nodiscard]] std::optional<HttpResponse> respond(const HttpRequest& request, bool overdue);
  /// Called from the slow thread whenever an answer is ready: the server's wake(). Before the first request.
  void on_ready(std::function<void()> wake);

 private:
  struct Route {
    std::string method;
    Pace pace = Pace::at_once;
    Answer answer;
  };
  struct Waiting {
    HttpRequest request;
    const Answer* answer = nullptr;
    Pace pace = Pace::slow;
    std::optional<HttpResponse> response;
    bool is_begun = false;
  };

  void answer_slowly(Pace pace, const std::stop_token& stop);
  /// Nothing: the request is new. Nothing within: its answer is not there yet.
  std::optional<std::optional<HttpResponse>> answer_of(const HttpRequest& request, bool overdue);
  void forget_the_abandoned();

  std::map<std::string, std::vector<Route>> routes_;
  std::function<void()> wake_;
  std::mutex mutex_;  ///< of waiting_
  std::condition_variable_any changed_;
  std::map<std::uint64_t, Waiting> waiting_;  ///< by the request's number: oldest first
  std::array<std::jthread, 3> threads_;       ///< last: use the rest
};

}  // namespace kerf::bench

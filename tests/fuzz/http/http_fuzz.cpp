#include <algorithm>
#include <set>
#include <string>

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>

#include "fuzz/target.h"
#include "http/http_messages.h"
#include "http/routes.h"
#include "pages/access_control.h"

namespace kerf::fuzz {
namespace {

namespace beast = boost::beast::http;
using bench::HttpRequest;
using bench::HttpResponse;

constexpr std::uint32_t max_head = 8192;
constexpr std::size_t max_body = 4096;

/// What every kind of parameter answers.
bench::Routes& routes() {
  static bench::Routes all;
  static const bool is_made = [] {
    const auto pace = bench::Routes::Pace::at_once;
    all.get("/text", pace, [](const HttpRequest& request) {
      return bench::bytes_response(bench::text_in_query(request, "value"));
    });
    all.get("/number", pace, [](const HttpRequest& request) {
      const double value = bench::number_in_query(request, "value", -1.0, 1e6);
      promise(value >= -1.0 && value <= 1e6, "a number is within its bounds");
      return bench::json_response({{"value", value}});
    });
    all.get("/count", pace, [](const HttpRequest& request) {
      const std::size_t value = bench::count_in_query(request, "value", 1000);
      promise(value <= 1000, "a count is within its bound");
      return bench::json_response({{"value", value}});
    });
    all.get("/counts", pace, [](const HttpRequest& request) {
      const auto values = bench::counts_in_query(request, "value", 7);
      promise(!values.empty() && values.size() <= 64 && std::ranges::max(values) <= 7,
              "counts are within bounds");
      return bench::json_response({{"values", values}});
    });
    all.post("/body", pace, [](const HttpRequest& request) {
      const auto json = bench::json_in(request);
      const double number = bench::number_or(json, "number", 0.5, 0.0, 1.0);
      promise(number >= 0.0 && number <= 1.0, "a number is within its bounds");
      const auto numbers = bench::numbers_in(json, "numbers", 5);
      promise(numbers.size() <= 5, "numbers are as many as may be");
      return bench::json_response({{"text", bench::text_in(json, "text")},
                                   {"other", bench::text_or(json, "other", "none")},
                                   {"number", number},
                                   {"flag", bench::flag_in(json, "flag", false)},
                                   {"numbers", numbers}});
    });
    return true;
  }();
  (void)is_made;
  return all;
}

/// What goes out is one message, whose body is the answer's.
void check_on_the_wire(const HttpResponse& response) {
  const auto message = bench::serialise_response(response);
  std::string bytes;
  beast::serializer<false, beast::string_body> serializer(message);
  boost::system::error_code error;
  do {
    serializer.next(error, [&](boost::system::error_code&, const auto& buffers) {
      for (const auto buffer : boost::beast::buffers_range_ref(buffers))
        bytes.append(static_cast<const char*>(buffer.data()), buffer.size());
      serializer.consume(boost::beast::buffer_bytes(buffers));
    });
  } while (!error && !serializer.is_done());
  beast::response_parser<beast::string_body> parser;
  parser.eager(true);
  parser.body_limit(boost::none);
  const std::size_t used = parser.put(boost::asio::buffer(bytes), error);
  promise(!error && used == bytes.size() && parser.is_done(), "an answer is one whole message");
  promise(parser.get().body() == response.body, "an answer arrives as it was given");
}

void check_request(const HttpRequest& request) {
  promise(request.path.starts_with('/') && request.path.find('?') == std::string::npos, "a path is one");
  for (const auto& [name, value] : request.headers) {
    promise(std::ranges::none_of(name, [](char c) { return c >= 'A' && c <= 'Z'; }),
            "headers are in lower case");
    promise(value.find_first_of("\r\n") == std::string::npos, "a header is one line");
  }
  static const bench::AccessControl access({"127.0.0.1:8000"});
  promise(!access.admits(request), "nobody is let in who does not know the token");
}

/// A connection's bytes, in pieces as a network cuts them: the first byte says how long they are.
void fuzz_http(Bytes bytes) {
  if (bytes.empty()) return;
  const std::size_t piece = 1 + bytes.front();
  bytes = bytes.subspan(1);
  beast::request_parser<beast::string_body> parser;
  parser.header_limit(max_head);
  parser.body_limit(max_body);
  parser.eager(true);
  boost::system::error_code error;
  for (std::size_t at = 0, end = 0; !parser.is_done();) {
    if (end == bytes.size()) {
      if (!parser.got_some()) return;
      parser.put_eof(error);
      break;
    }
    end = std::min(bytes.size(), end + piece);
    error = {};
    at += parser.put(boost::asio::buffer(bytes.data() + at, end - at), error);
    if (error && error != beast::error::need_more) break;
  }
  if (error || !parser.is_done()) {
    const int status = bench::status_of(error);
    promise(std::set{0, 400, 413, 431, 505}.contains(status),
            "what is no request has a status to refuse it by");
    if (status != 0) check_on_the_wire(bench::refusal(status));
    return;
  }
  auto request = bench::parse_http_request(parser.get());
  if (!request) return;
  request->number = 1;
  check_request(*request);
  const auto response = routes().respond(*request, false);
  promise(response.has_value(), "what is answered at once is");
  promise(std::set{200, 400, 404, 405, 415}.contains(response->status),
          "a request is answered or refused, not " + std::to_string(response->status));
  check_on_the_wire(*response);
}

const Registered registered("http", fuzz_http);

}  // namespace
}  // namespace kerf::fuzz

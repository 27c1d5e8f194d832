#include "http/http_messages.h"

#include <algorithm>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

namespace http = boost::beast::http;

/// What stands before the separator, which is taken off together with it; all of it without one.
std::string_view take_until(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return part;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string_view view_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

std::string_view HttpRequest::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? std::string_view{} : std::string_view(found->second);
}

HttpResponse refusal(int status) {
  const auto reason = http::obsolete_reason(static_cast<http::status>(status));
  return {.status = status, .body = fmt::format("{}\n", view_of(reason))};
}

int status_of(const boost::system::error_code& error) noexcept {
  if (error == http::error::body_limit) return 413;
  if (error == http::error::header_limit) return 431;
  if (error == http::error::bad_version) return 505;
  if (error == http::error::end_of_stream || error == http::error::partial_message) return 0;
  return error.category() == http::make_error_code(http::error::bad_target).category() ? 400 : 0;
}

std::optional<HttpRequest> parse_http_request(const http::request<http::string_body>& request) {
  HttpRequest taken{.method = std::string(view_of(request.method_string())), .body = request.body()};
  for (const auto& field : request) {
    const auto [place, is_new] =
        taken.headers.emplace(lower_case(view_of(field.name_string())), view_of(field.value()));
    if (!is_new) return std::nullopt;
  }
  std::string_view target = view_of(request.target());
  if (!target.starts_with('/')) return std::nullopt;
  taken.path = take_until(target, '?');
  while (!target.empty()) {
    std::string_view value = take_until(target, '&');
    const std::string name(take_until(value, '='));
    if (!taken.query.emplace(name, value).second) return std::nullopt;
  }
  return taken;
}

http::response<http::string_body> serialise_response(const HttpResponse& response) {
  http::response<http::string_body> message(static_cast<http::status>(response.status), 11);
  message.set(http::field::connection, "close");
  message.set(http::field::cache_control, "no-store");
  message.set(
      "Content-Security-Policy",
      fmt::format("default-src 'none'; {}; form-action 'none'; frame-ancestors 'none'; base-uri 'none'",
                  response.is_document
                      ? "style-src 'unsafe-inline'; img-src data:"
                      : "script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'"));
  message.set("Cross-Origin-Opener-Policy", "same-origin");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set("Referrer-Policy", "no-referrer");
  message.set("X-Content-Type-Options", "nosniff");
  if (response.status == 204) return message;
  message.set(http::field::content_type, response.type);
  message.body() = response.body;
  if (!response.more) message.prepare_payload();
  return message;
}

}  // namespace kerf::bench

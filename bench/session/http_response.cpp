#include "session/http_response.h"

#include <string_view>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

std::string_view reason_of(int status) noexcept {
  switch (status) {
    case 200:
      return "OK";
    case 204:
      return "No Content";
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 409:
      return "Conflict";
    case 411:
      return "Length Required";
    case 413:
      return "Content Too Large";
    case 415:
      return "Unsupported Media Type";
    case 431:
      return "Request Header Fields Too Large";
    case 501:
      return "Not Implemented";
    case 503:
      return "Service Unavailable";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Error";
  }
}

}  // namespace

HttpResponse refusal(int status) {
  return {.status = status, .body = fmt::format("{}\n", reason_of(status))};
}

std::string on_the_wire(const HttpResponse& response) {
  constexpr std::string_view fixed =
      "Connection: close\r\n"
      "Cache-Control: no-store\r\n"
      "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; "
      "connect-src 'self'; form-action 'none'; frame-ancestors 'none'; base-uri 'none'\r\n"
      "Cross-Origin-Opener-Policy: same-origin\r\n"
      "Cross-Origin-Resource-Policy: same-origin\r\n"
      "Referrer-Policy: no-referrer\r\n"
      "X-Content-Type-Options: nosniff\r\n";
  const std::string head =
      fmt::format("HTTP/1.1 {} {}\r\n{}", response.status, reason_of(response.status), fixed);
  if (response.status == 204) return fmt::format("{}\r\n", head);
  return fmt::format("{}Content-Type: {}\r\nContent-Length: {}\r\n\r\n{}", head, response.type,
                     response.body.size(), response.body);
}

}  // namespace kerf::bench

#include "session/http_request.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace kerf::bench {
namespace {

bool is_token_character(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_token_character);
}

bool is_visible(char c) noexcept { return c > ' ' && c < '\x7f'; }

bool may_be_in_a_value(char c) noexcept {
  return c == '\t' || (static_cast<unsigned char>(c) >= ' ' && c != '\x7f');
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// What stands before the separator, which is taken off together with it; all of it without one.
std::string_view take_until(std::string_view& text, std::string_view separator) {
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + separator.size());
  return part;
}

bool read_query(std::string_view query, HttpRequest& request) {
  while (!query.empty()) {
    std::string_view value = take_until(query, "&");
    const std::string name(take_until(value, "="));
    if (!request.query.emplace(name, value).second) return false;
  }
  return true;
}

/// Method, target and version: a status to refuse with, or 0.
int read_request_line(std::string_view line, HttpRequest& request) {
  const std::string_view method = take_until(line, " ");
  std::string_view target = take_until(line, " ");
  if (!is_token(method) || !target.starts_with('/') ||
      !std::all_of(target.begin(), target.end(), is_visible)) {
    return 400;
  }
  if (line != "HTTP/1.1" && line != "HTTP/1.0") {
    return line.starts_with("HTTP/") && std::all_of(line.begin(), line.end(), is_visible) ? 505 : 400;
  }
  request.method = method;
  request.path = take_until(target, "?");
  return read_query(target, request) ? 0 : 400;
}

bool read_header(std::string_view line, HttpRequest& request) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) return false;
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (!std::all_of(value.begin(), value.end(), may_be_in_a_value)) return false;
  return request.headers.emplace(lower_case(line.substr(0, colon)), value).second;
}

/// Bytes of the body that the headers announce, or a status to refuse with.
std::pair<std::size_t, int> body_length(const HttpRequest& request) {
  if (request.headers.contains("transfer-encoding")) return {0, 501};
  const auto found = request.headers.find("content-length");
  if (found == request.headers.end()) return {0, request.method == "POST" ? 411 : 0};
  const std::string& digits = found->second;
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), length);
  if (error == std::errc::result_out_of_range) return {0, 413};
  if (error != std::errc{} || end != digits.data() + digits.size()) return {0, 400};
  return {length, length > most_http_body ? 413 : 0};
}

}  // namespace

std::string_view HttpRequest::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? std::string_view{} : std::string_view(found->second);
}

HttpReading read_http_request(std::string_view bytes) {
  const std::size_t end_of_head = bytes.find("\r\n\r\n");
  if (std::min(end_of_head, bytes.size()) > most_http_head) return {.refusal = 431};
  if (end_of_head == std::string_view::npos) return {};

  HttpRequest request;
  std::string_view head = bytes.substr(0, end_of_head);
  if (const int refusal = read_request_line(take_until(head, "\r\n"), request)) return {.refusal = refusal};
  while (!head.empty()) {
    if (!read_header(take_until(head, "\r\n"), request)) return {.refusal = 400};
  }
  const auto [length, refusal] = body_length(request);
  if (refusal != 0) return {.refusal = refusal};

  const std::string_view body = bytes.substr(end_of_head + 4);
  if (body.size() < length) return {};
  if (body.size() > length) return {.refusal = 400};
  request.body = body;
  return {.request = std::move(request)};
}

}  // namespace kerf::bench

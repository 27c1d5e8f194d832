#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace kerf::bench {

inline constexpr std::size_t most_http_head = 8192;  ///< bytes of request line and headers
inline constexpr std::size_t most_http_body = 4096;  ///< bytes

/// One request of HTTP/1.1 (RFC 9112), taken apart. Nothing is decoded: what needs a %-sequence is not for
/// us.
struct HttpRequest {
  std::string method;                          ///< "GET"
  std::string path;                            ///< "/view"
  std::map<std::string, std::string> query;    ///< "after" = "12"
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;

  /// Value of a header, by its name in lower case; empty if there is none.
  [[nodiscard]] std::string_view header(const std::string& name) const;
};

/// What came of the bytes so far: a request, a status to refuse them with, or neither, where more must come.
struct HttpReading {
  std::optional<HttpRequest> request;
  int refusal = 0;
};

/// Reads strictly, since nobody but a browser on this machine has a reason to write: lines end in CR LF, no
/// header comes twice, a body has a Content-Length, nothing follows it. Refusals: 400 malformed, 411 body
/// without length, 413 body too long, 431 head too long, 501 another transfer encoding, 505 another version.
[[nodiscard]] HttpReading read_http_request(std::string_view bytes);

}  // namespace kerf::bench

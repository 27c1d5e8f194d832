#pragma once

#include <string>

namespace kerf::bench {

/// What is answered to a request. Every answer closes its connection and is not to be stored, framed or
/// guessed at by the browser; nothing but the server's own files may be loaded by it.
struct HttpResponse {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
};

/// A status with its name in the standard for a text.
[[nodiscard]] HttpResponse refusal(int status);

/// With status line and headers.
[[nodiscard]] std::string on_the_wire(const HttpResponse& response);

}  // namespace kerf::bench

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "session/http_request.h"

// Bytes as a browser, or somebody else, sends them: what is taken keeps within its bounds, comes out the same however it
// is cut, and no request is also a refusal.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf::bench;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const HttpReading reading = read_http_request(bytes);
  if (reading.request && reading.refusal != 0) std::abort();
  if (!reading.request) return 0;
  const HttpRequest& request = *reading.request;
  if (request.body.size() > most_http_body || !request.path.starts_with('/')) std::abort();
  for (const auto& [name, value] : request.headers) {
    if (name.empty() || value.find_first_of("\r\n") != std::string::npos) std::abort();
  }
  for (std::size_t part = 0; part < size; ++part) {
    const HttpReading before = read_http_request(bytes.substr(0, part));
    if (before.request || before.refusal != 0) std::abort();
  }
  return 0;
}

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "usbip.h"

// A request that is understood names an endpoint that exists and a buffer that fits, and says the same again
// when written.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace usbip = kerf::emulators::usbip;
  std::array<std::uint8_t, usbip::header_size> header{};
  std::copy_n(data, std::min(size, header.size()), header.begin());
  if (size > 3 && data[0] % 2 == 0) header[0] = header[1] = header[2] = 0;  // so that commands are met often
  if (const auto request = usbip::parse_request(header)) {
    if (request->endpoint > 15 || request->length > 1U << 20U) std::abort();
    const auto again = usbip::parse_request(usbip::encode(*request));
    if (!again || again->sequence != request->sequence || again->length != request->length ||
        again->unlinked != request->unlinked || again->setup != request->setup) {
      std::abort();
    }
  }
  if (size >= usbip::operation_size) {
    (void)usbip::parse_operation(
        std::span<const std::uint8_t, usbip::operation_size>(data, usbip::operation_size));
  }
  return 0;
}

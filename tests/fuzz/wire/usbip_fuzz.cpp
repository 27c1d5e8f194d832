#include <algorithm>
#include <array>

#include "fuzz/target.h"
#include "usbip.h"

namespace kerf::fuzz {
namespace {

namespace usbip = emulators::usbip;

/// A request that is understood names an endpoint that exists and a buffer that fits, and says the same again
/// when written.
void fuzz_usbip(Bytes bytes) {
  std::array<std::uint8_t, usbip::header_size> header{};
  std::copy_n(bytes.begin(), std::min(bytes.size(), header.size()), header.begin());
  if (bytes.size() > 3 && bytes[0] % 2 == 0)
    header[0] = header[1] = header[2] = 0;  // so that commands are met often
  if (const auto request = usbip::parse_request(header)) {
    promise(request->endpoint <= 15 && request->length <= 1U << 20U, "an endpoint exists and a buffer fits");
    const auto again = usbip::parse_request(usbip::encode(*request));
    promise(again && again->sequence == request->sequence && again->length == request->length &&
                again->unlinked == request->unlinked && again->setup == request->setup,
            "a request is written as it is read");
  }
  if (bytes.size() >= usbip::operation_size)
    (void)usbip::parse_operation(bytes.first<usbip::operation_size>());
}

const Registered registered("usbip", fuzz_usbip);

}  // namespace
}  // namespace kerf::fuzz

#include <cstdlib>

#include "kerf/drivers/protocols/c2000_image.h"

// A file that somebody took for firmware: what is found whole ends with its last byte, and holds no more than
// it has.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf::drivers;
  const bool whole = c2000::problem_of({data, size}).empty();
  c2000::Stream stream;
  for (std::size_t i = 0; i < size; ++i) (void)stream.take(data[i]);
  if (whole != (size > 0 && stream.state() == c2000::Stream::State::finished &&
                c2000::problem_of({data, size - 1}) == "it ends too early")) {
    std::abort();
  }
  if (2 * stream.words() > size) std::abort();
  return 0;
}

#include <kerf/drivers/protocols/c2000_image.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

namespace c2000 = drivers::c2000;

/// A file that somebody took for firmware: what is found whole ends with its last byte, and holds no more
/// than it has.
void fuzz_c2000_image(Bytes bytes) {
  c2000::Stream stream;
  for (const std::uint8_t byte : bytes) (void)stream.take(byte);
  promise(2 * stream.words() <= bytes.size(), "an image has no more words than bytes");
  const bool ends_with_its_last_byte =
      !bytes.empty() && stream.state() == c2000::Stream::State::finished &&
      c2000::problem_of(bytes.first(bytes.size() - 1)) == "it ends too early";
  promise(c2000::problem_of(bytes).empty() == ends_with_its_last_byte,
          "what is whole ends with its last byte");
}

const Registered registered("c2000_image", fuzz_c2000_image);

}  // namespace
}  // namespace kerf::fuzz

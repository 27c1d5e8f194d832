#include <cstdlib>

#include "kerf/drivers/protocols/spacemouse.h"

// A report that is refused leaves no trace.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kerf::drivers::spacemouse;
  State state;
  const State before = state;
  if (!take_report({data, size}, state) && !(state == before)) std::abort();
  return 0;
}

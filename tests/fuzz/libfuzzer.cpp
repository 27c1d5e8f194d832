#include "fuzz/target.h"

// What libFuzzer calls: the one fuzzer that is linked with it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kerf::fuzz::targets().front().run({data, size});
  return 0;
}

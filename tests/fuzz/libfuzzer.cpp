#include "fuzz/target.h"

// HDF5 loses memory over a file that is out of order.
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }

// What libFuzzer calls: the one fuzzer that is linked with it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kerf::fuzz::targets().front().run({data, size});
  return 0;
}

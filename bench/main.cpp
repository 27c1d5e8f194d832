#include <malloc.h>

#include "program/app.h"
#include "program/missing_memory.h"

namespace {

/// Before all that the program initialises.
[[gnu::constructor(101)]] void watch_for_memory() { kerf::bench::end_where_memory_is_missing(); }

}  // namespace

int main(int argc, char** argv) {
  // A fit takes and gives back whole columns of samples; memory that returns to the kernel each time is
  // cleared anew.
  constexpr int large = 1 << 28;
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, large);
  return kerf::bench::run_program(argc, argv);
}

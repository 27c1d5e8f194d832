#include <malloc.h>

#include "program/app.h"

int main(int argc, char** argv) {
  // A fit takes and gives back whole columns of samples; memory that returns to the kernel each time is
  // cleared anew.
  constexpr int large = 1 << 28;
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, large);
  return kerf::bench::run_program(argc, argv);
}

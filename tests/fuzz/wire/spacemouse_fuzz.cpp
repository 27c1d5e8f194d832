#include <kerf/drivers/protocols/spacemouse.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

namespace spacemouse = drivers::spacemouse;

/// A report that is refused leaves no trace.
void fuzz_spacemouse(Bytes bytes) {
  spacemouse::State state;
  const spacemouse::State before = state;
  promise(spacemouse::take_report(bytes, state) || state == before,
          "a report that is refused leaves no trace");
}

const Registered registered("spacemouse", fuzz_spacemouse);

}  // namespace
}  // namespace kerf::fuzz

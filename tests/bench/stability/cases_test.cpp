#include "stability/cases/cases.h"

#include <gtest/gtest.h>

#include "stability/cases/control_cost.h"

namespace kerf::bench {
namespace {
TEST(Cases, Print) {
  for (const NamedCase& c : run_cases({}, 1)) {
    printf("%s\n  without %d %g %s | %s\n  with %d %g %s | %s\n  %s\n", c.name.c_str(), c.without.holds,
           c.without.measured, c.without.unit.c_str(), c.without.figure.c_str(), c.with.holds, c.with.measured,
           c.with.unit.c_str(), c.with.figure.c_str(), c.theory.c_str());
  }
  for (auto& r : control_costs().rows)
    printf("%g K %g %d %d rms %g worst %g jnd %g %g\n", r.share, r.stiffness_n_per_m, r.holds_without, r.holds_with,
           r.rms_n, r.worst_n, r.rms_jnd, r.worst_jnd);
}
}  // namespace
}  // namespace kerf::bench

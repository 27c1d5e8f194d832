// The effect of test::wall in a program of somebody who has CHAI3D: says what does not hold.
#include <cmath>
#include <cstdio>

#include "wall_chai3d.h"

using chai3d::cVector3d;

namespace {

struct Effect : kerf_wall::cEffectLaw {
  using cEffectLaw::cEffectLaw;
  double elapsed_s(unsigned int) override { return 1e-3; }
};

void expect(bool holds, const char* what) {
  if (!holds) std::printf("does not hold: %s\n", what);
}

bool is_near(double is, double expected) { return std::fabs(is - expected) < 1e-9; }

}  // namespace

int main() {
  chai3d::cGenericObject object;
  Effect effect(&object, 2);
  const cVector3d at_rest(0, 0, 0);
  cVector3d force;

  // 100 N/m from 10 mm on, along z, as the law file has it.
  expect(effect.computeForce(cVector3d(0.3, 0.4, 0.03), at_rest, 0, force), "a wall that is pressed acts");
  expect(is_near(force.x(), 0) && is_near(force.y(), 0) && is_near(force.z(), -2), "it pushes back along z");

  // Below a surface at y = 50 mm; 2 N·s/m more for a tool that goes in.
  expect(!effect.place(cVector3d(0, 0, 0), at_rest), "a direction has a length");
  expect(effect.place(cVector3d(0, 0.05, 0), cVector3d(0, -3, 0)), "it is placed");
  expect(effect.computeForce(cVector3d(0.3, 0.04, 0.4), cVector3d(7, -0.5, 7), 1, force), "it acts there");
  expect(is_near(force.x(), 0) && is_near(force.y(), 1 + 1) && is_near(force.z(), 0), "it pushes up");
  expect(effect.storedEnergy(1) > 0.0049, "a wall holds k d^2 / 2");
  expect(is_near(effect.storedEnergy(0), 100 * 0.02 * 0.02 / 2), "another tool has a state of its own");
  effect.reset(1);

  expect(!effect.computeForce(cVector3d(0, 0, 0), at_rest, 2, force) && is_near(force.y(), 0),
         "a tool beyond the last feels nothing");
  const double no_number = std::nan("");
  expect(!effect.computeForce(cVector3d(0, no_number, 0), at_rest, 0, force) && is_near(force.y(), 0) &&
             effect.flags(0) == KERF_LAW_FAULT,
         "a place that is no number is a fault with zero force");

  effect.useVelocity(false);
  effect.reset(1);
  expect(effect.computeForce(cVector3d(0, 0.04, 0), cVector3d(0, -0.5, 0), 1, force) && is_near(force.y(), 1),
         "a velocity that is not believed is not taken");

  // As CHAI3D calls it: without a time, through the base.
  kerf_wall::cEffectLaw by_clock(&object);
  chai3d::cGenericEffect& base = by_clock;
  for (unsigned int tool = 0; tool < 16; ++tool)
    expect(base.computeForce(cVector3d(0, 0, 0.02), at_rest, tool, force) && is_near(force.z(), -1),
           "the library's clock does");
  try {
    kerf_wall::cEffectLaw with_plugin(&object, 1, "/nowhere/plugin.so");
    expect(false, "a plug-in that is not there is told");
  } catch (const std::runtime_error& error) {
    expect(error.what()[0] == '/', "with its name");
  }
  return 0;
}

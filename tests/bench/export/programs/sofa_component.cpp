// The plug-in of test::wall as SOFA loads it: says what does not hold.
#include <cmath>
#include <cstdio>

#include "wall_sofa.cpp"

using Component = kerf_wall::WallForceFeedback;
using Vec3 = Component::Vec3;

namespace {

struct Timed : Component {
  Timed() { d_activate.setValue(true); }
  double elapsed_s() override { return 1e-3; }
};

void expect(bool holds, const char* what) {
  if (!holds) std::printf("does not hold: %s\n", what);
}

bool is(const Vec3& force, double x, double y, double z) {
  return std::fabs(force[0] - x) < 1e-9 && std::fabs(force[1] - y) < 1e-9 && std::fabs(force[2] - z) < 1e-9;
}

Vec3 at(Component& component, double x, double y, double z) {
  SReal fx = 7, fy = 7, fz = 7;
  component.computeForce(x, y, z, 0, 0, 0, 0, fx, fy, fz);
  return Vec3(fx, fy, fz);
}

Vec3 wrench_at(Component& component, const Vec3& place, const Vec3& speed) {
  kerf_wall::Transform tool;
  tool.setOrigin(place);
  kerf_wall::SpatialVector velocity;
  velocity.setLinearVelocity(speed);
  kerf_wall::SpatialVector wrench;
  wrench.setTorque(Vec3(7, 7, 7));
  component.computeWrench(tool, velocity, wrench);
  expect(is(wrench.getTorque(), 0, 0, 0), "there is no torque");
  return wrench.getForce();
}

bool refuses(void (*set)(Component&)) {
  Component component;
  component.d_activate.setValue(true);
  set(component);
  component.init();
  return is(at(component, 0.01, 0.01, 9), 0, 0, 0);
}

}  // namespace

int main() {
  initExternalModule();
#if SOFA_VERSION >= 241200
  registerObjects(sofa::core::ObjectFactory::getInstance());
#endif
  const auto* const factory = sofa::core::ObjectFactory::getInstance();
  expect(factory->name == getModuleComponentList(), "the factory has the component");
  sofa::core::behavior::BaseController* const made = factory->create();
  auto* const component = dynamic_cast<Component*>(made);

  component->d_activate.setValue(true);
  expect(is(at(*component, 0, 0, 0.03), 0, 0, 0), "there is no force before init()");
  component->init();
  // 100 N/m from 10 mm on, along z, as the law file has it; by the library's clock.
  expect(is(at(*component, 0.3, 0.4, 0.03), 0, 0, -2), "it pushes back along z");
  expect(std::fabs(component->storedEnergy() - 100 * 0.02 * 0.02 / 2) < 1e-12, "a wall holds k d^2 / 2");
  component->d_activate.setValue(false);
  expect(is(at(*component, 0, 0, 0.03), 0, 0, 0), "switched off, it gives no force");

  // A scene in mm and mN; 2 N·s/m more for a tool that goes in.
  Timed placed;
  placed.d_contact.setValue(Vec3(0, 50, 0));
  placed.d_direction.setValue(Vec3(0, -1, 0));
  placed.d_metresPerUnit.setValue(1e-3);
  placed.d_newtonsPerUnit.setValue(1e-3);
  placed.d_useVelocity.setValue(true);
  placed.init();
  expect(is(wrench_at(placed, Vec3(1, 40, 2), Vec3(9, -500, 9)), 0, 2000, 0),
         "forces are in units of the scene");
  expect(is(at(placed, 0, std::nan(""), 0), 0, 0, 0) && placed.flags() == KERF_LAW_FAULT,
         "a place that is no number is a fault with zero force");

  // A driver that gives zero for a velocity is not believed.
  Timed moving;
  moving.init();
  for (int tick = 0; tick < 300; ++tick) wrench_at(moving, Vec3(0, 0, 1e-4 * tick), Vec3(0, 0, 0));
  expect(is(wrench_at(moving, Vec3(0, 0, 0.03), Vec3(0, 0, 0)), 0, 0, -2 - 2 * 0.1), "it moves at 0.1 m/s");

  expect(refuses([](Component& it) { it.d_contact.setValue(Vec3(0, 0, 1)); }), "a contact has a direction");
  expect(refuses([](Component& it) {
           it.d_contact.setValue(Vec3(0, 0, 1));
           it.d_direction.setValue(Vec3(0, 0, 0));
         }),
         "a direction has a length");
  expect(refuses([](Component& it) { it.d_metresPerUnit.setValue(0); }), "a unit is above zero");
  expect(refuses([](Component& it) { it.d_plugin.setValue("/nowhere/plugin.so"); }), "a plug-in is there");
  delete made;
  return 0;
}

// The law of examples/fuzzy_kelvin_3d.law.toml in a scene whose y is up: says what does not hold.
#include <cstdio>

#include "liver_sofa.cpp"

namespace {

struct Timed : kerf_liver::LiverForceFeedback {
  Timed() { d_activate.setValue(true); }
  double elapsed_s() override { return 1e-3; }
};

}  // namespace

int main() {
  Timed component;
  component.d_contact.setValue(Timed::Vec3(0.5, 0.25, 0));  // exact in binary, as all differences from it
  component.d_xAxis.setValue(Timed::Vec3(1, 0, 0));
  component.d_yAxis.setValue(Timed::Vec3(0, 0, -1));
  component.d_zAxis.setValue(Timed::Vec3(0, 1, 0));
  component.d_useVelocity.setValue(true);
  component.init();

  kerf_law* law = nullptr;
  kerf_state* state = nullptr;
  kerf_law_parse(kerf_liver::law_text, sizeof kerf_liver::law_text - 1, "a law", &law, nullptr, 0);
  kerf_state_create(law, &state, nullptr, 0);
  double largest = 0;
  for (int tick = 0; tick < 300; ++tick) {
    const double x = tick / 65536.0, y = tick / 131072.0, z = -tick / 32768.0;
    const double place[3] = {x, y, z};
    const double speed[3] = {0.015, 0.0075, -0.03};
    double expected[3];
    kerf_step_axes(state, place, speed, 1e-3, expected);

    kerf_liver::Transform tool;
    tool.setOrigin(Timed::Vec3(0.5 + x, 0.25 + z, -y));
    kerf_liver::SpatialVector velocity;
    velocity.setLinearVelocity(Timed::Vec3(speed[0], speed[2], -speed[1]));
    kerf_liver::SpatialVector wrench;
    component.computeWrench(tool, velocity, wrench);
    const double force[3] = {wrench.getForce()[0], -wrench.getForce()[2], wrench.getForce()[1]};
    for (int i = 0; i < 3; ++i) {
      if (force[i] != expected[i])
        std::printf("tick %d, axis %d: %g, expected %g\n", tick, i, force[i], expected[i]);
      largest = std::fmax(largest, std::fabs(force[i]));
    }
  }
  if (!(largest > 0.01)) std::printf("the tool meets nothing: %g N\n", largest);
  kerf_state_destroy(state);
  kerf_law_close(law);

  Timed crooked;
  crooked.d_zAxis.setValue(Timed::Vec3(0.1, 0, 1));
  crooked.init();
  if (!std::isnan(crooked.storedEnergy())) std::printf("axes that are not at right angles are refused\n");
  return 0;
}

#include "kerf/drivers/simulated_drive.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/allocation_counter.h"
#include "support/program.h"

namespace kerf::drivers {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double tick_s = 1e-3;
const std::string exact = "sim:axis?noise=off&encoder=off&truth=on";
const std::string bare = exact + "&hand=off&viscous=0Ns/m&coulomb=0N";

/// Reads at each tick and writes `force(n)` after it; the samples of ticks 0 to `ticks`.
template <typename Force>
std::vector<Sample> run(Device& device, int ticks, Force force) {
  std::vector<Sample> samples;
  for (int n = 0; n <= ticks; ++n) {
    samples.emplace_back();
    EXPECT_EQ(device.read(n * tick_s, samples.back()), Status::ok);
    EXPECT_EQ(device.write({force(n)}), Status::ok);
  }
  return samples;
}
template <typename Force>
std::vector<Sample> run(const std::string& uri, int ticks, Force force) {
  const auto device = open_device(uri);
  return run(*device, ticks, force);
}

TEST(SimulatedDrive, AnswersForcesThatAreLateByPartsOfATickAsTheMatrixExponentialDoes) {
  // scipy.linalg.expm from event to event: u(n) = sin(0.37 n) + 0.5 (n mod 3) acts from n T + 1.3 ms on.
  const auto samples =
      run(exact +
              "&mass=0.1kg&viscous=0.5Ns/m&coulomb=0N&hand_mass=0.15kg&hand_damping=5Ns/m&grip=500N/m"
              "&delay=1.3ms",
          50, [](int n) { return std::sin(0.37 * n) + 0.5 * (n % 3); });
  EXPECT_EQ(samples[2].position[0], 0.0);
  EXPECT_NEAR(samples[3].position[0], 8.399967272839377e-07, 1e-17);
  EXPECT_NEAR(samples[10].position[0], 0.00013913427244995196, 1e-15);
  EXPECT_NEAR(samples[50].position[0], 0.0013098258880347576, 1e-14);
}

TEST(SimulatedDrive, IsLateByTheDelayThatIsSet) {
  for (const double ticks : {0.0, 0.3, 1.0, 2.5, 3.7, 31.9}) {
    for (const std::string& delay : {fmt::format("{}ms", ticks), fmt::format("{}ticks", ticks)}) {
      const auto samples = run(bare + "&mass=0.1kg&delay=" + delay, 40, [](int) { return 2.0; });
      // x = F (t - d)^2 / (2 m)
      const double late_s = 40 * tick_s - std::sqrt(2.0 * 0.1 * samples[40].position[0] / 2.0);
      EXPECT_NEAR(late_s, ticks * tick_s, 1e-12) << delay;
    }
  }
}

TEST(SimulatedDrive, IsStoppedByCoulombFrictionWhereTheClosedFormSays) {
  // m = 0.08 kg, b = 0.2 N·s/m, f_c = 0.1 N, 2 N for 5 ms: it rests at 89.7592 ms, 5.12040 mm on.
  const auto samples = run(exact + "&hand=off&mass=0.08kg&viscous=0.2Ns/m&coulomb=0.1N", 120,
                           [](int n) { return n < 5 ? 2.0 : 0.0; });
  EXPECT_NEAR(samples[120].position[0], 0.005120402234296453, 1e-12);
  EXPECT_LT(samples[89].position[0], 0.005120402234296453 - 1e-8);
  EXPECT_EQ(samples[90].position[0], samples[120].position[0]);
}

TEST(SimulatedDrive, SticksInEachDirectionUnderTheFrictionOfThat) {
  const std::string uri = exact + "&hand=off&coulomb=0.1N&coulomb_down=0.3N";
  EXPECT_EQ(run(uri, 10, [](int) { return 0.0999; })[10].position[0], 0.0);
  EXPECT_GT(run(uri, 10, [](int) { return 0.101; })[10].position[0], 0.0);
  EXPECT_EQ(run(uri, 10, [](int) { return -0.2999; })[10].position[0], 0.0);
  EXPECT_LT(run(uri, 10, [](int) { return -0.301; })[10].position[0], 0.0);
}

TEST(SimulatedDrive, FallsUnderGravity) {
  const auto samples = run(bare + "&mass=0.1kg&gravity=-0.2N", 30, [](int) { return 0.0; });
  EXPECT_NEAR(samples[30].position[0], -0.2 / 0.1 / 2.0 * 0.03 * 0.03, 1e-15);
}

TEST(SimulatedDrive, IsSeenThroughItsEncoder) {
  const auto samples = run("sim:axis?hand=off&noise=off&truth=on&step=0.05mm", 60, [](int) { return 1.0; });
  double largest = 0.0;
  for (const Sample& sample : samples) {
    const double steps = sample.position[0] / 0.05e-3;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    largest = std::max(largest, std::abs(sample.position[0] - sample.channels[0]));
  }
  EXPECT_LE(largest, 0.025e-3 + 1e-12);
  EXPECT_GT(largest, 0.02e-3);
}

TEST(SimulatedDrive, FiltersItsVelocityAtTheCornerThatIsSet) {
  const auto plain = run(bare + "&mass=0.1kg&corner=0Hz", 20, [](int) { return 1.0; });
  EXPECT_NEAR(plain[20].velocity[0], (plain[20].position[0] - plain[19].position[0]) / tick_s, 1e-12);
  const auto filtered = run(bare + "&mass=0.1kg&corner=100Hz", 400, [](int n) { return n < 1 ? 5.0 : 0.0; });
  EXPECT_NEAR(filtered[3].velocity[0],
              0.05 * (1.0 - std::exp(-2.0 * 0.2 * M_PI)) +
                  (0.025 * (1.0 - std::exp(-0.2 * M_PI))) * std::exp(-2.0 * 0.2 * M_PI),
              1e-12);
}

TEST(SimulatedDrive, GivesWhatItsMotorCan) {
  const auto acting = [](const std::string& options, double command) {
    return run(exact + "&hand=off&limit=8N" + options, 3, [&](int) { return command; })[3].channels[2];
  };
  EXPECT_EQ(acting("", 5.0), 5.0);
  EXPECT_EQ(acting("", 50.0), 8.0) << "the limit that it tells";
  EXPECT_EQ(acting("&motor_constant=0.9", 5.0), 4.5);
  EXPECT_EQ(acting("&saturation=3N", 5.0), 3.0);
  EXPECT_EQ(acting("&saturation=3N", -5.0), -3.0);
  EXPECT_EQ(acting("&sign=-1", 5.0), -5.0);
  EXPECT_EQ(acting("&motor=off", 5.0), 0.0);
}

TEST(SimulatedDrive, MeasuresWhatHandAndTissueExert) {
  const auto held = run(exact + "&coulomb=0N&grip=500N/m", 2000, [](int) { return 2.0; });
  EXPECT_NEAR(held.back().position[0], 2.0 / 500.0, 1e-9);
  EXPECT_NEAR(held.back().force_measured[0], -2.0, 1e-6);
  const auto other = run(exact + "&coulomb=0N&grip=500N/m&sensor_sign=-1", 2000, [](int) { return 2.0; });
  EXPECT_NEAR(other.back().force_measured[0], 2.0, 1e-6);
  // In the first instant the force moves the device's mass and the hand's: the hand's share is its mass'.
  const auto begun = run(exact + "&mass=0.1kg&hand_mass=0.15kg&hand_damping=0Ns/m&viscous=0Ns/m&coulomb=0N",
                         1, [](int) { return 2.0; });
  EXPECT_NEAR(begun[1].force_measured[0], -2.0 * 0.15 / 0.25, 0.02);
  EXPECT_TRUE(std::isnan(run(exact + "&sensor=off", 1, [](int) { return 0.0; })[1].force_measured[0]));
}

TEST(SimulatedDrive, MeetsTissue) {
  Surroundings surroundings;
  surroundings.tissue[0] = [](double position, double, double period_s) {
    EXPECT_EQ(period_s, 50e-6);
    return -1000.0 * position;
  };
  const auto device = open_device(exact + "&hand=off&coulomb=0N&viscous=20Ns/m", surroundings);
  const auto samples = run(*device, 1000, [](int) { return 2.0; });
  EXPECT_NEAR(samples.back().position[0], 2e-3, 1e-9);
  EXPECT_NEAR(samples.back().force_measured[0], -2.0, 1e-6);
}

TEST(SimulatedDrive, StopsAtTheEndsOfItsRange) {
  const auto samples = run(bare + "&range=5mm", 200, [](int n) { return n < 100 ? 3.0 : -3.0; });
  EXPECT_EQ(samples[100].position[0], 5e-3);
  EXPECT_EQ(samples[200].position[0], -5e-3);
}

TEST(SimulatedDrive, BendsAsTwoMassesOnASpring) {
  // scipy.linalg.expm: 0.04 kg, and 0.04 kg + 0.15 kg in a hand of 5 N·s/m, 500 N/m; 20 N/mm, 1 N·s/m.
  const auto samples = run(exact +
                               "&mass=0.08kg&viscous=0.2Ns/m&coulomb=0N&hand_mass=0.15kg&hand_damping=5Ns/m"
                               "&grip=500N/m&flexible=20000N/m&flexible_damping=1Ns/m",
                           20, [](int) { return 1.0; });
  EXPECT_NEAR(samples[1].position[0], 1.187274556481924e-05, 1e-13);
  EXPECT_NEAR(samples[5].position[0], 0.0001110880119030833, 1e-12);
  EXPECT_NEAR(samples[20].position[0], 0.0007662622865080219, 1e-12);
}

TEST(SimulatedDrive, CogsAsASine) {
  // scipy.integrate.solve_ivp, rtol 1e-12: 0.08 x'' = 0.5 + 0.3 sin(2 pi x / 2 mm) - 0.2 x'
  const auto samples = run(exact + "&hand=off&mass=0.08kg&viscous=0.2Ns/m&coulomb=0N&cogging=0.3N", 50,
                           [](int) { return 0.5; });
  EXPECT_NEAR(samples[10].position[0], 0.00034028, 1e-8);
  EXPECT_NEAR(samples[50].position[0], 0.00831834, 2e-8);
}

TEST(SimulatedDrive, HasPlayBetweenMotorAndHandle) {
  const auto motor_at = [](const std::string& options) {
    return run(exact + "&coulomb=0N&grip=1000N/m" + options, 1500, [](int) { return 0.4; })[1500].position[0];
  };
  EXPECT_NEAR(motor_at(""), 0.4e-3, 1e-5);
  EXPECT_NEAR(motor_at("&backlash=1mm"), 0.5e-3 + 0.4e-3 + 0.4 / 50e3, 1e-5);
}

TEST(SimulatedDrive, IsMovedAndShakenByItsHand) {
  const auto swaying = run(exact + "&sway=20mm", 3000, [](int) { return 0.0; });
  double most = 0.0;
  for (const Sample& sample : swaying) most = std::max(most, std::abs(sample.position[0]));
  EXPECT_NEAR(most, 0.02, 0.001);
  // Stiff, without mass and friction, the sensor reads the tremor itself.
  const auto shaken = run(exact + "&tremor=0.1N&hand_mass=0kg&mass=1000kg&hand_damping=0Ns/m&grip=0N/m",
                          20000, [](int) { return 0.0; });
  double squares = 0.0;
  for (const Sample& sample : shaken) squares += sample.force_measured[0] * sample.force_measured[0];
  EXPECT_NEAR(std::sqrt(squares / 20001.0), 0.1, 0.01);
}

TEST(SimulatedDrive, DrawsTheSameByOneSeed) {
  const auto last = [](const std::string& seed) {
    const auto samples = run("sim:axis?jitter=0.2ms&tremor=0.05N&encoder_noise=0.01mm&delay=1ms&seed=" + seed,
                             300, [](int n) { return std::sin(0.1 * n); });
    return std::array{samples.back().position[0], samples.back().force_measured[0],
                      samples.back().velocity[0]};
  };
  EXPECT_EQ(last("7"), last("7"));
  EXPECT_NE(last("7"), last("8"));
}

TEST(SimulatedDrive, LetsItsDelaysVaryAsAskedFor) {
  // Steps far apart from each other: each shows its own delay. x_motor_true is read finely.
  const auto device = open_device(exact + "&delay=2ms&jitter=0.3ms&hand=off");
  Sample sample;
  double sum = 0.0;
  double squares = 0.0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i) {
    const double begins_s = 0.01 * i;
    (void)device->read(begins_s, sample);
    const double command = i % 2 == 0 ? 1.0 : -1.0;
    (void)device->write({command});
    double late_s = 0.0;
    while (late_s < 6e-3) {
      late_s += 10e-6;
      (void)device->read(begins_s + late_s, sample);
      if (sample.channels[2] == command) break;
    }
    sum += late_s;
    squares += late_s * late_s;
  }
  const double mean_s = sum / steps;
  EXPECT_NEAR(mean_s, 2e-3, 0.05e-3);
  EXPECT_NEAR(std::sqrt(squares / steps - mean_s * mean_s), 0.3e-3, 0.03e-3);
}

TEST(SimulatedDrive, LetsGoAtOnceWhenItIsReleased) {
  const auto device = open_device(bare + "&delay=2ms");
  Sample sample;
  (void)run(*device, 10, [](int) { return 1.0; });
  device->release(0.0105);
  (void)device->read(0.011, sample);
  EXPECT_EQ(sample.channels[2], 0.0);
  (void)device->read(0.02, sample);
  EXPECT_EQ(sample.channels[2], 0.0) << "what was on its way does not act any more";
  (void)device->write({0.5});
  (void)device->read(0.0215, sample);
  EXPECT_EQ(sample.channels[2], 0.0) << "what was held before does not come back";
  (void)device->read(0.0225, sample);
  EXPECT_EQ(sample.channels[2], 0.5);
  EXPECT_EQ(device->write({std::nan("")}), Status::fault);
  (void)device->read(0.023, sample);
  EXPECT_EQ(sample.channels[2], 0.0);
}

TEST(SimulatedDrive, HasSeveralAxesThatDoNotActOnEachOther) {
  const auto device = open_device(bare + "&axes=3&mass=0.1kg,0.2kg,0.4kg&delay=0s,1ms,2.5ms");
  ASSERT_EQ(device->info().axes.size(), 3U);
  EXPECT_EQ(device->info().axes[2].name, "z");
  Sample sample;
  for (int n = 0; n <= 20; ++n) {
    (void)device->read(n * tick_s, sample);
    (void)device->write({1.0, 1.0, 0.0});
  }
  EXPECT_NEAR(sample.position[0], 0.5 / 0.1 * 0.02 * 0.02, 1e-14);
  EXPECT_NEAR(sample.position[1], 0.5 / 0.2 * 0.019 * 0.019, 1e-14);
  EXPECT_EQ(sample.position[2], 0.0);
}

TEST(SimulatedDrive, TellsItsMechanicsUnlessAskedNotTo) {
  const auto device =
      open_device("sim:axis?mass=0.07kg&viscous=0.3Ns/m&coulomb=0.2N&coulomb_down=0.4N&serial=S1");
  ASSERT_TRUE(device->info().axes[0].mechanics);
  EXPECT_EQ(device->info().axes[0].mechanics->mass_kg, 0.07);
  EXPECT_NEAR(device->info().axes[0].mechanics->coulomb_n, 0.3, 1e-15);
  EXPECT_EQ(device->info().serial, "S1");
  EXPECT_FALSE(open_device("sim:axis?tells=off")->info().axes[0].mechanics);
}

TEST(SimulatedDrive, AllocatesNothingInATick) {
  const auto device =
      open_device("sim:axis?axes=3&jitter=0.2ms&delay=3.7ticks&sway=5mm&tremor=0.1N&truth=on");
  Sample sample;
  (void)device->read(0.0, sample);
  const std::size_t before = test::allocations();
  for (int n = 1; n <= 50; ++n) {
    (void)device->read(n * tick_s, sample);
    (void)device->write({0.5, -0.5, 0.1});
  }
  EXPECT_EQ(test::allocations(), before);
}

class ModelFile {
 public:
  explicit ModelFile(const DeviceModel& model) { std::ofstream(path()) << to_toml(model); }
  [[nodiscard]] std::string uri() const { return exact + "&model=" + path().string(); }

 private:
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "simulated.device.toml"; }

  test::TemporaryFolder folder_;
};

DeviceModel measured_model() {
  DeviceModel model;
  model.date = "2026-01-31T12:00:00Z";
  model.rate_hz = 1000.0;
  model.uri = "falcon:0";
  model.model = "Novint Falcon";
  AxisModel z;
  z.name = "z";
  z.limits = {
      .lower = 0.075, .upper = 0.175, .force = 9.0, .slew = 2000.0, .speed = 5.0, .acceleration = 200.0};
  z.mass = Estimate{0.09, 0.08, 0.1};
  z.viscous = Estimate{0.4, 0.3, 0.5};
  z.coulomb_up = Estimate{0.2, 0.1, 0.3};
  z.coulomb_down = Estimate{0.3, 0.1, 0.3};
  z.delay = Estimate{1.7e-3, 1.6e-3, 1.8e-3};
  z.gravity = Estimate::exactly(-0.1);
  z.motor_constant = Estimate::exactly(0.8);
  model.axes = {z};
  return model;
}

TEST(SimulatedDrive, RehearsesAModelAsTheSameNumbersByHandWould) {
  const ModelFile file(measured_model());
  const auto rehearsed = open_device(file.uri());
  EXPECT_EQ(rehearsed->info().axes[0].name, "z");
  EXPECT_EQ(rehearsed->info().axes[0].lower, 0.075);
  const auto wave = [](int n) { return 2.0 * std::sin(0.2 * n); };
  const auto samples = run(*rehearsed, 200, wave);
  const auto by_hand =
      run(exact +
              "&range=50mm&limit=9N&mass=0.09kg&viscous=0.4Ns/m&coulomb=0.2N&coulomb_down=0.3N&delay=1.7ms"
              "&gravity=-0.1N&motor_constant=0.8",
          200, wave);
  EXPECT_NEAR(samples[200].position[0], 0.125 + by_hand[200].position[0], 1e-15) << "it begins in the middle";
  EXPECT_NE(by_hand[200].position[0], 0.0);
}

TEST(SimulatedDrive, DoesNotRehearseWhatNobodyKnows) {
  const auto refused = [](const DeviceModel& model, const std::string& more) -> std::string {
    const ModelFile file(model);
    try {
      (void)open_device(file.uri() + more);
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "taken";
  };
  DeviceModel model = measured_model();
  model.axes[0].coulomb_down.reset();
  EXPECT_THAT(refused(model, ""), AllOf(HasSubstr("does not know 'coulomb_down' of axis 'z'"),
                                        HasSubstr("give coulomb_down= in the URI")));
  EXPECT_EQ(refused(model, "&coulomb_down=0.1N"), "taken");
  EXPECT_THAT(refused(measured_model(), "&axes=2"), HasSubstr("does not go with 'model'"));
}

TEST(SimulatedDrive, RefusesWhatItHasNot) {
  const auto refused = [](const std::string& options) -> std::string {
    try {
      (void)open_device("sim:axis?" + options);
    } catch (const DeviceError& error) {
      return error.what();
    }
    return "taken";
  };
  EXPECT_THAT(refused("mas=1kg"),
              AllOf(HasSubstr("no option 'mas'"), HasSubstr("mass"), HasSubstr("backlash")));
  EXPECT_THAT(refused("mass=0kg"), HasSubstr("'mass' is '0kg'"));
  EXPECT_THAT(refused("mass=0.1kg,0.2kg"), HasSubstr("has 2 values, expected one or 1"));
  EXPECT_THAT(refused("delay=33ticks"), HasSubstr("from 0 to 32"));
  EXPECT_THAT(refused("sign=0.5"), HasSubstr("expected 1 or -1"));
  EXPECT_THAT(refused("axes=1.5"), HasSubstr("whole number"));
  EXPECT_THAT(refused("axes=4"), HasSubstr("expected 1 to 3"));
}

}  // namespace
}  // namespace kerf::drivers

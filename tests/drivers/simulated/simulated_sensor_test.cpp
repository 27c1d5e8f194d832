#include <cmath>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/drivers/device.h>
#include <kerf/drivers/simulated_sensor.h>
#include <kerf/drivers/uri.h>

namespace kerf::drivers {
namespace {

constexpr const char* exact = "sim:sensor?noise=0V&quantum=0V&hysteresis=0&drift=0V/s&swing=0K";

SimulatedSensor sensor_under(const std::string& uri, const Axes& load) {
  Surroundings surroundings;
  surroundings.tissue_of_axes = [load](const Axes&, const Axes&, double) { return load; };
  return SimulatedSensor(uri, SimulatedSensor::parse_options(parse_uri(uri)), std::move(surroundings));
}

TEST(SimulatedSensor, TellsItsLoadByItsOwnMatrix) {
  const Axes load{10, -5, 30, 0.5, 0.2, -1};
  SimulatedSensor sensor = sensor_under(exact, load);
  Sample sample;
  ASSERT_EQ(sensor.read(0.001, sample), Status::ok);
  const auto& truth = sensor.truth();
  const SimulatedSensor::Vector6 expected =
      truth.sensitivity * Eigen::Map<const SimulatedSensor::Vector6>(load.data()) + truth.bias;
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(sample.channels[i], expected(static_cast<Eigen::Index>(i)), 1e-12);
  EXPECT_TRUE(std::isnan(sample.force_measured[0]));
}

TEST(SimulatedSensor, EndsAtItsRange) {
  SimulatedSensor sensor = sensor_under(std::string(exact) + "&range=2V", {100, 0, 0, 0, 0, 0});
  Sample sample;
  ASSERT_EQ(sensor.read(0.001, sample), Status::ok);
  EXPECT_EQ(sample.channels[0], 2.0);
}

// Loaded and let go it stands off by r, having come from above.
TEST(SimulatedSensor, KeepsHalfItsHysteresisWhenTheLoadIsGone) {
  double force = 0.0;
  Surroundings surroundings;
  surroundings.tissue_of_axes = [&force](const Axes&, const Axes&, double) {
    return Axes{force, 0, 0, 0, 0, 0};
  };
  const std::string uri = "sim:sensor?noise=0V&quantum=0V&hysteresis=0.01&drift=0V/s&swing=0K&cross_talk=0";
  SimulatedSensor sensor(uri, SimulatedSensor::parse_options(parse_uri(uri)), std::move(surroundings));
  Sample sample;
  for (const double next : {0.0, 20.0, 0.0}) {
    force = next;
    ASSERT_EQ(sensor.read(0.001, sample), Status::ok);
  }
  EXPECT_NEAR(sample.channels[0] - sensor.truth().bias(0), sensor.truth().hysteresis(0), 1e-12);
}

TEST(SimulatedSensor, IsTheSameByTheSameSeed) {
  Sample one;
  Sample other;
  ASSERT_EQ(sensor_under("sim:sensor?seed=7", {}).read(0.5, one), Status::ok);
  ASSERT_EQ(sensor_under("sim:sensor?seed=7", {}).read(0.5, other), Status::ok);
  EXPECT_EQ(one.channels, other.channels);
}

TEST(SimulatedSensor, RefusesAnOptionThatItHasNot) {
  EXPECT_THROW((void)open_device("sim:sensor?sneed=7"), DeviceError);
}

}  // namespace
}  // namespace kerf::drivers

#include "import/spatial/spatial_axes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/import.h"
#include "support/program.h"

// spatial.csv was made by SciPy's Rotation: make_spatial.py says how.

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr double written = 1e-10;  ///< twelve digits of numbers below 10
const std::string position = "time=t_s,position=x_mm:z_mm,rx=rx[1],ry=ry[1],rz=rz[1]";
const std::string wrench = ",Fx=Fx[1],Fy=Fy[1],Fz=Fz[1],Tx=Tx[1],Ty=Ty[1],Tz=Tz[1]";

Imported imported_file(const std::string& map, const SpatialPlaces& places = {}) {
  return import_text(KERF_SOURCE_DIR "/tests/bench/data/import/spatial/spatial.csv",
                     {.map = parse_map(map), .places = places});
}

Imported imported_rows(const std::string& text, const std::string& map) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "data.csv", text);
  return import_text(folder / "data.csv", {.map = parse_map(map)});
}

std::string refusal_of(const std::string& text, const std::string& map) {
  try {
    (void)imported_rows(text, map);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

const std::vector<double>& channel(const schema::Recording& recording, const std::string& name) {
  return std::ranges::find(recording.channels, name, &schema::Channel::name)->values;
}

/// That an axis of a recording is the channel beside it.
void expect_axis(const schema::Recording& recording, const std::vector<double>& values, std::size_t axis,
                 const std::string& truth, double within) {
  const std::vector<double>& expected = channel(recording, truth);
  for (std::size_t row = 0; row < recording.rows(); ++row)
    ASSERT_NEAR(values[row * recording.dimensions() + axis], expected[row], within) << truth << ' ' << row;
}

TEST(SpatialAxes, AreTheSameRotationVectorFromEveryFormOfOrientation) {
  for (const std::string form :
       {"qx:qw[quaternion xyzw]", "pw:pz[quaternion wxyz]", "v1:v3[rotvec rad]", "d1:d3[rotvec deg]",
        "ea:ec[euler xyz deg]", "fa:fc[euler ZYX rad]", "ga:gc[euler ZXZ deg]", "ha:hc[euler yxz rad]",
        "m11:m33[matrix]", "m11:m33[matrix rows]", "n11:n33[matrix columns]", "n11:n33[matrix inverse]",
        "m11:m33[matrix columns inverse]", "5:8[quaternion xyzw]"}) {
    SCOPED_TRACE(form);
    const schema::Recording recording = imported_file(position + ",orientation=" + form).recording;
    ASSERT_EQ(recording.dimensions(), 6U);
    EXPECT_EQ(recording.axes[3].name, "rx");
    EXPECT_EQ(recording.axes[3].position_unit, "rad");
    EXPECT_EQ(recording.axes[5].force_unit, "N·m");
    for (std::size_t i = 0; i < 3; ++i)
      expect_axis(recording, recording.position, 3 + i, std::string("r") + "xyz"[i], written);
    EXPECT_GT(std::abs(recording.position[6 * 24 + 3]), 3.0) << "the turn goes on past half a turn";
    EXPECT_TRUE(recording.force_measured.empty());
  }
}

TEST(SpatialAxes, HoldWorldForcesAndTheTorquesThatDoThePowerOfTheWrench) {
  const std::string map = position + wrench + ",orientation=qx:qw[quaternion xyzw],wrench=";
  const auto sensor = imported_file(map + "sfx_N:stz_Nm[sensor]", {.point_m = {{0.01, -0.02, 0.03}}});
  const auto world = imported_file(map + "wfx_N:wtz_Nm[N N·m world]", {.point_m = {{0.1, 0.2, -0.3}}});
  for (const Imported* imported : {&sensor, &world}) {
    const schema::Recording& recording = imported->recording;
    for (std::size_t i = 0; i < 3; ++i) {
      expect_axis(recording, recording.force_measured, i, std::string("F") + "xyz"[i], 1e-9);
      expect_axis(recording, recording.force_measured, 3 + i, std::string("T") + "xyz"[i], 1e-9);
    }
    EXPECT_EQ(std::get<std::string>(recording.header.device_properties.at("torques")), "generalised");
  }
  EXPECT_EQ(std::get<std::string>(sensor.recording.header.device_properties.at("wrench_frame")), "sensor");
  EXPECT_THAT(sensor.recording.header.history, HasSubstr("torques about (0.01, -0.02, 0.03) m"));
}

TEST(SpatialAxes, CountPositionsFromTheOriginAndTorquesFromTheWorldsPointAllTheSame) {
  const std::string map =
      position + wrench + ",orientation=qx:qw[quaternion xyzw],wrench=wfx_N:wtz_Nm[world]";
  const auto recording =
      imported_file(map, {.origin_m = {1.0, 2.0, 3.0}, .point_m = {{0.1, 0.2, -0.3}}}).recording;
  EXPECT_NEAR(recording.position[0], -1.0, 1e-12);
  EXPECT_NEAR(recording.position[2], 0.02 - 3.0, 1e-12);
  expect_axis(recording, recording.force_measured, 4, "Ty", 1e-9);
}

TEST(SpatialAxes, TurnTheWrenchOfASensorThatIsMountedAtAnAngle) {
  // A quarter turn about z: what the sensor feels along its x acts along the tool's y.
  const std::string text =
      "t,x,y,z,qx,qy,qz,qw,a,b,c,d,e,f\n0,0,0,0,0,0,0,1,1,2,3,4,5,6\n1,0,0,0,0,0,0,1,1,2,3,4,5,6\n";
  const test::TemporaryFolder folder;
  test::write_text(folder / "data.csv", text);
  const auto run = [&](const std::string& mapped) {
    return test::run_kerf({"import", (folder / "data.csv").string(), "--map",
                           "time=1[s],position=2:4[m],orientation=5:8[quaternion xyzw]," + mapped,
                           "--sensor-rotation", "0,0,90", "-o", (folder / "r.h5").string(), "--force"});
  };
  ASSERT_EQ(run("wrench=9:14[counts/10 N counts/10 N·m sensor]").exit_status, 0);
  const schema::Recording recording = schema::read_recording(folder / "r.h5");
  const std::vector<double> expected{-0.2, 0.1, 0.3, -0.5, 0.4, 0.6};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(recording.force_measured[i], expected[i], 1e-15) << i;
  EXPECT_EQ(std::get<std::string>(recording.header.device_properties.at("wrench_frame")), "sensor");
  EXPECT_THAT(std::get<std::string>(recording.header.device_properties.at("sensor_rotation")),
              HasSubstr("(0, 0, 1.57079633) rad"));
  EXPECT_THAT(recording.header.history, HasSubstr("sensor turned by"));
  EXPECT_THAT(run("wrench=9:14[N N·m world]").errors,
              HasSubstr("in the frame of the sensor, and there is none"));
}

TEST(SpatialAxes, KeepNanAndSayNothingOfTorquesThatNobodyMeasured) {
  std::string rows;
  for (int i = 0; i < 10; ++i)
    rows += std::to_string(i) + (i == 4 ? ",1,2,3,nan,0,0,0,4,5,6\n" : ",1,2,3,0,0,1,0,4,5,6\n");
  const std::string map =
      "time=1[s],position=2:4[mm],orientation=5:8[quaternion xyzw],force=9:11[-1 N sensor]";
  const auto recording = imported_rows(rows, map).recording;
  EXPECT_TRUE(std::isnan(recording.position[6 * 4 + 3]));
  EXPECT_TRUE(std::isnan(recording.force_measured[6 * 4]));
  EXPECT_DOUBLE_EQ(recording.position[6 * 4], 1e-3);
  EXPECT_NEAR(recording.force_measured[6 * 5], 4.0, 1e-15) << "half a turn about z, and the sign";
  EXPECT_NEAR(recording.force_measured[6 * 5 + 2], -6.0, 1e-15);
  EXPECT_TRUE(std::isnan(recording.force_measured[6 * 5 + 3]));
}

TEST(SpatialAxes, MayBeThreeWithAForceInTheWorld) {
  const auto recording = imported_rows("0,1,2,3,4,5,6\n1,2,3,4,5,6,7\n2,3,4,5,6,7,8\n",
                                       "time=1[s],position=2:4[m],force=5:7[N world]")
                             .recording;
  ASSERT_EQ(recording.dimensions(), 3U);
  EXPECT_DOUBLE_EQ(recording.velocity[3], 1.0);
  EXPECT_DOUBLE_EQ(recording.force_measured[8], 8.0);
}

TEST(SpatialAxes, RefuseWhatIsNoRotationByItsLine) {
  const std::string quaternions = "t,x,y,z,a,b,c,d\n0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0.1,1\n2,0,0,0,0,0,0,1\n";
  const std::string map = "time=t[s],position=x:z[m],orientation=a:d[quaternion xyzw]";
  EXPECT_THAT(
      refusal_of(quaternions, map),
      HasSubstr(
          "data.csv:3: columns 5 to 8 are no quaternion of a rotation: their norm is 1.00499, expected 1 "
          "within 0.001; nan where there is none"));
  const std::string matrices = "0,0,0,0,1,0,0,0,1,0,0,0,1\n1,0,0,0,1,0,0,0,1,0,0,0,";
  const std::string matrix_map = "time=1[s],position=2:4[m],orientation=5:13[matrix]";
  EXPECT_THAT(refusal_of(matrices + "-1\n", matrix_map),
              HasSubstr("data.csv:2: columns 5 to 13 are a mirror"));
  EXPECT_THAT(refusal_of(matrices + "1.1\n", matrix_map), HasSubstr("R'R - 1 up to 0.21"));
  EXPECT_EQ(refusal_of(matrices + "1.0004\n", matrix_map), "accepted");
}

TEST(SpatialAxes, WarnNearAWholeTurnAndOfUnitsInDoubtByAxis) {
  std::string rows;
  for (int i = 0; i <= 63; ++i)
    rows += std::to_string(i) + "," + std::to_string(i) + ",0,0,0,0," + std::to_string(0.1 * i) + "\n";
  const auto warnings = imported_rows(rows, "time=1[s],position=2:4[m],orientation=5:7[rotvec rad]").warnings;
  EXPECT_THAT(warnings, Contains(HasSubstr("in 3 rows the rotation is within 0.2 rad of a whole turn")));
  EXPECT_THAT(warnings, Contains(HasSubstr("position.x goes over 63 m")));
}

TEST(SpatialAxes, AreResampledOneByOne) {
  ImportOptions options{
      .map = parse_map(position + wrench + ",orientation=qx:qw[quaternion xyzw],force=sfx_N:sfz_N[sensor]"),
      .resample_hz = 48.0};
  const auto recording =
      import_text(KERF_SOURCE_DIR "/tests/bench/data/import/spatial/spatial.csv", options).recording;
  ASSERT_EQ(recording.rows(), 49U);
  ASSERT_EQ(recording.position.size(), 6U * 49U);
  expect_axis(recording, recording.position, 5, "rz", 1e-9);
  expect_axis(recording, recording.force_measured, 1, "Fy", 1e-9);
  EXPECT_TRUE(std::isnan(recording.force_measured[5]));
}

}  // namespace
}  // namespace kerf::bench

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "import/import.h"
#include "prepare/prepare.h"
#include "support/measured_data.h"

// A robot peels a vegetable, with hand-made labels: 3 = the blade cuts, 18 strokes.

namespace kerf::bench {
namespace {

class Peeling : public testing::Test {
 protected:
  void SetUp() override {
    KERF_NEEDS_DATA("peeling/demo4.csv");
    const auto columns = import_text(
        test::measured_file("peeling/demo4.csv"),
        {.map = parse_map("time=t_s[s],position=z_m[m],x=x_m[m],y=y_m[m],z=z_m[m],qi=qi[1],qj=qj[1],qk=qk[1],"
                          "qw=qw[1],fx=fx_N[N],fy=fy_N[N],fz=fz_N[N],tx=tx_Nm[N·m],ty=ty_Nm[N·m],"
                          "tz=tz_Nm[N·m],label=label[1]")});
    recording_ = six_axes(columns.recording);
  }

  /// Pose and wrench as they stand in the file, which does not say the wrench's frame: an import in space
  /// asks.
  static schema::Recording six_axes(const schema::Recording& from) {
    const auto channel = [&](const char* name) -> const std::vector<double>& {
      return std::ranges::find(from.channels, name, &schema::Channel::name)->values;
    };
    schema::Recording recording;
    recording.header = from.header;
    recording.time = from.time;
    recording.tick = from.tick;
    for (const char* name : {"x", "y", "z"}) recording.axes.push_back({.name = name});
    for (const char* name : {"rx", "ry", "rz"}) {
      recording.axes.push_back({.name = name, .position_unit = "rad", .force_unit = "N·m"});
    }
    for (std::size_t row = 0; row < from.rows(); ++row) {
      const Eigen::AngleAxisd turn(
          Eigen::Quaterniond(channel("qw")[row], channel("qi")[row], channel("qj")[row], channel("qk")[row])
              .normalized());
      for (const char* name : {"x", "y", "z"}) recording.position.push_back(channel(name)[row]);
      for (const double r : turn.angle() * turn.axis()) recording.position.push_back(r);
      for (const char* name : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
        recording.force_measured.push_back(channel(name)[row]);
      }
    }
    recording.velocity.assign(recording.position.size(), 0.0);
    recording.channels = {{.name = "label", .unit = "1", .values = channel("label")}};
    return recording;
  }

  [[nodiscard]] ContactScore scored(PrepareOptions options) const {
    options.labels = Labels{.channel = "label", .value = 3.0};
    return *prepare(recording_, options).score;
  }

  schema::Recording recording_;
};

// The threshold lies near what the free blade's force varies by as it turns; it was chosen knowing this
// recording.
TEST_F(Peeling, StrokesAreFoundWhereTheBladeCuts) {
  PrepareOptions at_one_newton;
  at_one_newton.contact.least = 1.0;
  const ContactScore score = scored(at_one_newton);
  EXPECT_EQ(score.found, 18U);
  EXPECT_LE(score.false_ones, 2U);
  EXPECT_LT(score.begin.median_s, 0.2);
  EXPECT_GT(score.f1, 0.9);
}

TEST_F(Peeling, FreeMotionThatIsNamedSetsTheThreshold) {
  PrepareOptions named;
  named.contact.free = {{.begin_s = 0.0, .end_s = 10.5}};
  const ContactScore score = scored(named);
  EXPECT_EQ(score.found, 18U);
  EXPECT_LE(score.false_ones, 5U);
}

TEST_F(Peeling, DoesNotTellTheToolsWeightFromNothing) {
  // Twelve degrees of tilt while the arm moves: the standard error has to say so, whichever frame is meant.
  for (const bool base_frame : {false, true}) {
    PrepareOptions options{.weight = true, .weight_options = {.base_frame = base_frame}};
    options.contact.free = {{.begin_s = 0.0, .end_s = 10.5}};
    const Prepared prepared = prepare(recording_, options);
    EXPECT_LT(std::abs(prepared.weight->mass_kg), 3.0 * prepared.weight->mass_error_kg);
    ASSERT_EQ(prepared.warnings.size(), 1U);
    EXPECT_NE(prepared.warnings[0].find("not told from zero"), std::string::npos);
  }
}

TEST_F(Peeling, ComesInWithSixAxesAndTheSameWeight) {
  const schema::Recording imported =
      import_text(test::measured_file("peeling/demo4.csv"),
                  {.map = parse_map("time=t_s,position=x_m:z_m,orientation=qi:qw[quaternion xyzw],"
                                    "wrench=fx_N:tz_Nm[sensor]")})
          .recording;
  ASSERT_EQ(imported.position.size(), recording_.position.size());
  for (std::size_t at = 6; at < imported.position.size(); ++at)
    ASSERT_LT(std::abs(imported.position[at] - imported.position[at - 6]), 0.1) << "no jump at half a turn";
  PrepareOptions options{.weight = true};
  options.contact.free = {{.begin_s = 0.0, .end_s = 10.5}};
  const Weight by_hand = *prepare(recording_, options).weight;
  const Weight by_import = *prepare(imported, options).weight;
  EXPECT_NEAR(by_import.mass_kg, by_hand.mass_kg, 1e-9);
  EXPECT_NEAR(by_import.centre_m[2], by_hand.centre_m[2], 1e-9);
  EXPECT_EQ(by_import.rows, by_hand.rows);
}

}  // namespace
}  // namespace kerf::bench

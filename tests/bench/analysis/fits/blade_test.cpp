#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/models/rotation.h>

#include "fits/blade_recording.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::Contains;
using testing::HasSubstr;

const std::string shape = R"([fidelity]
thresholds = false
polygons = "-0.005 0 -0.03, 0.005 0 -0.03, 0.005 0 0, -0.005 0 0"
edge = "0.005 0 -0.03, 0.005 0 0"
)";
const std::string friction = R"(edge_damping = { value = 20, unit = "N·s/m²" }
normal_damping = { value = 20000, unit = "N·s/m³" }
tangential_damping = { value = 4000, unit = "N·s/m³" }
)";
const std::string hold = R"(edge_stiffness = { value = 500, unit = "N/m²" }
normal_stiffness = { value = 1000000, unit = "N/m³" }
tangential_stiffness = { value = 600000, unit = "N/m³" }
release_force = { value = 0.1, unit = "N" }
rupture_force = { value = 0.4, unit = "N" }
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

/// A simulated tool in a tissue that is a blade's law, and a law file that knows the shape but no number.
class KerfBlade : public testing::Test {
 protected:
  KerfBlade() {
    test::write_text(folder_ / "shape.law.toml",
                     "model = \"blade\"\n[parameters]\nedge_damping = { value = 1, unit = \"N·s/m²\" }\n"
                     "normal_damping = { value = 1, unit = \"N·s/m³\" }\n"
                     "tangential_damping = { value = 1, unit = \"N·s/m³\" }\n" +
                         shape);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  void record(const std::string& parameters, const std::string& fidelity, const std::string& seconds) const {
    test::write_text(folder_ / "scene.toml",
                     "name = \"a half-space\"\n[tissue]\nmodel = \"blade\"\n"
                     "[tissue.parameters]\n" +
                         parameters + replaced(fidelity, "[fid", "[tissue.fid"));
    const Outcome outcome = run_kerf({"record", "--device", "sim:pose6", "--virtual", "--seconds", seconds,
                                      "--scene", at("scene.toml"), "-o", at("cut.h5")});
    ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
  [[nodiscard]] Outcome blade(std::vector<std::string> more) const {
    more.insert(more.begin(), {"blade", at("cut.h5"), "--shape", at("shape.law.toml")});
    return run_kerf(more);
  }

  test::TemporaryFolder folder_;
};

void expect_within(const json& result, const std::string& name, double truth, double relative) {
  const json& parameter = result.at("parameters").at(name);
  EXPECT_NEAR(parameter.at("value").get<double>() / truth, 1.0, relative) << name;
  EXPECT_NEAR(parameter.at("value").get<double>(), truth, 5.0 * parameter.at("std_error").get<double>())
      << name;
}

TEST_F(KerfBlade, FindsTheFrictionOfASimulatedTissue) {
  record(friction, shape, "20");
  const Outcome outcome = blade({"--json", "-o", at("found.law.toml")});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  expect_within(result, "edge_damping", 20.0, 0.05);
  expect_within(result, "normal_damping", 2e4, 0.01);
  expect_within(result, "tangential_damping", 4e3, 0.03);
  EXPECT_NEAR(result.at("rmse").at("x").get<double>(), 0.02, 0.001) << "the sensor's noise";

  const LawFile law = read_law_file(at("found.law.toml"));
  EXPECT_EQ(law.law.values()[1], result.at("parameters").at("normal_damping").at("value").get<double>());
  EXPECT_EQ(law.std_errors.size(), 3U);
  EXPECT_EQ(law.fit.recording_uuid, result.at("recording").get<std::string>());
  EXPECT_EQ(law.fit.recording_sha256.size(), 64U);
  EXPECT_EQ(run_kerf({"check", at("found.law.toml"), "--device", "sim:pose6", "--virtual", "--seconds", "1"})
                .exit_status,
            0);
}

TEST_F(KerfBlade, FindsTheThresholdsOfATissueThatTears) {
  record(replaced(friction, "4000", "8000") + hold, replaced(shape, "thresholds = false", "form = \"paper\""),
         "30");
  const Outcome outcome = blade({"--thresholds", "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const json result = json::parse(outcome.output);
  expect_within(result, "normal_damping", 2e4, 0.03);
  expect_within(result, "tangential_damping", 8e3, 0.03);
  expect_within(result, "normal_stiffness", 1e6, 0.03);
  expect_within(result, "tangential_stiffness", 6e5, 0.05);
  expect_within(result, "rupture_force", 0.4, 0.03);
  expect_within(result, "release_force", 0.1, 0.06);
  EXPECT_GT(result.at("phases").at("ruptures").at("events").get<int>(), 10);
}

/// A recording as another lab would have it: quaternions, the wrench in the sensor's frame about a point of
/// the sensor, positions in mm.
std::string as_text(const schema::Recording& recording, const Eigen::Vector3d& point) {
  std::string text = "t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const Eigen::Vector3d at(&recording.position[6 * row]);
    const Eigen::Vector3d r(&recording.position[6 * row + 3]);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(r.norm(), r.norm() > 0.0 ? r.normalized() : r));
    const Eigen::Vector3d force = q.conjugate() * Eigen::Vector3d(&recording.force_measured[6 * row]);
    const Eigen::Vector3d torques(&recording.force_measured[6 * row + 3]);
    const Eigen::Vector3d moment = models::left_jacobian(r).transpose().inverse() * torques;
    const Eigen::Vector3d torque = q.conjugate() * moment - point.cross(force);
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", recording.time[row], 1e3 * at[0],
                        1e3 * at[1], 1e3 * at[2], q.w(), q.x(), q.y(), q.z(), force[0], force[1], force[2],
                        torque[0], torque[1], torque[2]);
  }
  return text;
}

TEST_F(KerfBlade, FindsTheSameLawInATextOfTheSameCut) {
  record(friction, shape, "6");
  const Outcome recorded = blade({"--json"});
  ASSERT_EQ(recorded.exit_status, 0) << recorded.errors;
  test::write_text(folder_ / "cut.csv", as_text(schema::read_recording(at("cut.h5")), {0.01, -0.02, 0.08}));
  const Outcome import =
      run_kerf({"import", at("cut.csv"), "--map",
                "time=t_s,position=x_mm:z_mm,orientation=qw:qz[quaternion wxyz],wrench=fx_N:tz_Nm[sensor]",
                "--point", "0.01,-0.02,0.08", "-o", at("cut.h5"), "--force"});
  ASSERT_EQ(import.exit_status, 0) << import.errors;
  const Outcome imported = blade({"--json"});
  ASSERT_EQ(imported.exit_status, 0) << imported.errors;
  const json expected = json::parse(recorded.output);
  const json found = json::parse(imported.output);
  EXPECT_EQ(found.at("rows_in_tissue"), expected.at("rows_in_tissue"));
  for (const auto& [name, parameter] : expected.at("parameters").items()) {
    const double value = parameter.at("value").get<double>();
    EXPECT_NEAR(found.at("parameters").at(name).at("value").get<double>() / value, 1.0, 1e-9) << name;
  }
  expect_within(found, "normal_damping", 2e4, 0.02);
}

TEST_F(KerfBlade, ReplacesNothingUnasked) {
  record(friction, shape, "3");
  test::write_text(folder_ / "mine.law.toml", "mine");
  const Outcome refused = blade({"-o", at("mine.law.toml")});
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("mine.law.toml exists; --force replaces it"));
  EXPECT_EQ(test::read_text(folder_ / "mine.law.toml"), "mine");
  EXPECT_EQ(blade({"-o", at("mine.law.toml"), "--force"}).exit_status, 0);
}

TEST_F(KerfBlade, RefusesInOneLine) {
  record(friction, shape, "3");
  const auto refusal = [&](std::vector<std::string> arguments) {
    const Outcome outcome = run_kerf(std::move(arguments));
    EXPECT_EQ(outcome.exit_status, 2);
    EXPECT_THAT(outcome.errors, testing::StartsWith("kerf: "));
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1);
    return outcome.errors;
  };
  const std::string cut = at("cut.h5");
  const std::string law = at("shape.law.toml");
  EXPECT_THAT(refusal({"blade", cut, "--shape", law, "--fidelity", "strips:0"}), HasSubstr("strips:N"));
  EXPECT_THAT(refusal({"blade", cut, "--shape", law, "--fidelity", "good"}), HasSubstr("'good'"));
  const std::string kelvin = std::string(KERF_SOURCE_DIR) + "/examples/kelvin.law.toml";
  EXPECT_THAT(refusal({"blade", cut, "--shape", kelvin}), HasSubstr("law 'kelvin' has no shape of a blade"));
  ASSERT_EQ(run_kerf({"record", "--virtual", "--seconds", "1", "-o", at("scissors.h5")}).exit_status, 0);
  EXPECT_THAT(refusal({"blade", at("scissors.h5"), "--shape", law}),
              HasSubstr("has no 'x' like that; it has theta [rad, N], x_s [m, N]"));
}

/// The tool rises and sinks and sways; its law gives the forces, and the velocity is one that nobody can use.
schema::Recording sway() {
  const models::Law law =
      models::Law::make("blade", std::vector{20.0, 2e4, 4e3},
                        {{"thresholds", false},
                         {"polygons", std::string("-0.005 0 -0.03, 0.005 0 -0.03, 0.005 0 0, -0.005 0 0")},
                         {"edge", std::string("0.005 0 -0.03, 0.005 0 0")}});
  models::Law::State state = law.initial_state();
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  for (const models::LawAxis& axis : law.axes()) {
    recording.axes.push_back(
        {.name = axis.name, .position_unit = axis.position_unit, .force_unit = axis.force_unit});
  }
  for (std::size_t i = 0; i < 3000; ++i) {
    const double time_s = 1e-3 * static_cast<double>(i);
    models::SpatialMotion motion;
    for (std::size_t axis = 0; axis < 6; ++axis) {
      const double rate = 3.0 + static_cast<double>(axis);
      const double reach = axis < 3 ? 0.01 : 0.2;
      motion.position[axis] = reach * std::sin(rate * time_s);
      motion.velocity[axis] = reach * rate * std::cos(rate * time_s);
    }
    const auto felt = law.step(state, motion, 1e-3);
    recording.time.push_back(time_s);
    recording.tick.push_back(i);
    recording.position.insert(recording.position.end(), motion.position.begin(), motion.position.end());
    recording.velocity.insert(recording.velocity.end(), 6, 0.0);
    recording.force_measured.insert(recording.force_measured.end(), felt.force.begin(), felt.force.end());
  }
  return recording;
}

fitting::BladeFitOptions options_of_shape() {
  return {.law_options = {{"polygons", std::string("-0.005 0 -0.03, 0.005 0 -0.03, 0.005 0 0, -0.005 0 0")},
                          {"edge", std::string("0.005 0 -0.03, 0.005 0 0")}}};
}

TEST(BladeRecording, IsFittedWithAVelocityOfItsOwn) {
  const BladeRecordingFit fit = fit_blade_recording(sway(), options_of_shape());
  EXPECT_NEAR(fit.fit.parameters[1].value / 2e4, 1.0, 5e-3);
  EXPECT_NEAR(fit.fit.parameters[2].value / 4e3, 1.0, 5e-3);
  EXPECT_EQ(fit.left_out, 0U);
}

TEST(BladeRecording, LeavesOutRowsThatAreNoNumbersAndAxesThatNobodyMeasured) {
  schema::Recording recording = sway();
  recording.position[6 * 1234 + 2] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < 3000; ++i) {
    recording.force_measured[6 * i + 5] = std::numeric_limits<double>::quiet_NaN();
  }
  const BladeRecordingFit fit = fit_blade_recording(recording, options_of_shape());
  EXPECT_EQ(fit.left_out, 1U);
  EXPECT_THAT(fit.warnings, Contains("no force along 'rz' was measured: the axis is left out"));
  EXPECT_NEAR(fit.fit.parameters[1].value / 2e4, 1.0, 5e-3);
}

TEST(BladeRecording, OfARenderedLawLeavesOutRowsWhoseForceWasAltered) {
  schema::Recording recording = sway();
  recording.force_commanded = std::move(recording.force_measured);
  recording.force_measured.clear();
  recording.flags.assign(recording.rows(), 0);
  for (std::size_t i = 0; i < 500; ++i) {
    recording.flags[i] = schema::flag_soft_start;
    for (std::size_t axis = 0; axis < 6; ++axis) recording.force_commanded[6 * i + axis] *= 0.5;
  }
  const BladeRecordingFit fit = fit_blade_recording(recording, options_of_shape());
  EXPECT_TRUE(fit.commanded);
  EXPECT_EQ(fit.left_out, 500U);
  EXPECT_NEAR(fit.fit.parameters[1].value / 2e4, 1.0, 5e-3);
}

}  // namespace
}  // namespace kerf::bench

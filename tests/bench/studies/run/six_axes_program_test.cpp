#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "bench/studies/rubbed.h"
#include "bench/studies/study_folder.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;

std::string parameters(double edge, double normal, double tangential) {
  return fmt::format(
      "edge_damping = {{ value = {}, unit = \"N·s/m²\" }}\nnormal_damping = {{ value = {}, unit = "
      "\"N·s/m³\" }}\ntangential_damping = {{ value = {}, unit = \"N·s/m³\" }}\n",
      edge, normal, tangential);
}
constexpr const char* polygons =
    "thresholds = false\npolygons = \"-0.005 0 -0.03, 0.005 0 -0.03, 0.005 0 0, -0.005 0 0\"\n"
    "edge = \"0.005 0 -0.03, 0.005 0 0\"\n";

/// A drawer of a punch along one axis and of a cut in six, simulated in a tissue that is a blade's law; the
/// cut is a text with a rotation vector and forces in the world.
class SixAxesInStudy : public test::StudyFolder {
 protected:
  SixAxesInStudy() {
    test::write_text(folder_ / "drawer/skin_s1.txt",
                     test::as_text(test::punch({.parallel_stiffness = 300.0, .seconds = 4.0})));
    test::write_text(folder_ / "shape.law.toml",
                     "model = \"blade\"\n[parameters]\n" + parameters(1, 1, 1) + "[fidelity]\n" + polygons);
    test::write_text(folder_ / "scene.toml",
                     "name = \"a half-space\"\n[tissue]\nmodel = \"blade\"\n[tissue.parameters]\n" +
                         parameters(20, 2e4, 4e3) + "[tissue.fidelity]\n" + polygons);
    const std::string cut = (folder_ / "cut.h5").string();
    const Outcome recorded = run_kerf({"record", "--device", "sim:pose6", "--virtual", "--seconds", "6",
                                       "--scene", (folder_ / "scene.toml").string(), "-o", cut});
    EXPECT_EQ(recorded.exit_status, 0) << recorded.errors;
    const schema::Recording rows = schema::read_recording(cut);
    std::string text = "t,x,y,z,rx,ry,rz,fx,fy,fz\n";
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      text += fmt::format("{}", rows.time[row]);
      for (std::size_t i = 0; i < 6; ++i)
        text += fmt::format(",{:.9g}", (i < 3 ? 1e3 : 1.0) * rows.position[6 * row + i]);
      for (std::size_t i = 0; i < 3; ++i) text += fmt::format(",{:.9g}", rows.force_measured[6 * row + i]);
      text += "\n";
    }
    test::write_text(folder_ / "drawer/liver_s2.csv", text);
    const Outcome looked =
        run_kerf({"study", "new", (folder_ / "drawer").string(), "--laws", "kelvin", "--map",
                  "time=t[s],position=x:z[mm],orientation=rx:rz[rotvec rad],force=fx:fz[N world]", "--map",
                  "time=1[s],position=2[mm],force=3[N]", "-o", study().string()});
    EXPECT_EQ(looked.exit_status, 0) << looked.errors;
  }
  [[nodiscard]] json cut() const {
    const json found = json::parse(test::read_text(study() / "study.json"));
    for (const json& one : found.at("recordings"))
      if (one.at("name") == "liver_s2") return one;
    return nullptr;
  }
};

TEST_F(SixAxesInStudy, SayWhatIsMissingForALaw) {
  const Outcome ran = run_it();
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  EXPECT_THAT(ran.output, HasSubstr("liver_s2: no blade is fitted: study.toml names no shape"));
  EXPECT_THAT(ran.output, HasSubstr("it has the axes x, y, z, rx, ry, rz, and the study's laws act along"));
  EXPECT_THAT(ran.output, HasSubstr("skin: kelvin serves"));  // the rest goes on
  EXPECT_EQ(cut().at("counts"), false);
  EXPECT_TRUE(cut().at("law").is_null());
  EXPECT_EQ(schema::read_recording(study() / "recordings/liver_s2/recording.h5").dimensions(), 6U);
  edit("\n[prepare]", "\nblade = \"../scene.toml\"\n[prepare]");
  const Outcome none = run_it();
  EXPECT_EQ(none.exit_status, 2);
  EXPECT_THAT(none.errors, HasSubstr("scene.toml"));
}

// The tissue that was simulated is found again: 20 N·s/m², 2e4 and 4e3 N·s/m³.
TEST_F(SixAxesInStudy, AreFittedByABladeWhoseShapeIsNamed) {
  edit("\n[prepare]", "\nblade = \"../shape.law.toml\"\n[prepare]");
  const Outcome ran = run_it();
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  EXPECT_THAT(ran.output, HasSubstr("liver_s2: a blade in six axes has edge_damping "));
  EXPECT_THAT(ran.output, HasSubstr("skin: kelvin serves"));
  const json blade = cut().at("blade");
  const std::array truth{20.0, 2e4, 4e3};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const json& parameter = blade.at("parameters").at(i);
    EXPECT_NEAR(parameter.at("value").get<double>(), truth[i], 5.0 * parameter.at("std_error").get<double>());
    EXPECT_NEAR(parameter.at("value").get<double>(), truth[i], 0.2 * truth[i]);
  }
  EXPECT_TRUE(fs::exists(study() / "recordings/liver_s2/fits/blade.law.toml"));
  EXPECT_THAT(test::read_text(study() / "tables/parameters.csv"), HasSubstr("liver_s2,blade,edge_damping,"));
  fs::remove_all(folder_ / "drawer");
  fs::remove(folder_ / "shape.law.toml");
  const Outcome again = run_kerf({"study", "verify", study().string(), "--rerun", "all"});
  EXPECT_EQ(again.exit_status, 0) << again.output << again.errors;
}

// The same cut as a tracker and a sensor on the tool write it: quaternions, and forces in the sensor's frame.
TEST_F(SixAxesInStudy, AreTakenByTheVerbFromATextOfQuaternionsAndSensorForces) {
  const schema::Recording rows = schema::read_recording(folder_ / "cut.h5");
  std::string text = "t,x,y,z,qx,qy,qz,qw,Fx,Fy,Fz\n";
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const auto pose = [&](std::size_t i) { return rows.position[6 * row + i]; };
    const std::array turn{pose(3), pose(4), pose(5)};
    const double angle = std::hypot(turn[0], turn[1], turn[2]);
    const double half = angle > 0.0 ? std::sin(angle / 2.0) / angle : 0.5;
    const std::array q{half * turn[0], half * turn[1], half * turn[2]};
    const double w = std::cos(angle / 2.0);
    const auto cross = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
      return std::array{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    // Into the sensor's frame: f' = f + 2 (w f x q + (f x q) x q), of the inverse quaternion.
    const std::array f{rows.force_measured[6 * row], rows.force_measured[6 * row + 1],
                       rows.force_measured[6 * row + 2]};
    const auto once = cross(f, q);
    const auto twice = cross(once, q);
    text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", rows.time[row], 1e3 * pose(0),
                        1e3 * pose(1), 1e3 * pose(2), q[0], q[1], q[2], w);
    for (std::size_t i = 0; i < 3; ++i) text += fmt::format(",{:.9g}", f[i] + 2.0 * (w * once[i] + twice[i]));
    text += "\n";
  }
  test::write_text(folder_ / "cut.csv", text);
  const Outcome fitted = run_kerf(
      {"blade", (folder_ / "cut.csv").string(), "--map",
       "time=t[s],position=x:z[mm],orientation=qx:qw[quaternion xyzw],force=Fx:Fz[N sensor]", "--shape",
       (folder_ / "shape.law.toml").string(), "-o", (folder_ / "found.law.toml").string(), "--json"});
  ASSERT_EQ(fitted.exit_status, 0) << fitted.errors;
  const json parameters = json::parse(fitted.output).at("parameters");
  const std::array<std::pair<const char*, double>, 3> truths{
      {{"edge_damping", 20.0}, {"normal_damping", 2e4}, {"tangential_damping", 4e3}}};
  for (const auto& [name, truth] : truths) {
    const json& interval = parameters.at(name).at("interval");
    EXPECT_LT(interval.at(0).get<double>(), truth) << name;
    EXPECT_GT(interval.at(1).get<double>(), truth) << name;
  }
  EXPECT_EQ(run_kerf({"check", (folder_ / "found.law.toml").string(), "--device", "sim:pose6", "--virtual",
                      "--seconds", "1", "--scene", (folder_ / "scene.toml").string()})
                .exit_status,
            0)
      << "and the law that comes out runs in a loop";
}

TEST_F(SixAxesInStudy, AreFittedAlongTheAxisThatIsNamed) {
  edit("specimen = \"s2\"", "specimen = \"s2\"\naxis = \"z\"");
  ASSERT_EQ(run_it().exit_status, 0);
  EXPECT_EQ(json::parse(test::read_text(study() / "recordings/liver_s2/result.json")).at("axis"), "z");
  EXPECT_EQ(cut().at("law"), "kelvin");
  edit("axis = \"z\"", "axis = \"w\"");
  const Outcome ran = run_it();
  EXPECT_EQ(ran.exit_status, 1);
  EXPECT_THAT(ran.errors, HasSubstr("liver_s2.csv: the recording has no axis 'w'"));
}

}  // namespace
}  // namespace kerf::bench

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

constexpr double shift_s = 0.5;  // the forces' clock begins at its first row, half a second later
constexpr double skew = 2e-4;

/// A drawer of two livers, one of them in two files with a clock each: t = shift + (1 + skew) t_other.
class JoinInStudy : public test::StudyFolder {
 protected:
  JoinInStudy() {
    test::write_text(drawer() / "liver_slow_s2.txt",
                     test::as_text(test::punch({.parallel_stiffness = 320.0, .seconds = 6.0, .seed = 2})));
    const schema::Recording both = test::punch({.parallel_stiffness = 300.0, .seconds = 6.0});
    std::string motion = "Time [s]\tPosition [mm]\n";
    std::string forces = "Clock [s]\tWire [mm]\tForce [N]\n";
    for (std::size_t i = 0; i < both.rows(); i += 2)
      motion += fmt::format("{:.6f}\t{:.6f}\n", both.time[i], 1e3 * both.position[i]);
    for (std::size_t i = 500; i < both.rows(); ++i)
      forces += fmt::format("{:.7f}\t{:.6f}\t{:.6f}\n", 12.0 + (both.time[i] - shift_s) / (1.0 + skew),
                            3.0 + 2e3 * both.position[i], both.force_measured[i]);
    test::write_text(drawer() / "liver_slow_s1_position.txt", motion);
    test::write_text(drawer() / "liver_slow_s1_force.txt", forces);
  }
};

TEST_F(JoinInStudy, IsMadeOfTwoFilesOnceAPersonSaysSo) {
  const Outcome looked =
      run_kerf({"study", "new", drawer().string(), "--laws", "kelvin", "-o", study().string()});
  ASSERT_EQ(looked.exit_status, 0) << looked.errors;
  EXPECT_THAT(looked.output, HasSubstr("one recording by two clocks with liver_slow_s1_force.txt?"));
  const Outcome waits = run_it();
  EXPECT_EQ(waits.exit_status, 1);
  EXPECT_THAT(waits.errors,
              HasSubstr("liver_slow_s1_position.txt: by its name liver_slow_s1_force.txt is of the "
                        "same recording"));
  EXPECT_THAT(waits.output, HasSubstr("liver, slow: kelvin serves"));  // the rest goes on
  edit("join_suggested = ", "join = ");
  const Outcome ran = run_it();
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  const json found = json::parse(test::read_text(study() / "study.json"));
  const json& one = found.at("recordings").at(0);
  ASSERT_EQ(one.at("name"), "liver_slow_s1_position");
  EXPECT_EQ(one.at("tissue"), "liver");
  const json& joined = one.at("joined");
  EXPECT_NEAR(joined.at("shift_s").get<double>(), shift_s,
              5.0 * joined.at("shift_std_error_s").get<double>() + 1e-4);
  EXPECT_NEAR(joined.at("skew").get<double>(), skew, 5.0 * joined.at("skew_std_error").get<double>() + 2e-5);
  EXPECT_NEAR(joined.at("rows_left_out").get<double>(), 250.0, 1.0);  // half a second
  const std::string law = test::read_text(study() / "recordings/liver_slow_s1_position/fits/kelvin.law.toml");
  const auto stiffness = law.find("parallel_stiffness = { value = ");
  ASSERT_NE(stiffness, std::string::npos);
  EXPECT_NEAR(std::stod(law.substr(stiffness + 31)), 300.0, 3.0);
  EXPECT_TRUE(fs::exists(study() / "inputs/liver_slow_s1_force.txt"));
  fs::remove_all(drawer());
  const Outcome again = run_kerf({"study", "verify", study().string(), "--rerun", "all"});
  EXPECT_EQ(again.exit_status, 0) << again.output << again.errors;
}

TEST_F(JoinInStudy, OfWhatHasNothingInCommonCostsOneLine) {
  ASSERT_EQ(
      run_kerf({"study", "new", drawer().string(), "--laws", "kelvin", "-o", study().string()}).exit_status,
      0);
  edit("join_suggested = ", "join = ");
  edit("join_on = \"position\"", "join_on = \"pressure\"");
  const Outcome ran = run_it();
  EXPECT_EQ(ran.exit_status, 1);
  EXPECT_THAT(ran.errors, HasSubstr("liver_slow_s1_position.txt: "));
  EXPECT_THAT(ran.errors, HasSubstr("pressure"));
  EXPECT_THAT(ran.output, HasSubstr("liver, slow: kelvin serves"));
}

/// A drawer of two rigs that wrote a motion and its forces by a clock each, and in both files a pulse that
/// rises at the same moments: five volts of the motion's, ten of the forces'.
class MarkersInStudy : public JoinInStudy {
 protected:
  MarkersInStudy() {
    const schema::Recording both = test::punch({.parallel_stiffness = 300.0, .seconds = 6.0});
    const auto pulses = [](double time_s) {
      constexpr std::array begins{0.8, 1.7, 3.9, 5.2};
      return std::ranges::any_of(begins, [&](double at) { return time_s >= at && time_s < at + 0.1; });
    };
    std::string motion = "Time [s]\tPosition [mm]\tSync [V]\n";
    std::string forces = "Clock [s]\tTrigger [V]\tForce [N]\n";
    for (std::size_t i = 0; i < both.rows(); i += 2)
      motion += fmt::format("{:.6f}\t{:.6f}\t{}\n", both.time[i], 1e3 * both.position[i],
                            pulses(both.time[i]) ? 5.0 : 0.1);
    for (std::size_t i = 500; i < both.rows(); ++i)
      forces += fmt::format("{:.7f}\t{}\t{:.6f}\n", 12.0 + (both.time[i] - shift_s) / (1.0 + skew),
                            pulses(both.time[i]) ? 10.0 : 0.0, both.force_measured[i]);
    test::write_text(drawer() / "liver_slow_s1_position.txt", motion);
    test::write_text(drawer() / "liver_slow_s1_force.txt", forces);
    const Outcome looked =
        run_kerf({"study", "new", drawer().string(), "--laws", "kelvin", "-o", study().string()});
    EXPECT_EQ(looked.exit_status, 0) << looked.errors;
    drop_suggestion();
    edit("path = \"liver_slow_s1_position.txt\"\n",
         "path = \"liver_slow_s1_position.txt\"\nmap = \"time=1[s],position=2[mm],sync=3[V]\"\n"
         "join = \"liver_slow_s1_force.txt\"\n");
  }
  /// What names and headings suggest for the motion's file.
  void drop_suggestion() const {
    std::string text = test::read_text(study() / "study.toml");
    const auto entry = text.find("path = \"liver_slow_s1_position.txt\"");
    for (const char* key : {"\nmap = ", "\njoin_suggested = ", "\njoin_map = ", "\njoin_on = "})
      if (const auto at = text.find(key, entry); at < text.find("[[file]]", entry))
        text.erase(at, text.find('\n', at + 1) - at);
    test::write_text(study() / "study.toml", text);
  }
  void mark(const std::string& marker) const {
    edit("join = \"liver_slow_s1_force.txt\"\n",
         "join = \"liver_slow_s1_force.txt\"\njoin_map = \"time=1[s],trigger=2[V],force=3[N]\"\n"
         "join_marker = \"" +
             marker + "\"\n");
  }
};

TEST_F(MarkersInStudy, BringTwoClocksTogether) {
  mark("sync>2.5,trigger>5");
  const Outcome ran = run_it();
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  const json found = json::parse(test::read_text(study() / "study.json"));
  const json& joined = found.at("recordings").at(0).at("joined");
  EXPECT_EQ(joined.at("markers"), 4);
  EXPECT_EQ(joined.at("on"), "sync");
  EXPECT_TRUE(joined.at("correlation").is_null());
  EXPECT_NEAR(joined.at("shift_s").get<double>(), shift_s, 2e-3) << "to within a step of each clock";
  EXPECT_NEAR(joined.at("skew").get<double>(), skew, 5.0 * joined.at("skew_std_error").get<double>());
  const std::string law = test::read_text(study() / "recordings/liver_slow_s1_position/fits/kelvin.law.toml");
  const auto stiffness = law.find("parallel_stiffness = { value = ");
  ASSERT_NE(stiffness, std::string::npos);
  EXPECT_NEAR(std::stod(law.substr(stiffness + 31)), 300.0, 5.0);
  // Another marker is another recording.
  edit("trigger>5", "trigger>50");
  const Outcome never = run_it();
  EXPECT_EQ(never.exit_status, 1);
  EXPECT_THAT(never.errors, testing::AllOf(HasSubstr("liver_slow_s1_position.txt: "),
                                           HasSubstr("join_marker: 'trigger' never rises through 50")));
  EXPECT_THAT(never.output, HasSubstr("liver, slow: kelvin serves"));  // the rest goes on
}

}  // namespace
}  // namespace kerf::bench

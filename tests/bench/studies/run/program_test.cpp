#include "support/program.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <fcntl.h>
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

#include "bench/studies/study_folder.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;

/// A drawer of two tissues, of each three specimens, with one file that is none.
class StudyProgram : public test::StudyFolder {
 protected:
  StudyProgram() {
    for (unsigned specimen = 1; specimen <= 3; ++specimen) {
      write_punch(fmt::format("liver_s{}.txt", specimen), 200.0 + 10.0 * specimen, specimen);
      write_punch(fmt::format("skin_s{}.txt", specimen + 3), 400.0 + 10.0 * specimen, specimen + 3);
    }
    test::write_text(drawer() / "notes.md", "# What was cut\n");
  }

  void write_punch(const std::string& name, double stiffness, unsigned seed,
                   double force_factor = 1.0) const {
    const schema::Recording recording =
        test::punch({.parallel_stiffness = stiffness, .seconds = 3.0, .seed = seed});
    std::ostringstream text;
    text << "Time [s]\tPosition [mm]\tForce [N]\n";
    for (std::size_t i = 0; i < recording.rows(); i += 2)
      text << fmt::format("{:.3f}\t{:.6f}\t{:.6f}\n", recording.time[i], 1e3 * recording.position[i],
                          force_factor * recording.force_measured[i]);
    test::write_text(drawer() / name, text.str());
  }
  [[nodiscard]] fs::file_time_type made(const std::string& name) const {
    return fs::last_write_time(study() / "recordings" / name / "result.json");
  }
};

// The tissues are Kelvin elements whose parallel springs are known.
TEST_F(StudyProgram, FindsTheTissuesThatTheDrawerWasMadeOf) {
  const Outcome looked = make();
  ASSERT_EQ(looked.exit_status, 0) << looked.errors;
  EXPECT_THAT(looked.output, HasSubstr("6 of 7 files take part"));
  const Outcome ran = run_it();
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  EXPECT_THAT(ran.output,
              HasSubstr("liver: kelvin serves, with 3 parameters, in each of 3 recordings of 3 specimens"));
  const json results = found();
  ASSERT_EQ(results.at("groups").size(), 2U);
  for (const json& quantity : results.at("groups")[0].at("quantities")) {
    if (quantity.at("name") != "kelvin.parallel_stiffness") continue;
    const json& estimate = quantity.at("estimate");
    EXPECT_NEAR(std::exp(estimate.at("mean").get<double>()), std::cbrt(210.0 * 220.0 * 230.0), 2.0);
    EXPECT_EQ(estimate.at("specimens"), 3);
  }
  for (const json& law : results.at("groups")[0].at("laws"))
    EXPECT_LT(law.at("on_others_jnd").at("mean").get<double>(), 1.0);
  for (const char* file : {"report.html", "ro-crate-metadata.json", "tables/groups.csv",
                           "inputs/liver_s1.txt", "recordings/skin_s4/fits/kelvin.law.toml"})
    EXPECT_TRUE(fs::exists(study() / file)) << file;
}

TEST_F(StudyProgram, ComputesOnlyWhatChanged) {
  ASSERT_EQ(make().exit_status, 0);
  ASSERT_EQ(run_it().exit_status, 0);
  const auto liver = made("liver_s1");
  const auto skin = made("skin_s4");
  const std::string before = test::read_text(study() / "study.json");
  ASSERT_EQ(run_it().exit_status, 0);
  EXPECT_EQ(made("liver_s1"), liver);
  EXPECT_EQ(test::read_text(study() / "study.json"), before);
  // Of one file the map: it is made anew, and no other.
  std::string text = test::read_text(study() / "study.toml");
  const auto at = text.find("map = ", text.find("path = \"liver_s1.txt\""));
  text.replace(at, text.find('\n', at) - at, "map = \"time=1[s],position=2[mm],force=3[gf]\"");
  test::write_text(study() / "study.toml", text);
  ASSERT_EQ(run_it().exit_status, 0);
  EXPECT_NE(made("liver_s1"), liver);
  EXPECT_EQ(made("skin_s4"), skin);
}

// The import file of one layout changes: what it describes is made anew, and nothing else. It goes with the
// study, which is verified without the drawer and without the file.
TEST_F(StudyProgram, TakesImportFilesForItsLayouts) {
  for (const char* other : {"liver_s2.txt", "liver_s3.txt", "skin_s5.txt", "skin_s6.txt"})
    fs::remove(drawer() / other);
  const fs::path import = folder_ / "punch.import.toml";
  test::write_text(import,
                   "map = [\"time=1[s]\", \"position=2[mm]\", \"force=3[N]\"]\nvelocity_window = 0.02\n");
  ASSERT_EQ(run_kerf({"study", "new", drawer().string(), "--laws", "kelvin", "--map", import.string(), "-o",
                      study().string()})
                .exit_status,
            0);
  edit("map = \"../punch.import.toml\"", "map = \"time=1[s],position=2[mm],force=3[N]\"");
  edit("\n[[file]]", "\n[[layout]]\nfiles = \"liver*\"\nmap = \"../punch.import.toml\"\n\n[[file]]");
  const Outcome ran = run_it();
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  const auto liver = made("liver_s1");
  const auto skin = made("skin_s4");
  test::write_text(import, "map = \"time=1[s],position=2[mm],force=3[N]\"\nvelocity_window = 0.05\n");
  ASSERT_EQ(run_it().exit_status, 0);
  EXPECT_NE(made("liver_s1"), liver);
  EXPECT_EQ(made("skin_s4"), skin);
  EXPECT_EQ(test::read_text(study() / "imports/punch.import.toml"), test::read_text(import));
  EXPECT_THAT(test::read_text(study() / "ro-crate-metadata.json"), HasSubstr("imports/punch.import.toml"));
  fs::remove(import);
  fs::remove_all(drawer());
  const Outcome verified = run_kerf({"study", "verify", study().string(), "--rerun", "liver_s1,skin_s4"});
  EXPECT_EQ(verified.exit_status, 0) << verified.output << verified.errors;
  test::write_text(import, "map = \"time=1[s],position=2[mm],force=3[N]\"\nvelocity_windows = 0.05\n");
  const Outcome bad = run_it();
  EXPECT_EQ(bad.exit_status, 2);
  EXPECT_THAT(bad.errors, HasSubstr("punch.import.toml:2: "));
}

TEST_F(StudyProgram, DoesNotDependOnTheNumberOfJobs) {
  ASSERT_EQ(make().exit_status, 0);
  ASSERT_EQ(run_it({"-j", "1"}).exit_status, 0);
  const std::string one = test::read_text(study() / "study.json");
  fs::remove_all(study() / "recordings");
  fs::remove_all(study() / "held_out");
  ASSERT_EQ(run_it({"-j", "4"}).exit_status, 0);
  EXPECT_EQ(test::read_text(study() / "study.json"), one);
}

TEST_F(StudyProgram, GoesOnAfterAFileThatIsNone) {
  ASSERT_EQ(make().exit_status, 0);
  test::write_text(drawer() / "liver_s2.txt", "gone\n");
  const Outcome ran = run_it();
  EXPECT_EQ(ran.exit_status, 1);
  EXPECT_THAT(ran.errors, HasSubstr("liver_s2.txt: it is no longer the file"));
  EXPECT_THAT(ran.output, HasSubstr("could not be used: 1"));
  EXPECT_EQ(found().at("groups")[0].at("recordings").size(), 2U);
}

// What a drawer holds besides: each costs a line with its reason, and where a person takes it in all the same
// one line of the run.
TEST_F(StudyProgram, GoesOnAmongRubbish) {
  fs::remove(drawer() / "liver_s3.txt");
  fs::remove(drawer() / "skin_s6.txt");
  fs::create_directories(drawer() / "again");
  write_punch("again/liver_s1.txt", 215.0, 11);  // a name that is there already
  test::write_text(drawer() / "log.csv", "");
  fs::resize_file(drawer() / "log.csv", std::uintmax_t{2} << 30U);
  fs::create_directory_symlink(drawer(), drawer() / "again/loop");
  test::write_text(drawer() / "empty.txt", "");
  test::write_text(drawer() / "picture.txt", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 17));
  test::write_text(drawer() / "mixed.txt", test::read_text(drawer() / "liver_s1.txt").substr(0, 3000) +
                                               std::string("\x00\xff\xfe\x01 what is this\n", 18));
  const Outcome looked = make();
  ASSERT_EQ(looked.exit_status, 0) << looked.errors;
  for (const char* line : {"log.csv", "loop", "empty.txt", "picture.txt", "mixed.txt", "notes.md"})
    EXPECT_THAT(looked.output, testing::ContainsRegex(std::string(line) + " +takes no part: [^\n]+\n"))
        << line;
  edit("ignored = \"2.1 GB", "numbers = \"2.1 GB");
  edit("ignored = \"it is empty", "numbers = \"it is empty");
  edit("ignored = \"a link to a folder", "numbers = \"a link to a folder");
  const std::string text = test::read_text(study() / "study.toml");
  const auto picture = text.find("ignored", text.find("path = \"picture.txt\""));
  test::write_text(study() / "study.toml", text.substr(0, picture) + "numbers" + text.substr(picture + 7));
  edit("map = \"\"", "map = \"time=1[s],position=2[mm],force=3[N]\"");
  const Outcome ran = run_it();
  EXPECT_EQ(ran.exit_status, 1);
  for (const char* line : {"log.csv: 2.1 GB", "again/loop: ", "empty.txt: ", "picture.txt: "})
    EXPECT_THAT(ran.errors, HasSubstr(line));
  EXPECT_EQ(std::ranges::count(ran.errors, '\n'), 4) << ran.errors;
  std::size_t counted = 0;
  const json results = found();
  for (const json& group : results.at("groups")) counted += group.at("recordings").size();
  EXPECT_EQ(counted, 5U) << ran.output;
  EXPECT_TRUE(fs::exists(study() / "recordings/liver_s1-2/recording.h5"));
  EXPECT_FALSE(fs::exists(study() / "inputs/log.csv"));
}

TEST_F(StudyProgram, LeavesOutAFileInAnotherUnit) {
  write_punch("liver_s7.txt", 220.0, 7, 101.97);  // gf under a heading of N
  write_punch("liver_s8.txt", 220.0, 8);
  ASSERT_EQ(make().exit_status, 0);
  const Outcome ran = run_it();
  ASSERT_EQ(ran.exit_status, 0) << ran.errors;
  EXPECT_THAT(ran.output, testing::AllOf(HasSubstr("liver_s7.txt: its peak force is"),
                                         HasSubstr("gf taken for N"), HasSubstr("it is left out")));
  EXPECT_EQ(found().at("groups")[0].at("recordings").size(), 4U);
}

TEST_F(StudyProgram, NamesAFileWhoseClockStartsAnew) {
  const std::string text = test::read_text(drawer() / "liver_s1.txt");
  test::write_text(drawer() / "liver_s9.txt", text + text.substr(text.find('\n') + 1));
  ASSERT_EQ(make().exit_status, 0);
  const Outcome ran = run_it();
  EXPECT_EQ(ran.exit_status, 1);
  EXPECT_THAT(ran.errors, testing::AllOf(HasSubstr("liver_s9.txt: line 1502: "), HasSubstr("anew")));
  edit("specimen = \"s9\"", "specimen = \"s9\"\nstretch = 2");
  EXPECT_EQ(run_it().exit_status, 0);
}

TEST_F(StudyProgram, IsVerifiedByItsHashesAndMadeAgain) {
  ASSERT_EQ(make().exit_status, 0);
  ASSERT_EQ(run_it().exit_status, 0);
  fs::remove_all(drawer());  // it was handed on
  const Outcome good = run_kerf({"study", "verify", study().string(), "--rerun", "liver_s1,skin_s5"});
  EXPECT_EQ(good.exit_status, 0) << good.output << good.errors;
  EXPECT_THAT(good.output, HasSubstr("2 of 2 recordings came out the same, bit for bit"));
  std::fstream input(study() / "inputs/liver_s1.txt", std::ios::in | std::ios::out);
  input.seekp(200);
  input.put('9');
  input.close();
  fs::remove(study() / "tables/groups.csv");
  const Outcome bad = run_kerf({"study", "verify", study().string(), "--rerun", "all"});
  EXPECT_EQ(bad.exit_status, 1);
  EXPECT_THAT(bad.output,
              testing::AllOf(HasSubstr("inputs/liver_s1.txt: it is not what it was"),
                             HasSubstr("tables/groups.csv: it is missing"), HasSubstr("5 of 6 recordings")));
}

TEST_F(StudyProgram, RefusesWhatCannotBeRun) {
  const std::string inside = (drawer() / "S").string();
  EXPECT_THAT(run_kerf({"study", "new", drawer().string(), "-o", inside}).errors,
              HasSubstr("lies in the drawer"));
  for (unsigned specimen = 1; specimen <= 6; ++specimen) {  // no heading says what the columns are
    const fs::path file = drawer() / fmt::format("{}_s{}.txt", specimen <= 3 ? "liver" : "skin", specimen);
    const std::string text = test::read_text(file);
    test::write_text(file, text.substr(text.find('\n') + 1));
  }
  ASSERT_EQ(make().exit_status, 0);
  const Outcome ran = run_it();
  EXPECT_EQ(ran.exit_status, 2);
  EXPECT_THAT(ran.errors, testing::AllOf(HasSubstr("columns of 6 files are unknown"), HasSubstr("'map'")));
  EXPECT_FALSE(fs::exists(study() / "report.html"));
}

TEST_F(StudyProgram, IsRunByOneProcessAtATime) {
  ASSERT_EQ(make().exit_status, 0);
  const int held = ::open((study() / "study.toml").c_str(), O_RDONLY);
  ASSERT_EQ(::flock(held, LOCK_EX), 0);
  const Outcome ran = run_it();
  ::close(held);
  EXPECT_EQ(ran.exit_status, 2);
  EXPECT_THAT(ran.errors, HasSubstr("another process runs this study"));
}

TEST_F(StudyProgram, WritesItsReportAgainWithoutComputing) {
  ASSERT_EQ(make().exit_status, 0);
  ASSERT_EQ(run_it().exit_status, 0);
  edit("tissue = \"skin\"", "tissue = \"liver\"");
  const auto skin = made("skin_s4");
  const Outcome report = run_kerf({"study", "report", (study() / "study.toml").string()});
  ASSERT_EQ(report.exit_status, 0) << report.errors;
  EXPECT_EQ(made("skin_s4"), skin);
  EXPECT_EQ(found().at("groups")[0].at("recordings").size(), 4U);
}

}  // namespace
}  // namespace kerf::bench

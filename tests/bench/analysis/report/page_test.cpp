#include <filesystem>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

// The page as a reader gets it, made by the program from a simulated cut.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;
using testing::Not;

class ReportProgram : public testing::Test {
 protected:
  void record(const std::string& name) {
    file_ = (folder_ / name).string();
    ASSERT_EQ(run_kerf({"record", "--virtual", "--seconds", "8", "-o", file_}).exit_status, 0);
  }
  Outcome report(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"report", file_, "-o", page()});
    return run_kerf(more);
  }
  [[nodiscard]] std::string page() const { return (folder_ / "report.html").string(); }
  [[nodiscard]] std::string fits() const { return (folder_ / "fits").string(); }
  [[nodiscard]] std::string check() const { return (folder_ / "check.json").string(); }

  test::TemporaryFolder folder_;
  std::string file_;
};

TEST_F(ReportProgram, ShowsEverythingAndNeedsNothingElse) {
  record("cut & <b>run.h5");
  ASSERT_EQ(run_kerf({"segment", file_}).exit_status, 0);
  ASSERT_EQ(run_kerf({"fit", file_, "-o", fits()}).exit_status, 0);
  ASSERT_LE(run_kerf({"check", fits() + "/kelvin.law.toml", "--seconds", "0.5", "-o", check()}).exit_status,
            1);
  const Outcome outcome = report({"--fits", fits(), "--check", check()});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;

  const std::string html = test::read_text(page());
  for (const auto* part : {"What was recorded", "Choice: kelvin", "Closed loop", "Force against position",
                           "Residuals", "parallel_stiffness", "95 % interval", "straight line",
                           "Wake latency and cycle time", "cut &amp; &lt;b&gt;run"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
  EXPECT_THAT(html, Not(HasSubstr("<b>run"))) << "a file's name is text";
  EXPECT_FALSE(std::regex_search(html, std::regex(R"((src|href)\s*=\s*["'](?!#))"))) << "nothing is loaded";
  EXPECT_FALSE(std::regex_search(html, std::regex(R"(@import|url\(\s*["']?http)")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST_F(ReportProgram, ShowsAFitFromEverySide) {
  record("cut.h5");
  ASSERT_EQ(run_kerf({"segment", file_}).exit_status, 0);
  ASSERT_EQ(
      run_kerf({"fit", file_, "--models", "kelvin,exponential", "--folds", "2", "--profile", "-o", fits()})
          .exit_status,
      0);
  const Outcome outcome = report({"--fits", fits()});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const std::string html = test::read_text(page());
  for (const auto* part :
       {"Root mean square error of each law", "what a person feels (JND)", "Residual over time",
        "residual [N]", "Residual against penetration", "penetration from contact [deg]",
        "Residual against velocity", "velocity into the tissue [deg/s]", "Autocorrelation", "lag [s]",
        "Distribution", "Correlation of the estimates", "Profile of damping", "damping [N·s/rad]"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
}

/// The class and the first words of each answer of a page.
constexpr auto partly = "<p class=\"answer partly\"><strong>";

TEST_F(ReportProgram, HasNoGreenBesideAChoiceThatIsNotWithinTheJnd) {
  record("cut.h5");
  const auto fit = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"fit", file_, "--models", "kelvin", "-o", fits(), "--force"});
    ASSERT_EQ(run_kerf(more).exit_status, 0);
    ASSERT_EQ(report({"--fits", fits(), "--force"}).exit_status, 0);
  };
  fit({"--weber", "0", "--threshold", "0.001"});
  EXPECT_THAT(test::read_text(page()),
              HasSubstr(partly + std::string("Choice: kelvin</strong>: no law stays")));
  EXPECT_THAT(test::read_text(fits() + "/fit.json"), HasSubstr("\"within_jnd\": false"));
  fit({"--no-folds"});
  EXPECT_THAT(test::read_text(page()),
              HasSubstr(partly + std::string("Choice: kelvin</strong>: kelvin has the")));
  EXPECT_THAT(test::read_text(fits() + "/fit.json"), HasSubstr("\"within_jnd\": null"));
  fit({});
  EXPECT_THAT(test::read_text(page()), HasSubstr("<p class=\"answer\"><strong>Choice: kelvin"));
  EXPECT_THAT(test::read_text(fits() + "/fit.json"), HasSubstr("\"within_jnd\": true"));
}

TEST_F(ReportProgram, HasNoGreenBesideALawThatIsNotPassive) {
  record("cut.h5");
  ASSERT_EQ(run_kerf({"fit", file_, "--models", "kelvin", "--no-folds", "-o", fits()}).exit_status, 0);
  ASSERT_EQ(run_kerf({"check", fits() + "/kelvin.law.toml", "--virtual", "--seconds", "2", "-o", check()})
                .exit_status,
            0);
  ASSERT_EQ(report({"--check", check()}).exit_status, 0);
  EXPECT_THAT(test::read_text(page()), HasSubstr("<p class=\"answer\"><strong>Closed loop: pass.</strong>"));
  const std::string gives =
      std::regex_replace(test::read_text(check()), std::regex("\"passive\": true"), "\"passive\": false");
  test::write_text(check(), gives);
  ASSERT_EQ(report({"--check", check(), "--force"}).exit_status, 0);
  EXPECT_THAT(test::read_text(page()),
              HasSubstr(partly + std::string("Closed loop: in time, but not passive.</strong>")));
}

TEST_F(ReportProgram, FoldsAwayAllButTheBestLaws) {
  record("cut.h5");
  ASSERT_EQ(
      run_kerf({"fit", file_, "--models", "kelvin,maxwell,exponential,springpot,hunt_crossley,precontact",
                "--arms", "1", "--folds", "2", "-o", fits()})
          .exit_status,
      0);
  ASSERT_EQ(report({"--fits", fits()}).exit_status, 0);
  const std::string html = test::read_text(page());
  EXPECT_THAT(html, HasSubstr("<details><summary>Residuals of the other 2 laws"));
  EXPECT_THAT(html, HasSubstr("<details><summary>Parameters of the other 2 laws"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
}

TEST_F(ReportProgram, SaysThatAFitIsOfAnotherRecording) {
  record("cut.h5");
  ASSERT_EQ(run_kerf({"fit", file_, "--models", "kelvin", "--no-folds", "-o", fits()}).exit_status, 0);
  ASSERT_EQ(report({"--fits", fits()}).exit_status, 0);
  EXPECT_THAT(test::read_text(page()), Not(HasSubstr("fitted to another recording")));
  record("other.h5");
  ASSERT_EQ(report({"--fits", fits(), "--force"}).exit_status, 0);
  EXPECT_THAT(test::read_text(page()), HasSubstr("fitted to another recording"));
}

TEST_F(ReportProgram, SaysWhatIsNotThere) {
  record("cut.h5");
  ASSERT_EQ(report().exit_status, 0);
  EXPECT_THAT(test::read_text(page()), HasSubstr("No fit was given"));
  EXPECT_THAT(test::read_text(page()), HasSubstr("No check was given"));
}

TEST_F(ReportProgram, RefusesWhatIsNoFitOrNoCheck) {
  record("cut.h5");
  std::filesystem::create_directory(fits());
  test::write_text(fits() + "/fit.json", "{\"fits\": 3}");
  EXPECT_EQ(report({"--fits", fits()}).exit_status, 2);
  test::write_text(check(), "not json");
  const Outcome outcome = report({"--check", check()});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("check.json: not JSON"));
  EXPECT_EQ(report({"--fits", (folder_ / "none").string()}).exit_status, 2);
  EXPECT_FALSE(std::filesystem::exists(page()));
}

TEST_F(ReportProgram, KeepsAnExistingPageUnlessForced) {
  record("cut.h5");
  test::write_text(page(), "mine");
  EXPECT_EQ(report().exit_status, 2);
  EXPECT_EQ(test::read_text(page()), "mine");
  EXPECT_EQ(report({"--force"}).exit_status, 0);
}

}  // namespace
}  // namespace kerf

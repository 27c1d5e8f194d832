#include "support/program.h"

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "support/recordings.h"

// Everything that the verbs have found of one recording on one page.

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class ReportOfResults : public testing::Test {
 protected:
  ReportOfResults() {
    schema::write_recording(folder_ / "cut.h5", test::punch({.seconds = 6.0}));
    ran({"segment", at("cut.h5")});
  }
  void ran(const std::vector<std::string>& words, int at_most = 1) const {
    const Outcome outcome = run_kerf(words);
    EXPECT_LE(outcome.exit_status, at_most) << words[0] << ": " << outcome.errors;
  }
  void fit() const {
    ran({"fit", at("cut.h5"), "--models", "kelvin", "--no-folds", "-o", at("all/fits")}, 0);
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] Outcome report(std::vector<std::string> more) const {
    more.insert(more.begin(), {"report", at("cut.h5"), "-o", at("page.html"), "--force"});
    return run_kerf(more);
  }
  [[nodiscard]] std::string page(const std::vector<std::string>& more) const {
    const Outcome outcome = report(more);
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
    return test::read_text(at("page.html"));
  }
  test::TemporaryFolder folder_;
};

// What `choose` finds is put on a page where its own tests have run it (ProgramChoose): it takes seconds.
TEST_F(ReportOfResults, TakesWhatTheVerbsHaveFoundOutOfOneFolder) {
  std::filesystem::remove(at("cut.h5"));
  ran({"record", "--virtual", "--seconds", "6", "-o", at("cut.h5")}, 0);
  ran({"segment", at("cut.h5")}, 0);
  fit();
  const std::string law = at("all/fits/kelvin.law.toml");
  test::write_text(at("all/inspect.json"), run_kerf({"inspect", at("cut.h5"), "--json"}).output);
  ran({"chart", at("cut.h5"), "--laws", "kelvin", "--no-folds", "--no-cold", "-o", at("all/chart")}, 0);
  ran({"stability", law, "--cells", "5", "-o", at("all/stability")});
  ran({"replay", at("cut.h5"), "--through", law, "-o", at("all/replay")}, 0);
  ran({"check", law, "--virtual", "--seconds", "0.2", "-o", at("all/check.json")});
  const std::string html = page({at("all")});
  for (const auto* part :
       {"<h2>Cycles", "<h2>What it is worth", "<h2>Fits", "<h2>Cost against error", "<h2>Stability",
        "where strokes of up to", "<h2>Replayed through laws", "<h2>Closed loop", "rows at 0",
        "Cost of a tick over error: cut", "Force along theta, recorded and rendered on the same ticks",
        "what kerf choose would say"}) {
    EXPECT_TRUE(html.find(part) != std::string::npos) << part;
  }
  for (const auto* part : {"another recording", "does not say which recording"})
    EXPECT_TRUE(html.find(part) == std::string::npos) << part;
}

TEST_F(ReportOfResults, DrawsTheForceOfALawOverTheOneThatItFollows) {
  fit();
  ran({"replay", at("cut.h5"), "--through", at("all/fits/kelvin.law.toml"), "-o", at("replay")}, 0);
  const std::string html = page({at("replay")});
  const std::string chart = html.substr(html.find("recorded and rendered on the same ticks"));
  // The law that made the force pushes back as far as was measured: both are of one sign on one scale.
  EXPECT_FALSE(
      std::regex_search(chart.substr(0, chart.find("</svg>")), std::regex(R"(<text>(<[^>]*>)?\s*-[0-9])")));
  std::filesystem::remove(folder_ / "replay" / "kelvin.h5");
  EXPECT_THAT(page({at("replay")}), AllOf(Not(HasSubstr("on the same ticks")), HasSubstr("rms [JND]")));
}

TEST_F(ReportOfResults, HoldsNothingThatIsOfAnEarlierStateOfTheRecording) {
  ran({"fit", at("cut.h5"), "--models", "kelvin", "--folds", "2", "-o", at("all/fits")}, 0);
  ran({"chart", at("cut.h5"), "--laws", "kelvin", "--no-folds", "--no-cold", "-o", at("all/chart")}, 0);
  test::write_text(at("all/inspect.json"), run_kerf({"inspect", at("cut.h5"), "--json"}).output);
  const auto summary = [&] {
    const std::string html = page({at("all")});
    return html.substr(0, html.find("<h2>What was recorded"));
  };
  EXPECT_THAT(summary(), AllOf(ContainsRegex("Holds</strong>:.*fits: kelvin is within the JND"),
                               Not(HasSubstr("again"))));
  ran({"segment", at("cut.h5"), "--closing", "decreasing"}, 0);
  EXPECT_THAT(
      summary(),
      AllOf(ContainsRegex("Not known</strong>:.*fits: kelvin is within the JND \\(of earlier cycles: "
                          "run kerf fit again\\)"),
            HasSubstr("(of earlier cycles: run kerf chart again)"), Not(HasSubstr("Holds</strong>"))));
  schema::Recording recording = schema::read_recording(at("cut.h5"));
  for (double& force : recording.force_measured) force *= 2.0;
  schema::write_recording(at("cut.h5"), recording, schema::Existing::replace);
  EXPECT_THAT(summary(), HasSubstr("of other samples than the recording has now: run kerf fit again"));
}

TEST_F(ReportOfResults, SaysWhereAFitAndAChartBeginAtDifferentPlaces) {
  fit();
  const auto chart_at = [&](const std::string& contact) {
    ran({"chart", at("cut.h5"), "--laws", "kelvin", "--no-folds", "--no-cold", "--contact", contact, "-o",
         at("all/chart"), "--force"},
        0);
    return page({at("all")});
  };
  EXPECT_THAT(chart_at("0.0021"), ContainsRegex("does not begin at one place.*kerf chart at 2.1 mm"));
  const std::string fitted = test::read_text(at("all/fits/fit.json"));
  const auto contact = nlohmann::json::parse(fitted)["recordings"][0]["contact"]["position"].get<double>();
  EXPECT_THAT(chart_at(fmt::format("{}", contact)), Not(HasSubstr("does not begin at one place")));
}

TEST_F(ReportOfResults, NamesWhatNobodyHasLookedAtAndTheCommandForIt) {
  const std::string html = page({});
  EXPECT_THAT(html, AllOf(HasSubstr("what kerf inspect, kerf fit, kerf choose, kerf chart, kerf stability"),
                          HasSubstr("kerf choose cut.h5 -o choice"), HasSubstr("answer partly")));
}

TEST_F(ReportOfResults, ShowsAFileOnceThatIsNamedTwice) {
  fit();
  const std::string html = page({at("all/fits"), at("all/fits/fit.json"), "--fits", at("all/fits")});
  EXPECT_EQ(html.find("<h2>Fits"), html.rfind("<h2>Fits"));
}

TEST_F(ReportOfResults, SaysWhichFileIsNotWhatItsVerbWrites) {
  test::write_text(at("chart.json"), R"({"points": [{"law": 3}], "front": []})");
  const Outcome outcome = report({at("chart.json")});
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, AllOf(HasSubstr("chart.json"), HasSubstr("kerf chart")));
  EXPECT_FALSE(std::filesystem::exists(at("page.html")));
}

}  // namespace
}  // namespace kerf

// Every verb that reads a recording takes a text by --map, and gives what it gives of the imported recording.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"

namespace kerf {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr auto map = "time=t[s],position=x[mm],force=F[N]";

class TextsOnTheWay : public testing::Test {
 protected:
  TextsOnTheWay() {
    std::filesystem::create_directory(scratch());
    setenv("TMPDIR", scratch().c_str(), 1);
    std::string table = "t,x,F\n";
    for (int i = 0; i < 600; ++i) {
      const double t = 0.01 * i;
      // Free for half a second, then strokes into something stiff.
      const double depth = t < 0.5 ? 0.0 : 10.0 * std::pow(std::sin(2.0 * (t - 0.5)), 2);
      table += fmt::format("{:.2f},{:.4f},{:.4f}\n", t, depth, 0.3 * depth + 0.002 * ((i * 7) % 5));
    }
    test::write_text(text(), table + "what the logger said at its end\n");
    test::write_text(folder_ / "rig.import.toml", fmt::format("map = \"{}\"\n", map));
  }
  ~TextsOnTheWay() override { unsetenv("TMPDIR"); }
  TextsOnTheWay(const TextsOnTheWay&) = delete;
  TextsOnTheWay& operator=(const TextsOnTheWay&) = delete;

  [[nodiscard]] std::string text() const { return (folder_ / "cut.csv").string(); }
  [[nodiscard]] std::string law() const { return (folder_ / "fits" / "kelvin.law.toml").string(); }
  [[nodiscard]] std::string out() const { return (folder_ / "out").string(); }
  [[nodiscard]] std::string scratch() const { return (folder_ / "tmp").string(); }
  [[nodiscard]] Outcome with_map(std::vector<std::string> words, const std::string& how = map) const {
    std::error_code ignored;
    std::filesystem::remove_all(out(), ignored);
    words.insert(words.end(), {"--map", how, "--json"});
    return run_kerf(words);
  }

  test::TemporaryFolder folder_;
};

TEST_F(TextsOnTheWay, AreTakenByEveryVerbThatReadsARecording) {
  const std::vector<std::vector<std::string>> verbs{
      {"info", text()},
      {"validate", text()},
      {"inspect", text()},
      {"fit", text(), "--models", "kelvin", "-o", (folder_ / "fits").string()},
      {"choose", text(), "--no-loop", "--most-segments", "1", "--folds", "2"},
      {"chart", text(), "--no-folds", "--cold-ticks", "1000", "--laws", "kelvin"},
      {"report", text(), "-o", out()},
      {"replay", text(), "--through", law()},
      {"prepare", text(), "--bias", "--onset", "-o", out()},
      {"convert", text(), "-o", (folder_ / "out.mcap").string()}};
  for (const auto& words : verbs) {
    const Outcome outcome = with_map(words);
    ASSERT_THAT(outcome.exit_status, testing::AnyOf(0, 1)) << words[0] << ": " << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr("cut.csv: 1 lines are not data: 602")) << words[0];
    const auto json = nlohmann::json::parse(outcome.output);
    const auto& imported = json.at("imported_on_the_way").at(0);
    EXPECT_EQ(imported.at("file"), text()) << words[0];
    EXPECT_EQ(imported.at("sha256").get<std::string>().size(), 64U) << words[0];
    EXPECT_EQ(imported.at("samples"), 600) << words[0];
    EXPECT_THAT(outcome.output + outcome.errors, Not(HasSubstr("kerf-import-"))) << words[0];
    EXPECT_TRUE(std::filesystem::is_empty(scratch())) << words[0];
  }
}

TEST_F(TextsOnTheWay, GiveTheLawThatTheImportedRecordingGives) {
  const std::string recording = (folder_ / "cut.h5").string();
  ASSERT_EQ(run_kerf({"import", text(), "--map", map, "-o", recording}).exit_status, 0);
  const Outcome direct =
      with_map({"fit", text(), "--models", "kelvin", "-o", out()}, (folder_ / "rig.import.toml").string());
  ASSERT_EQ(direct.exit_status, 0) << direct.errors;
  const std::string direct_law = test::read_text(folder_ / "out" / "kelvin.law.toml");
  ASSERT_EQ(run_kerf({"fit", recording, "--models", "kelvin", "-o", (folder_ / "two").string()}).exit_status,
            0);
  const std::string law_of_recording = test::read_text(folder_ / "two" / "kelvin.law.toml");
  const auto parameters = [](const std::string& file) {
    const auto at = file.find("[parameters]");
    return file.substr(at, file.find("\n[", at + 1) - at);
  };
  EXPECT_EQ(parameters(direct_law), parameters(law_of_recording));
  const auto content = [](const std::string& file) { return file.substr(file.find("content ="), 76); };
  EXPECT_EQ(content(direct_law), content(law_of_recording)) << "what was sampled is the same";
  const Outcome hash = test::run({"/usr/bin/sha256sum", text()});
  EXPECT_THAT(direct_law, HasSubstr(hash.output.substr(0, 64)));
  EXPECT_EQ(nlohmann::json::parse(direct.output).at("imported_on_the_way").at(0).at("sha256"),
            hash.output.substr(0, 64));
}

TEST_F(TextsOnTheWay, ComeThroughPipes) {
  // Their hash is asked for again after they were read.
  const auto through = [&](const std::string& words) {
    return test::run(
        {"/bin/bash", "-c",
         fmt::format("cat {} | {} {} --map '{}' --json --force", text(), KERF_PROGRAM, words, map)});
  };
  const std::string hash = test::run({"/usr/bin/sha256sum", text()}).output.substr(0, 64);
  for (const auto* name : {"-", "/dev/stdin", "<(cat)"}) {
    const Outcome outcome = through(fmt::format("fit {} --models kelvin -o {}", name, out()));
    ASSERT_EQ(outcome.exit_status, 0) << name << ": " << outcome.errors;
    EXPECT_EQ(nlohmann::json::parse(outcome.output).at("imported_on_the_way").at(0).at("sha256"), hash)
        << name;
    EXPECT_THAT(test::read_text(folder_ / "out" / "kelvin.law.toml"), HasSubstr(hash)) << name;
    EXPECT_TRUE(std::filesystem::is_empty(scratch())) << name;
  }
  EXPECT_EQ(
      test::run({"/bin/bash", "-c", fmt::format("{} info - --map '{}' < {}", KERF_PROGRAM, map, text())})
          .exit_status,
      0)
      << "a regular file as standard input is no pipe";
}

TEST_F(TextsOnTheWay, AreOneRecordingToEveryVerb) {
  const std::string fits = (folder_ / "fits").string();
  ASSERT_EQ(with_map({"fit", text(), "--models", "kelvin", "-o", fits}).exit_status, 0);
  const Outcome report =
      with_map({"report", text(), fits, "-o", out()}, (folder_ / "rig.import.toml").string());
  EXPECT_EQ(report.exit_status, 0) << report.errors;
  const Outcome other = with_map({"report", text(), fits, "-o", out()}, "time=t[s],position=x[m],force=F[N]");
  EXPECT_THAT(other.errors, HasSubstr("results of other recordings")) << "another map, another recording";
}

TEST_F(TextsOnTheWay, StayAsTheyAre) {
  const std::string before = test::read_text(text());
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"segment", text()}, {"repair", text()}, {"inspect", text(), "--store"}}) {
    const Outcome outcome = with_map(words);
    EXPECT_EQ(outcome.exit_status, 2) << words[0];
    EXPECT_THAT(outcome.errors, HasSubstr("'kerf import")) << words[0];
    EXPECT_EQ(test::read_text(text()), before) << words[0];
  }
  EXPECT_TRUE(std::filesystem::is_empty(scratch()));
}

TEST_F(TextsOnTheWay, AreNoRecordingsWithoutAMapWhichIsNamed) {
  const std::string shouted = (folder_ / "CUT.CSV").string();
  std::filesystem::copy_file(text(), shouted);
  const std::vector<std::vector<std::string>> verbs{
      {"info"},   {"inspect"}, {"validate"},         {"replay"},
      {"choose"}, {"chart"},   {"fit", "-o", out()}, {"report", "-o", out()}};
  for (std::vector<std::string> words : verbs) {
    for (const std::string& table : {text(), shouted}) {
      words.insert(words.begin() + 1, table);
      const auto outcome = run_kerf(words);
      EXPECT_EQ(outcome.exit_status, 2) << words[0];
      EXPECT_THAT(outcome.errors, HasSubstr(table + ": not an HDF5 file; expected a recording")) << words[0];
      EXPECT_THAT(outcome.errors, HasSubstr("--map 'time=COLUMN,position=COLUMN,force=COLUMN'")) << words[0];
      words.erase(words.begin() + 1);
    }
  }
}

TEST_F(TextsOnTheWay, AreRefusedWhereTheMapHelpsNobody) {
  const std::string recording = (folder_ / "cut.h5").string();
  ASSERT_EQ(run_kerf({"import", text(), "--map", map, "-o", recording}).exit_status, 0);
  EXPECT_THAT(with_map({"info", recording}).errors, HasSubstr("leave --map out"));
  EXPECT_THAT(with_map({"fit", "--batch", folder_.path().string(), "-o", out()}).errors,
              HasSubstr("expected one among the recordings"));
  EXPECT_THAT(with_map({"info", scratch()}).errors, HasSubstr("a folder; expected a file"));
  EXPECT_THAT(with_map({"info", text()}, "time=9[s],position=2[mm]").errors,
              HasSubstr("asks for column '9'"));
  EXPECT_THAT(with_map({"info", text() + "x"}).errors, HasSubstr("cut.csvx"));
  EXPECT_THAT(
      with_map({"fit", text(), "--join", text(), "-o", out()}).errors,
      HasSubstr(
          "--join is an option of 'kerf import', and fit has --map alone; run 'kerf import ... --join"));
  EXPECT_THAT(with_map({"inspect", text(), "--trial=a"}).errors,
              HasSubstr("--trial is an option of 'kerf import'"));
  EXPECT_THAT(with_map({"fit", text(), "--nothing", "-o", out()}).errors,
              HasSubstr("there is no option --nothing"));
}

}  // namespace
}  // namespace kerf

// Results on standard output; progress and warnings on standard error; with --json only JSON.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "support/kelvin_law.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf {
namespace {

using test::run_kerf;
using testing::HasSubstr;
using testing::Not;

class OutputStreams : public testing::Test {
 protected:
  OutputStreams() {
    schema::write_recording(folder_ / "r.h5", test::punch());
    test::write_text(folder_ / "k.law.toml", test::kelvin_law);
    test::write_text(folder_ / "t.txt", "0,1,2\n1,2,nan\n2,3,4\n");
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// Verbs of every group, with what their result says.
  [[nodiscard]] std::vector<std::pair<std::vector<std::string>, std::string>> verbs() const {
    return {
        {{"devices"}, "sim:scissors"},
        {{"laws"}, "kelvin"},
        {{"laws", "kelvin"}, "parallel_stiffness"},
        {{"info", at("r.h5")}, "force_measured"},
        {{"validate", at("r.h5")}, "valid"},
        {{"import", at("t.txt"), "--map", "time=1[s],position=2[mm],force=3[N]", "-o", at("i.h5"), "--force"},
         "3 samples"},
        {{"prepare", at("r.h5"), "-o", at("p.h5"), "--from", "1", "--force"}, "rows"},
        {{"fit", at("r.h5"), "--models", "kelvin", "-o", at("fits"), "--force"}, "choice: kelvin"},
        {{"report", at("r.h5"), "-o", at("r.html"), "--force"}, "r.html"},
        {{"record", "--virtual", "--seconds", "0.5", "-o", at("s.h5"), "--force"}, "500 samples"},
        {{"check", at("k.law.toml"), "--virtual", "--seconds", "0.5"}, "500 ticks"},
        {{"session", "analyze", KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv", "--bootstrap",
          "0"},
         "subjects"},
        {{"train", "--example", "-o", at("t.csv"), "--force"}, "t.csv"}};
  }

  test::TemporaryFolder folder_;
};

TEST_F(OutputStreams, ResultsGoToStandardOutput) {
  for (const auto& [words, says] : verbs()) {
    const auto outcome = run_kerf(words);
    EXPECT_LE(outcome.exit_status, 1) << words[0] << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr(says)) << words[0];
    EXPECT_THAT(outcome.errors, Not(HasSubstr(says))) << words[0];
  }
}

TEST_F(OutputStreams, WithJsonNothingElseIsThere) {
  for (auto [words, says] : verbs()) {
    words.emplace_back("--json");
    const auto outcome = run_kerf(words);
    EXPECT_TRUE(nlohmann::json::accept(outcome.output)) << words[0] << '\n' << outcome.output;
    EXPECT_THAT(outcome.errors, Not(HasSubstr(says))) << words[0];
  }
}

TEST_F(OutputStreams, WarningsGoToStandardError) {
  const auto outcome =
      run_kerf({"import", at("t.txt"), "--map", "time=1[s],position=2[mm],force=3[N]", "-o", at("i.h5")});
  EXPECT_THAT(outcome.errors, testing::StartsWith("warning: force_measured holds 1 values"));
  EXPECT_THAT(outcome.output, Not(HasSubstr("warning")));
}

TEST_F(OutputStreams, WhatIsWrongGoesToStandardError) {
  const auto outcome = run_kerf({"info", at("none.h5")});
  EXPECT_EQ(outcome.output, "");
  EXPECT_THAT(outcome.errors, testing::StartsWith("kerf: "));
}

}  // namespace
}  // namespace kerf

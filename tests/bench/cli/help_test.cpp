// What `kerf` says of itself, and of a slip in typing.

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/cli/verbs.h"
#include "support/program.h"

namespace kerf {
namespace {

using test::run_kerf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string refusal(const std::vector<std::string>& words) {
  const auto outcome = run_kerf(words);
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
  return outcome.errors;
}

TEST(Help, FitsAScreenWithEveryVerbInItsGroup) {
  const auto outcome = run_kerf({"--help"});
  EXPECT_EQ(outcome.exit_status, 0);
  EXPECT_LE(std::ranges::count(outcome.output, '\n'), 38);
  std::istringstream lines(outcome.output);
  std::vector<std::string> groups;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 100U) << line;
    std::smatch found;
    if (std::regex_match(line, found, std::regex("([a-z]+) +([a-z]+) +[A-Z].*"))) groups.push_back(found[1]);
  }
  EXPECT_THAT(groups, ElementsAre("start", "devices", "record", "look", "fit", "judge", "replay",
                                  "experiment", "study", "share"));
}

TEST(Help, SortsTheVerbsAsTheirFoldersDo) {
  for (const test::VerbOfGroup& verb : test::verbs_in_help()) {
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(KERF_SOURCE_DIR) / "bench/cli" / verb.group /
                                        ("verb_" + verb.name + ".cpp")))
        << verb.group << '/' << verb.name;
  }
}

TEST(Help, IsAVerbAsWellAsAnOption) {
  EXPECT_EQ(run_kerf({"help"}).output, run_kerf({"--help"}).output);
  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{"fit"}, {"session"}, {"session", "new"}}) {
    std::vector<std::string> asked = verb;
    asked.insert(asked.begin(), "help");
    std::vector<std::string> option = verb;
    option.emplace_back("--help");
    const auto outcome = run_kerf(asked);
    EXPECT_EQ(outcome.exit_status, 0);
    EXPECT_THAT(outcome.output, HasSubstr("Usage: kerf " + verb.front()));
    EXPECT_EQ(outcome.output, run_kerf(option).output);
  }
}

TEST(Help, KnowsWhichVerbWasMeant) {
  EXPECT_THAT(refusal({"fitt", "a.h5", "-o", "x"}), HasSubstr("no verb 'fitt'; did you mean 'fit'?"));
  EXPECT_THAT(refusal({"help", "fitt"}), HasSubstr("did you mean 'fit'?"));
  EXPECT_THAT(refusal({"session", "nwe"}),
              HasSubstr("no verb 'nwe'; did you mean 'new'? 'kerf help session'"));
  EXPECT_THAT(refusal({"cucumber"}), Not(HasSubstr("did you mean")));
  EXPECT_THAT(refusal({}), HasSubstr("'kerf' needs a verb; 'kerf help' lists them"));
  EXPECT_THAT(refusal({"session"}), HasSubstr("'kerf session' needs a verb; 'kerf help session' lists them"));
}

TEST(Help, KnowsWhichOptionWasMeant) {
  EXPECT_THAT(refusal({"info", "a.h5", "--jsn"}),
              HasSubstr("no option --jsn; did you mean '--json'? 'kerf help info' says more"));
  EXPECT_THAT(refusal({"fit", "a.h5", "--otput=x"}), HasSubstr("did you mean '--output'?"))
      << "and not that --output is missing";
  EXPECT_THAT(refusal({"info", "a.h5", "--cucumber"}), Not(HasSubstr("did you mean")));
  EXPECT_THAT(refusal({"fit", "a.h5"}), HasSubstr("--output is required; 'kerf help fit' says more"));
}

TEST(Help, NamesNoExampleThatIsNotThere) {
  const std::filesystem::path clone = KERF_SOURCE_DIR;
  const std::regex name("(examples|docs|drivers|scripts)/[A-Za-z0-9_./-]*[A-Za-z0-9_]");
  std::size_t names = 0;
  for (const std::vector<std::string>& verb : test::all_verbs()) {
    std::vector<std::string> asked = verb;
    asked.emplace_back("--help");
    const std::string text = run_kerf(asked).output;
    for (std::sregex_iterator found(text.begin(), text.end(), name), end; found != end; ++found, ++names)
      EXPECT_TRUE(std::filesystem::exists(clone / found->str())) << verb.front() << ": " << found->str();
  }
  EXPECT_GT(names, 10U);
}

}  // namespace
}  // namespace kerf
